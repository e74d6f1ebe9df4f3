// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/points/point_collector.h"

#include <algorithm>
#include <span>
#include <utility>

namespace vdbmap {
namespace {

template <typename T>
void grow(std::vector<T>& values, bool is_present, std::size_t count) {
  if (is_present) values.resize(values.size() + count);
}

bool has_channels(const std::vector<std::optional<PointField>>& fields) {
  for (const auto& field : fields) {
    if (field && is_color_channel(field->role)) return true;
  }
  return false;
}

std::size_t channel_of(FieldRole role) { return role == FieldRole::kRed ? 0 : role == FieldRole::kGreen ? 1 : 2; }

}  // namespace

PointCollector::PointCollector(std::vector<std::optional<PointField>> fields)
    : fields_(std::move(fields)), shape_(make_cloud(fields_, 1)), numbers_(fields_.size()) {
  if (has_channels(fields_)) shape_.colors.clear();
}

void PointCollector::store_block() {
  const std::size_t first = cloud_.size();
  grow(cloud_.positions, true, num_in_block_);
  grow(cloud_.colors, !shape_.colors.empty(), num_in_block_);
  grow(cloud_.intensities, !shape_.intensities.empty(), num_in_block_);
  grow(cloud_.times, !shape_.times.empty(), num_in_block_);
  grow(cloud_.rings, !shape_.rings.empty(), num_in_block_);
  grow(cloud_.labels, !shape_.labels.empty(), num_in_block_);
  grow(raw_colors_, has_channels(fields_), num_in_block_);
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    if (!fields_[i]) continue;
    const std::span<const double> numbers(numbers_[i].data(), num_in_block_);
    if (!is_color_channel(fields_[i]->role)) {
      store_numbers(cloud_, *fields_[i], first, numbers);
      continue;
    }
    color_range_.add(numbers);
    const std::size_t channel = channel_of(fields_[i]->role);
    for (std::size_t k = 0; k < numbers.size(); ++k) raw_colors_[first + k][channel] = static_cast<float>(numbers[k]);
  }
  num_in_block_ = 0;
}

void PointCollector::scale_colors() {
  if (raw_colors_.empty()) return;
  cloud_.colors.resize(raw_colors_.size());
  std::array<double, kPointsPerBlock> block;
  for (std::optional<PointField>& field : fields_) {
    if (!field || !is_color_channel(field->role)) continue;
    set_color_scale(*field, color_range_);
    const std::size_t channel = channel_of(field->role);
    for (std::size_t first = 0; first < raw_colors_.size(); first += block.size()) {
      const std::size_t count = std::min(block.size(), raw_colors_.size() - first);
      for (std::size_t i = 0; i < count; ++i) block[i] = static_cast<double>(raw_colors_[first + i][channel]);
      store_numbers(cloud_, *field, first, {block.data(), count});
    }
  }
}

PointCloud PointCollector::finish() {
  store_block();
  scale_colors();
  return std::move(cloud_);
}

}  // namespace vdbmap

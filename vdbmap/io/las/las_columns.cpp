// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/las/las_columns.h"

#include <algorithm>

#include "vdbmap/io/points/color_range.h"

namespace vdbmap {
namespace {

constexpr std::size_t kIntensityAt = 12;

// One value a point record, by a function of the record's first byte.
template <typename T, typename Read>
void store_column(T* values, const char* records, std::size_t count, const LasHeader& header, const Read& read) {
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<T>(read(records + i * header.record_length));
}

Eigen::Vector3d read_position(const char* record, const LasHeader& header) {
  const Eigen::Vector3d quanta(load<std::int32_t>(record), load<std::int32_t>(record + 4),
                               load<std::int32_t>(record + 8));
  return quanta.cwiseProduct(header.scale) + header.offset;
}

Rgb16 read_color(const char* color) {
  return {load<std::uint16_t>(color), load<std::uint16_t>(color + 2), load<std::uint16_t>(color + 4)};
}

// The specification says for intensities that 0 stands for an attribute the source did not have.
template <typename T>
void forget_if_all_zero(std::vector<T>& values) {
  if (std::ranges::all_of(values, [](const T& value) { return value == T{}; })) values = {};
}

}  // namespace

PointCloud make_las_cloud(const LasHeader& header, std::size_t count) {
  PointCloud cloud;
  cloud.positions.resize(count);
  cloud.intensities.resize(count);
  cloud.labels.resize(count);
  if (header.format.color_at) cloud.colors.resize(count);
  if (header.format.time_at) cloud.times.resize(count);
  return cloud;
}

void store_las_points(PointCloud& cloud, std::size_t first, const char* records, std::size_t count,
                      const LasHeader& header) {
  const LasPointFormat& format = header.format;
  store_column(cloud.positions.data() + first, records, count, header,
               [&](const char* record) -> Eigen::Vector3d { return read_position(record, header); });
  store_column(cloud.intensities.data() + first, records, count, header,
               [](const char* record) { return load<std::uint16_t>(record + kIntensityAt); });
  store_column(cloud.labels.data() + first, records, count, header, [&](const char* record) {
    return load<std::uint8_t>(record + format.classification_at) & format.classification_mask;
  });
  if (format.color_at) {
    store_column(cloud.colors.data() + first, records, count, header,
                 [at = *format.color_at](const char* record) { return read_color(record + at); });
  }
  if (format.time_at) {
    store_column(cloud.times.data() + first, records, count, header,
                 [at = *format.time_at](const char* record) { return load<double>(record + at); });
  }
}

void append_withheld(std::vector<std::size_t>& places, std::size_t first, const char* records, std::size_t count,
                     const LasHeader& header) {
  if (!header.has_flags) return;
  const char* flags = records + header.format.withheld_at;
  for (std::size_t i = 0; i < count; ++i, flags += header.record_length) {
    if ((load<std::uint8_t>(flags) & header.format.withheld_mask) != 0) places.push_back(first + i);
  }
}

void finish_las_cloud(PointCloud& cloud) {
  scale_colors(cloud.colors);
  forget_if_all_zero(cloud.intensities);
  forget_if_all_zero(cloud.labels);
  forget_if_all_zero(cloud.colors);
}

}  // namespace vdbmap

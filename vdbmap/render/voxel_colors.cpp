// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/voxel_colors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "vdbmap/change/change_colors.h"
#include "vdbmap/render/label_colors.h"

namespace vdbmap {
namespace {

constexpr std::size_t kMaxRangeSamples = 200'000;  // voxels looked at for the range of values
constexpr std::size_t kScaleSteps = 256;
constexpr double kLowShare = 0.01;  // of the values, that may lie outside of the scale
constexpr double kHighShare = 0.98;
constexpr std::size_t kMaxEpochs = 10;  // in the legend
constexpr std::size_t kMaxLabels = 20;
constexpr Rgb8 kOthers = rgb8(0xffffff);

void check_known(bool is_known, const char* asked_for, const char* missing) {
  if (is_known) return;
  throw std::invalid_argument(std::string("cannot colour by ") + asked_for + ": the map has no " + missing);
}

void check_available(const VoxelMap& map, const VoxelLevel& level, ColorBy color_by) {
  if (color_by == ColorBy::kRgb) check_known(map.has_color, "rgb", "colours");
  if (color_by == ColorBy::kIntensity) check_known(!level.channels().intensities.empty(), "intensity", "intensities");
  if (color_by == ColorBy::kLabel) check_known(!level.channels().labels.empty(), "label", "labels");
  if (color_by == ColorBy::kEpoch) check_known(!level.channels().last_epochs.empty(), "epoch", "epochs");
  if (color_by == ColorBy::kAge) check_known(!level.channels().last_epochs.empty(), "age", "epochs");
  if (color_by == ColorBy::kChange) throw std::invalid_argument("cannot colour by change without a diff");
}

std::size_t stride_of(std::size_t size) { return size / kMaxRangeSamples + 1; }

// Heights of the voxels' middles in the original system.
std::vector<double> some_heights(const VoxelMap& map, const VoxelLevel& level) {
  std::vector<double> heights;
  const std::span<const VoxelLeaf> leaves = level.leaves();
  const std::size_t stride = level.size() / kMaxRangeSamples + 1;
  for (std::size_t i = 0; i < leaves.size(); i += stride) {
    for_each_voxel(leaves[i], [&](const VoxelIndex& voxel, std::size_t) {
      heights.push_back(center_of_voxel(voxel, level.voxel_size()).z() + map.frame.anchor.z());
    });
  }
  return heights;
}

std::vector<double> some_intensities(const VoxelLevel& level) {
  std::vector<double> values;
  const std::vector<float>& intensities = level.channels().intensities;
  for (std::size_t i = 0; i < intensities.size(); i += stride_of(intensities.size())) values.push_back(intensities[i]);
  return values;
}

double quantile(std::vector<double>& values, double share) {
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

// Red, green and blue for x, y and z; opposite directions look alike, as normals have no sign.
LinearColor color_of_normal(const Eigen::Vector3d& normal) {
  return (0.08 + 0.75 * normal.cwiseAbs().array().square()).matrix().cast<float>();
}

std::vector<std::pair<std::string, Rgb8>> normal_entries() {
  std::vector<std::pair<std::string, Rgb8>> entries;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name = std::array{"x", "y", "z"}[static_cast<std::size_t>(axis)];
    entries.emplace_back("along " + name, pixel_of(color_of_normal(Eigen::Vector3d::Unit(axis))));
  }
  return entries;
}

std::vector<std::pair<std::string, Rgb8>> epoch_entries(const std::vector<std::int32_t>& epochs) {
  std::vector<std::pair<std::string, Rgb8>> entries;
  for (const std::int32_t epoch : std::set<std::int32_t>(epochs.begin(), epochs.end())) {
    if (entries.size() == kMaxEpochs) break;
    entries.emplace_back(std::to_string(epoch), category_color(static_cast<std::size_t>(epoch)));
  }
  return entries;
}

// From green, just seen, over straw to purple, long not seen.
Rgb8 age_color(std::int32_t age, std::int32_t oldest) {
  const LinearColor fresh = linear_of(rgb8(0x1b7837)), middle = linear_of(rgb8(0xefe3b0)),
                    old = linear_of(rgb8(0x6a2c83));
  const float share = oldest > 0 ? static_cast<float>(age) / static_cast<float>(oldest) : 0;
  const LinearColor color = share < 0.5f ? LinearColor(fresh + 2 * share * (middle - fresh))
                                         : LinearColor(middle + (2 * share - 1) * (old - middle));
  return pixel_of(color);
}

std::vector<std::pair<std::string, Rgb8>> age_entries(const std::vector<std::int32_t>& epochs) {
  std::vector<std::pair<std::string, Rgb8>> entries;
  const std::set<std::int32_t> known(epochs.begin(), epochs.end());
  for (auto epoch = known.rbegin(); epoch != known.rend() && entries.size() < kMaxEpochs; ++epoch) {
    const std::int32_t age = *known.rbegin() - *epoch;
    const std::string name =
        age == 0 ? "the latest, " : std::to_string(age) + (age == 1 ? " epoch ago, " : " epochs ago, ");
    entries.emplace_back(name + std::to_string(*epoch), age_color(age, *known.rbegin() - *known.begin()));
  }
  return entries;
}

std::vector<std::pair<std::string, Rgb8>> change_entries(const std::vector<Change>& changes) {
  std::vector<std::pair<std::string, Rgb8>> entries;
  for (const Change change :
       {Change::kAppeared, Change::kVanished, Change::kChanged, Change::kUnchanged, Change::kUnobserved}) {
    if (std::ranges::find(changes, change) == changes.end()) continue;
    const std::string name = change == Change::kUnobserved ? "not observed in the other survey" : name_of(change);
    entries.emplace_back(name, rgb8(color_code_of(change)));
  }
  return entries;
}

// The labels of most voxels, in the order of their numbers.
std::vector<std::pair<std::string, Rgb8>> label_entries(LabelScheme scheme, const std::vector<std::int32_t>& labels) {
  std::map<std::int32_t, std::size_t> counts;
  for (const std::int32_t label : labels) ++counts[label];
  std::vector<std::pair<std::int32_t, std::size_t>> shown(counts.begin(), counts.end());
  std::ranges::stable_sort(shown, std::ranges::greater(), &std::pair<std::int32_t, std::size_t>::second);
  shown.resize(std::min(shown.size(), kMaxLabels));
  std::ranges::sort(shown);

  std::vector<std::pair<std::string, Rgb8>> entries;
  for (const auto& [label, count] : shown) {
    entries.emplace_back(label_name(scheme, label), label_color(scheme, label));
  }
  const std::size_t num_others = counts.size() - shown.size();
  if (num_others > 0) entries.emplace_back("and " + std::to_string(num_others) + " others", kOthers);
  return entries;
}

}  // namespace

VoxelColors::VoxelColors(const VoxelMap& map, const VoxelLevel& level, std::optional<ColorBy> color_by)
    : map_(map), level_(level), color_by_(color_by.value_or(map.has_color ? ColorBy::kRgb : ColorBy::kHeight)) {
  check_available(map, level, color_by_);
  switch (color_by_) {
    case ColorBy::kHeight:
      legend_.title = "height [m]";
      set_range(some_heights(map, level));
      break;
    case ColorBy::kIntensity:
      legend_.title = "intensity";
      set_range(some_intensities(level));
      break;
    case ColorBy::kNormal:
      legend_.title = "normal";
      legend_.entries = normal_entries();
      break;
    case ColorBy::kEpoch:
      legend_.title = "last seen in epoch";
      legend_.entries = epoch_entries(level.channels().last_epochs);
      break;
    case ColorBy::kAge:
      legend_.title = "last seen in epoch";
      legend_.entries = age_entries(level.channels().last_epochs);
      if (!level.channels().last_epochs.empty()) {
        const auto [first, last] = std::ranges::minmax(level.channels().last_epochs);
        latest_epoch_ = last;
        oldest_age_ = last - first;
      }
      break;
    case ColorBy::kChange:
      break;
    case ColorBy::kLabel:
      legend_.title = "class";
      legend_.entries = label_entries(map.label_scheme, level.channels().labels);
      break;
    case ColorBy::kRgb:
      break;
  }
}

VoxelColors::VoxelColors(const VoxelMap& map, const VoxelLevel& level, std::vector<Change> changes, bool keeps_colors)
    : map_(map),
      level_(level),
      color_by_(ColorBy::kChange),
      changes_(std::move(changes)),
      keeps_colors_(keeps_colors && map.has_color) {
  legend_.entries = change_entries(changes_);
}

VoxelColors::VoxelColors(const VoxelMap& map, const VoxelLevel& level, const VoxelColors& like)
    : map_(map),
      level_(level),
      color_by_(like.color_by_),
      legend_(like.legend_),
      scale_(like.scale_),
      latest_epoch_(like.latest_epoch_),
      oldest_age_(like.oldest_age_) {
  if (level.size() > 0) check_available(map, level, color_by_);
}

LinearColor VoxelColors::color_of_change(std::size_t record) const {
  const Change change = changes_[record];
  const bool is_quiet = change == Change::kUnchanged || change == Change::kUnobserved;
  if (keeps_colors_ && is_quiet) return vdbmap::color_of(level_.records()[record]).cast<float>();
  return linear_of(rgb8(color_code_of(change)));
}

void VoxelColors::set_range(std::vector<double> values) {
  for (std::size_t i = 0; i <= kScaleSteps; ++i) {
    scale_.push_back(linear_of(scale_color(static_cast<double>(i) / kScaleSteps)));
  }
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return;
  legend_.low = quantile(values, kLowShare);
  legend_.high = quantile(values, kHighShare);
  if (legend_.low == legend_.high) legend_.high += 1;
}

LinearColor VoxelColors::scaled(double value) const {
  const double share = (value - legend_.low) / (legend_.high - legend_.low);
  const double step = (share > 0 ? std::min(share, 1.0) : 0.0) * static_cast<double>(kScaleSteps);
  return scale_[static_cast<std::size_t>(step + 0.5)];
}

LinearColor VoxelColors::color_of(const VoxelIndex& voxel, std::size_t record) const {
  const VoxelRecord& stored = level_.records()[record];
  switch (color_by_) {
    case ColorBy::kRgb:
      return vdbmap::color_of(stored).cast<float>();
    case ColorBy::kHeight:
      return scaled(mean_of(stored, voxel, level_.voxel_size()).z() + map_.frame.anchor.z());
    case ColorBy::kNormal:
      return color_of_normal(normal_of(stored));
    case ColorBy::kIntensity:
      return scaled(level_.channels().intensities[record]);
    case ColorBy::kEpoch:
      return linear_of(category_color(static_cast<std::size_t>(level_.channels().last_epochs[record])));
    case ColorBy::kAge:
      return linear_of(age_color(latest_epoch_ - level_.channels().last_epochs[record], oldest_age_));
    case ColorBy::kChange:
      return color_of_change(record);
    case ColorBy::kLabel:
      return linear_of(label_color(map_.label_scheme, level_.channels().labels[record]));
  }
  return LinearColor::Zero();
}

}  // namespace vdbmap

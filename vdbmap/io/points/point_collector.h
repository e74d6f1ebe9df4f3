// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "vdbmap/io/points/color_range.h"
#include "vdbmap/io/points/point_fields.h"

namespace vdbmap {

/// Makes a cloud of points that come one after the other, field by field, and of which nobody knows how many there are.
class PointCollector {
 public:
  explicit PointCollector(std::vector<std::optional<PointField>> fields);

  const std::vector<std::optional<PointField>>& fields() const { return fields_; }

  /// The number of a field as it stands in the file. The field must have a place in the cloud.
  void set(std::size_t field, double number) { numbers_[field][num_in_block_] = number; }

  /// Takes the numbers set last as a point; those of a point that is not finished are overwritten.
  void finish_point() {
    if (++num_in_block_ == kPointsPerBlock) store_block();
  }

  std::size_t size() const { return cloud_.size() + num_in_block_; }

  /// The cloud, with colours in the scale that all of them say. The collector is of no use afterwards.
  PointCloud finish();

 private:
  static constexpr std::size_t kPointsPerBlock = 1024;  // points

  void store_block();
  void scale_colors();

  std::vector<std::optional<PointField>> fields_;
  PointCloud shape_;  // one point with the attributes that the fields provide
  std::vector<std::array<double, kPointsPerBlock>> numbers_;
  std::size_t num_in_block_ = 0;
  PointCloud cloud_;
  std::vector<std::array<float, 3>> raw_colors_;  // of channels, until their scale is known
  ColorRange color_range_;
};

}  // namespace vdbmap

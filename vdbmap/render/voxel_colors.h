// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vdbmap/change/map_diff.h"
#include "vdbmap/core/voxel_map.h"
#include "vdbmap/render/color_scale.h"

namespace vdbmap {

/// What the colour of a voxel tells.
enum class ColorBy {
  kRgb,        ///< the mean colour of its points
  kHeight,     ///< height of its mean
  kNormal,     ///< direction of its normal
  kIntensity,  ///< mean intensity
  kLabel,      ///< class
  kEpoch,      ///< epoch in which it was last seen
  kAge,        ///< how many epochs before the latest it was last seen
  kChange,     ///< what became of it between two maps; only with a diff
};

/// What explains the colours of a picture.
struct ColorLegend {
  std::string title;  ///< with the unit
  double low = 0;     ///< value of the lowest colour of scale_color(), and below
  double high = 0;    ///< of the highest, and above; not above `low`: there is no scale
  std::vector<std::pair<std::string, Rgb8>> entries;
};

/// Gives every voxel of a level its colour. Keeps references to map and level.
class VoxelColors {
 public:
  /// Without a choice the colours of the points, where the map has them, else height. Throws std::invalid_argument
  /// where the map does not know what is asked for.
  VoxelColors(const VoxelMap& map, const VoxelLevel& level, std::optional<ColorBy> color_by = std::nullopt);

  /// The kind of change of each record of the level. What is unchanged is pale, or with `keeps_colors` has the colour
  /// of its points where the map has them.
  VoxelColors(const VoxelMap& map, const VoxelLevel& level, std::vector<Change> changes, bool keeps_colors = false);

  /// Of another level in the colours that equal values have in `like`.
  VoxelColors(const VoxelMap& map, const VoxelLevel& level, const VoxelColors& like);

  LinearColor color_of(const VoxelIndex& voxel, std::size_t record) const;
  const ColorLegend& legend() const { return legend_; }

 private:
  void set_range(std::vector<double> values);
  LinearColor scaled(double value) const;
  LinearColor color_of_change(std::size_t record) const;

  const VoxelMap& map_;
  const VoxelLevel& level_;
  ColorBy color_by_;
  ColorLegend legend_;
  std::vector<LinearColor> scale_;  ///< colours of evenly spaced values from low to high
  std::vector<Change> changes_;     ///< of each record, with a diff
  bool keeps_colors_ = false;
  std::int32_t latest_epoch_ = 0;
  std::int32_t oldest_age_ = 0;  ///< [epochs]
};

}  // namespace vdbmap

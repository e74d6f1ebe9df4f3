// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vdbmap/core/label_scheme.h"
#include "vdbmap/core/voxel_level.h"

namespace vdbmap {

/// Where a map's local frame lies: local = original - anchor, axes parallel.
struct MapFrame {
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();  ///< [m, original system] whole multiples of kTileSize
  std::optional<int> epsg;                           ///< of the original system, where known

  bool operator==(const MapFrame&) const = default;
};

/// A voxel map: levels from the finest to the coarsest, each an exact merge of the one below.
struct VoxelMap {
  MapFrame frame;
  std::vector<VoxelLevel> levels;
  bool has_color = false;                            ///< whether the points had colours; else all colour codes are 0
  LabelScheme label_scheme = LabelScheme::kUnknown;  ///< whose numbers the labels are

  const VoxelLevel& finest() const { return levels.front(); }
  const VoxelLevel& coarsest() const { return levels.back(); }
};

/// The level of the voxel size (to 1e-9), or nullptr.
const VoxelLevel* find_level(const VoxelMap& map, double voxel_size);

/// Sum of the counts of a level.
std::size_t num_points(const VoxelLevel& level);

/// Memory of all levels.
std::size_t memory_bytes(const VoxelMap& map);

/// Corners of the box around all voxels of a level [m, original system]; nothing where there is none.
struct Extent {
  Eigen::Vector3d min;
  Eigen::Vector3d max;
};
std::optional<Extent> extent(const VoxelMap& map);

/// The mean of a voxel [m, original system]. A code stands for a small cube of places (6 um at 10 cm); of each
/// coordinate the one with the fewest decimals is taken that the code stands for: 389012.1 and not 389012.10000305175.
/// A point there has the same code again.
Eigen::Vector3d mean_in_original_system(const MapFrame& frame, const VoxelRecord& record, const VoxelIndex& voxel,
                                        double voxel_size);

/// Whether a map may have this anchor: finite, a whole multiple of 64 m on each axis, and below 1e9 m.
bool is_anchor(const Eigen::Vector3d& anchor);

/// Throws std::invalid_argument unless is_anchor().
void check_anchor(const Eigen::Vector3d& anchor);

/// The anchor for points near `point`: the nearest multiple of 1024 m, so that neighbouring maps mostly share it and
/// small local coordinates keep theirs.
Eigen::Vector3d choose_anchor(const Eigen::Vector3d& point);

}  // namespace vdbmap

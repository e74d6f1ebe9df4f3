// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "parking/segmentation/network_weights.h"
#include "vdbmap/core/voxel_level.h"

namespace vdbmap::parking {

/// Voxels of one size as a network sees them, in the order of the level's records.
struct PyramidLevel {
  /// An occupied voxel near another one.
  struct Neighbour {
    std::uint32_t voxel;  ///< its number
    std::uint32_t step;   ///< number of the difference of the indices in neighbour_steps()
  };

  std::vector<Eigen::Vector3f> places;  ///< mean point within the voxel, 0 to 1 on each axis [voxels]
  std::vector<std::size_t> first;       ///< number of the first neighbour of each voxel; one more at the end
  std::vector<Neighbour> neighbours;    ///< of each voxel the nearest 28 by index, itself first
  std::vector<std::uint32_t> parents;   ///< number of each voxel's parent on the next level; empty on the last

  std::size_t size() const { return places.size(); }

  std::span<const Neighbour> neighbours_of(std::size_t voxel) const {
    return {neighbours.data() + first[voxel], first[voxel + 1] - first[voxel]};
  }
};

/// 0.1, 0.2, 0.4, 0.8 and 1.6 m.
using VoxelPyramid = std::array<PyramidLevel, kNumLevels>;

/// Differences of indices up to a distance of 2.5 voxels, 81 of them: nearest first; of equally near ones x, then y,
/// then z decides.
std::span<const VoxelIndex> neighbour_steps();

/// The pyramid over a level of 0.1 m: coarser voxels are exact merges of those below. Throws std::invalid_argument for
/// another voxel size, std::length_error above 4e9 voxels.
VoxelPyramid make_pyramid(const VoxelLevel& finest);

}  // namespace vdbmap::parking

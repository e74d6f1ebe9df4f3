// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "vdbmap/core/parallel.h"
#include "vdbmap/core/voxel_level.h"

namespace vdbmap::registration {

/// Voxels on each side of a voxel that a ball of `radius` [m] around any of its points can reach.
inline std::int32_t reach_of(double radius, const VoxelLevel& level) {
  return static_cast<std::int32_t>(std::ceil(radius / level.voxel_size()));
}

/// Calls body(number, squared_distance) for every other voxel of the level whose position is within `radius` [m] of
/// that of number `center`, in the order of the tree.
template <typename Body>
void for_each_neighbor(const VoxelFinder& finder, const VoxelLevel& level, std::span<const Eigen::Vector3d> positions,
                       const VoxelIndex& voxel, std::size_t center, double radius, const Body& body) {
  const VoxelRecord* first = level.records().data();
  finder.for_each_around(voxel, reach_of(radius, level), [&](const VoxelIndex&, const VoxelRecord& record) {
    const auto number = static_cast<std::size_t>(&record - first);
    const double squared = (positions[number] - positions[center]).squaredNorm();
    if (number != center && squared <= radius * radius) body(number, squared);
  });
}

/// Calls body(finder, voxel, number) for every voxel of the level, on all threads; the finder serves one task.
template <typename Body>
void parallel_for_each_with_finder(const VoxelLevel& level, const Body& body) {
  constexpr std::size_t kLeafGrain = 16;
  const std::span<const VoxelLeaf> leaves = level.leaves();
  parallel_ranges(leaves.size(), kLeafGrain, [&](std::size_t begin, std::size_t end) {
    const VoxelFinder finder(level);
    for (std::size_t i = begin; i < end; ++i) {
      for_each_voxel(leaves[i], [&](const VoxelIndex& voxel, std::size_t number) { body(finder, voxel, number); });
    }
  });
}

}  // namespace vdbmap::registration

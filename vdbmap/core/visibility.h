// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "vdbmap/core/voxel_level.h"

namespace vdbmap {

/// What rays said of the space around the voxels of a level. Belongs to that level: same voxel size, and values in the
/// order of its records.
struct Visibility {
  double voxel_size = 0;              ///< [m]
  VoxelTree seen_empty{{}};           ///< voxels that rays passed through and that hold no point of the level
  std::vector<std::uint32_t> hits;    ///< a record of the level: rays that ended in the voxel
  std::vector<std::uint32_t> passes;  ///< a record of the level: rays that went through what the voxel holds
};

/// The three answers of a map about a place.
enum class Sight : std::uint8_t { kNeverSeen, kEmpty, kOccupied };

/// Finds what is known of voxels. One per task; keeps references to both.
class SightFinder {
 public:
  SightFinder(const VoxelLevel& level, const Visibility& visibility)
      : occupied_(level.tree()), seen_empty_(visibility.seen_empty) {}

  Sight find(const VoxelIndex& voxel) const {
    const openvdb::Index offset = VoxelLeaf::coordToOffset(voxel);
    if (is_on(occupied_.find_leaf(voxel), offset)) return Sight::kOccupied;
    return is_on(seen_empty_.find_leaf(voxel), offset) ? Sight::kEmpty : Sight::kNeverSeen;
  }

 private:
  static bool is_on(const VoxelLeaf* leaf, openvdb::Index offset) { return leaf && leaf->getValueMask().isOn(offset); }

  const VoxelTree& occupied_;
  const VoxelTree& seen_empty_;
};

/// Memory.
std::size_t memory_bytes(const Visibility& visibility);

}  // namespace vdbmap

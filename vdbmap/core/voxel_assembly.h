// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "vdbmap/core/voxel_block.h"
#include "vdbmap/core/voxel_level.h"

namespace vdbmap {

/// Makes a level of voxels that come one by one in tree order (sorted by key_of_voxel(), each once).
class VoxelAssembly {
 public:
  VoxelAssembly(double voxel_size, std::size_t expected_voxels);

  /// Returns false, and adds nothing, where the order is broken.
  [[nodiscard]] bool add(const VoxelIndex& voxel, const VoxelRecord& record);

  /// To be filled beside add(), one value a voxel, or left empty.
  VoxelChannels& channels() { return channels_; }

  VoxelLevel finish();

 private:
  double voxel_size_;
  VoxelKey last_key_{0};
  LargeVector<VoxelLeaf> leaves_;
  LargeVector<VoxelRecord> records_;
  VoxelChannels channels_;
};

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_assembly.h"

namespace vdbmap {

VoxelAssembly::VoxelAssembly(double voxel_size, std::size_t expected_voxels) : voxel_size_(voxel_size) {
  records_.reserve(expected_voxels);
}

bool VoxelAssembly::add(const VoxelIndex& voxel, const VoxelRecord& record) {
  const VoxelKey key = key_of_voxel(voxel);
  if (!records_.empty() && key <= last_key_) return false;
  last_key_ = key;

  const VoxelIndex origin = VoxelTree::origin_of_leaf(voxel);
  if (leaves_.empty() || leaves_.back().origin() != origin) leaves_.emplace_back(origin);
  leaves_.back().setValueOn(VoxelLeaf::coordToOffset(voxel));
  records_.push_back(record);
  return true;
}

VoxelLevel VoxelAssembly::finish() {
  leaves_.shrink_to_fit();
  return {voxel_size_, std::move(leaves_), std::move(records_), std::move(channels_)};
}

}  // namespace vdbmap

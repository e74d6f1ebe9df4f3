// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_level.h"

namespace vdbmap {

VoxelLevel::VoxelLevel(double voxel_size, LargeVector<VoxelLeaf> leaves, LargeVector<VoxelRecord> records,
                       VoxelChannels channels)
    : voxel_size_(voxel_size), records_(std::move(records)), channels_(std::move(channels)) {
  std::size_t first_record = 0;
  for (VoxelLeaf& leaf : leaves) {
    leaf.setTransientData(static_cast<openvdb::Index32>(first_record));
    first_record += leaf.getValueMask().countOn();
  }
  tree_ = std::make_shared<const VoxelTree>(std::move(leaves));
}

std::size_t VoxelLevel::memory_bytes() const {
  std::size_t bytes = tree_->memory_bytes() + records_.capacity() * sizeof(VoxelRecord);
  for_each_channel([&](const char* /*name*/, auto channel) {
    const auto& values = channels_.*channel;
    bytes += values.capacity() * sizeof(values[0]);
  });
  return bytes;
}

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vdbmap/core/voxel_level.h"

namespace vdbmap {

/// Voxels that hang together, by the numbers of their records, rising.
using VoxelGroup = std::vector<std::size_t>;

/// The groups of those voxels of a level that `is_member` (one value a record, 0 or 1): two voxels belong together
/// where their indices differ by at most `reach` on each axis, or a chain of such leads from one to the other. Groups
/// are sorted by their first voxel.
std::vector<VoxelGroup> find_groups(const VoxelLevel& level, const std::vector<std::uint8_t>& is_member,
                                    std::int32_t reach);

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "vdbmap/core/voxel.h"

namespace vdbmap {

/// Name of a voxel within its level: 21 bits an axis, x highest. The same in every map, file and epoch of one anchor.
enum class VoxelId : std::uint64_t {};

/// The id of an addressable voxel.
VoxelId id_of_voxel(const VoxelIndex& voxel);

/// The voxel of an id.
VoxelIndex voxel_of_id(VoxelId id);

/// Text form: 16 hexadecimal digits, lower case.
std::string to_string(VoxelId id);

/// Reads the text form; nothing where it is not one.
std::optional<VoxelId> parse_voxel_id(std::string_view text);

}  // namespace vdbmap

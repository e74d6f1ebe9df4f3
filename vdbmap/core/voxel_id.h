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

inline constexpr int kIdBits = 21;  ///< an axis

/// The id of an addressable voxel.
inline VoxelId id_of_voxel(const VoxelIndex& voxel) {
  const auto bits = [](std::int32_t index) {
    return static_cast<std::uint64_t>(index + kIndexLimit) & ((std::uint64_t{1} << kIdBits) - 1);
  };
  return VoxelId{bits(voxel.x()) << (2 * kIdBits) | bits(voxel.y()) << kIdBits | bits(voxel.z())};
}

/// The voxel of an id.
inline VoxelIndex voxel_of_id(VoxelId id) {
  const auto index = [id](int shift) {
    const std::uint64_t bits = static_cast<std::uint64_t>(id) >> shift & ((std::uint64_t{1} << kIdBits) - 1);
    return static_cast<std::int32_t>(bits) - kIndexLimit;
  };
  return {index(2 * kIdBits), index(kIdBits), index(0)};
}

/// The id of the voxel `x`, `y`, `z` voxels away, which is addressable too: a few ids around one cost an addition each.
constexpr VoxelId id_beside(VoxelId id, int x, int y, int z) {
  return VoxelId{static_cast<std::uint64_t>(id) + (static_cast<std::uint64_t>(x) << (2 * kIdBits)) +
                 (static_cast<std::uint64_t>(y) << kIdBits) + static_cast<std::uint64_t>(z)};
}

/// Text form: 16 hexadecimal digits, lower case.
std::string to_string(VoxelId id);

/// Reads the text form; nothing where it is not one.
std::optional<VoxelId> parse_voxel_id(std::string_view text);

}  // namespace vdbmap

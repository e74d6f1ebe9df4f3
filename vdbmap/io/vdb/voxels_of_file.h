// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace vdbmap {

/// How many voxels a .vdb file of `file_bytes` may become: a million, and 8 for each of its bytes. A voxel takes some
/// 120 bytes while it is read, so memory stays below 130 MB and a thousand times the file. No map that save_map()
/// writes comes near: the masks of the grid `density` alone take an eighth of a byte a voxel, twice.
inline std::uint64_t most_voxels_of_file(std::uint64_t file_bytes) {
  constexpr std::uint64_t kAlways = std::uint64_t{1} << 20;
  constexpr std::uint64_t kPerByte = 8;
  return kAlways + kPerByte * file_bytes;
}

}  // namespace vdbmap

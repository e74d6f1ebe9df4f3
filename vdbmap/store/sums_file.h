// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "vdbmap/core/finest_level.h"

/// Sums on their way through the disk while a city is built: field by field, each number in as few bytes as it needs
/// (some 40 bytes a voxel, where memory takes 136). Whole numbers come back as they were. A file of appended sums is of
/// one process and gone at its end.
namespace vdbmap {

/// The bytes of blocks: equal blocks give equal bytes.
std::string pack_sums(const VoxelBlocks& blocks);

/// Adds what pack_sums() gave to blocks. Throws IoError (malformed), naming `path`, where it ends too early.
void add_packed_sums(std::string_view bytes, const std::filesystem::path& path, VoxelBlocks& blocks);

/// Appends blocks to a file, which is created where there is none. Throws IoError (system).
void append_sums(const std::filesystem::path& path, const VoxelBlocks& blocks);

/// Adds what append_sums() wrote, all times together, to blocks. Throws IoError.
void add_sums_of_file(const std::filesystem::path& path, VoxelBlocks& blocks);

}  // namespace vdbmap

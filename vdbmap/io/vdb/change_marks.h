// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>

#include "vdbmap/core/voxel_map.h"

namespace vdbmap {

/// What became of a voxel between two maps; the numbers are those of files and pages.
enum class ChangeMark : std::uint8_t { kNone = 0, kAppeared = 1, kVanished = 2, kChanged = 3, kUnobserved = 4 };

/// The voxels of a diff, with what became of each.
struct ChangeMarks {
  MapFrame frame;
  VoxelLevel level;  ///< labels are ChangeMark; records are those of the diff, empty ones where it has none
};

/// Reads a diff of two maps, as `vdbmap diff -o` writes it: a map, and beside it the grids `appeared`, `vanished`,
/// `changed` and `unobserved`, whose active voxels are of that kind. A voxel of several kinds is of the last in the
/// order changed, unobserved, vanished, appeared. Throws IoError (malformed) for files that lack one of the grids, and
/// as load_map().
ChangeMarks load_change_marks(const std::filesystem::path& path);

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "vdbmap/core/voxel_map.h"

namespace vdbmap::test {

/// A street of 300 m across tiles on both sides of the axes, with intensities, labels and epochs, and levels of 10 cm,
/// 1 m and 8 m.
const VoxelMap& street_of_tiles();

/// The files of a city and their bytes, by their names in the folder; not the lock, which says who wrote last. To be
/// compared by == and not by EXPECT_EQ, which would print them.
std::map<std::string, std::string> files_of_city(const std::filesystem::path& folder);

}  // namespace vdbmap::test

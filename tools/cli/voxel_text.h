// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "vdbmap/core/voxel_query.h"

namespace vdbmap::cli {

/// A paragraph a voxel; coordinates to 0.1 mm.
std::string text_of_voxels(const std::vector<VoxelInfo>& voxels);

/// An array with an object a voxel; attributes that the map does not have are null.
nlohmann::ordered_json json_of_voxels(const std::vector<VoxelInfo>& voxels);

}  // namespace vdbmap::cli

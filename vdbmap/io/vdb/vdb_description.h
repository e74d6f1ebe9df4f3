// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <openvdb/Types.h>
#include <openvdb/math/Coord.h>
#include <openvdb/math/Vec3.h>

namespace vdbmap {

/// Names and values as text, in the order of the names.
using TextMetadata = std::vector<std::pair<std::string, std::string>>;

/// What any grid of a .vdb file tells about itself.
struct GridDescription {
  std::string name;
  std::string type;        ///< of the values, as OpenVDB names it: "float", "vec3s", "ptdataidx32"
  std::string grid_class;  ///< "fog volume", "level set", ..., "unknown"
  std::uint64_t num_active_voxels = 0;
  std::optional<openvdb::CoordBBox> bounding_box;  ///< indices of the active voxels, where there are any
  openvdb::Vec3d voxel_size{0.0};  ///< [unit of the file] where the transform is linear; else at the origin
  bool is_linear = true;
  TextMetadata metadata;
};

/// What a .vdb file of any program tells about itself.
struct VdbDescription {
  TextMetadata metadata;
  std::vector<GridDescription> grids;
};

/// Reads a .vdb file of any program. Throws IoError where it is missing, damaged or no .vdb file.
VdbDescription describe_vdb(const std::filesystem::path& path);

}  // namespace vdbmap

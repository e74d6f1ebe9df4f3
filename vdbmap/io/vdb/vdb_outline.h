// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vdbmap {

/// Where a grid lies in a .vdb file, and how it is stored.
struct VdbGridOutline {
  std::string name;
  std::string type;               ///< of the tree, as OpenVDB names it: "Tree_float_5_4_3"
  bool shares_tree = false;       ///< it is an instance: its voxels are those of another grid of the file
  std::uint32_t compression = 0;  ///< flags of openvdb::io; since file version 222
};

/// What a .vdb file says of itself before any grid is read.
struct VdbOutline {
  std::uint32_t version = 0;
  bool has_grid_offsets = false;      ///< else it was written as a stream, and the grids are not listed here
  std::vector<VdbGridOutline> grids;  ///< in the order of the file
};

/// Walks through the headers of a .vdb file and compares what they promise with the size of the file, without OpenVDB,
/// which on a file that was cut reads garbage for minutes, fills the memory or sees nothing. Throws IoError for a file
/// that is missing, is no .vdb file, is newer than OpenVDB 10 or was cut.
VdbOutline read_vdb_outline(const std::filesystem::path& path);

}  // namespace vdbmap

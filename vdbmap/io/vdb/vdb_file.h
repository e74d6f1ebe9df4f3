// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "vdbmap/io/vdb/standard_grids.h"

namespace vdbmap {

/// Grids and file metadata of any .vdb file.
struct VdbContent {
  openvdb::GridPtrVec grids;
  openvdb::MetaMap::Ptr metadata;
};

/// Says by its name whether a grid is to be read; of several grids of one name, the second is "name[1]".
using GridFilter = std::function<bool(const std::string& name)>;

/// Reads a .vdb file, without a filter all of it. One that write_vdb() wrote is compared with its checksum first.
/// Throws IoError for a file that is missing, is no .vdb file or is damaged.
VdbContent read_vdb(const std::filesystem::path& path, const GridFilter& is_wanted = {});

/// Writes grids atomically, compressed as Houdini does (active values, Blosc). Equal content gives equal bytes: the
/// random id that OpenVDB puts into every file is replaced by a checksum of the rest. Throws IoError.
void write_vdb(const std::filesystem::path& path, const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& metadata);

/// Makes a grid of a file.
using GridMaker = std::function<openvdb::GridBase::ConstPtr()>;

/// Writes the same file, but makes each grid when its turn comes and frees it before the next: grids take
/// many times as much memory as the level they are made of. Names of grids must differ.
void write_vdb_grid_by_grid(const std::filesystem::path& path, const std::vector<GridMaker>& grids,
                            const openvdb::MetaMap& metadata);

}  // namespace vdbmap

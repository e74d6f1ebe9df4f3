// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "vdbmap/core/voxel_map.h"
#include "vdbmap/io/vdb/standard_grids.h"

namespace vdbmap {

/// Version of our files; files of another one are refused. Version 1 had colours of 16-bit fixed point.
inline constexpr std::int32_t kMapFormat = 2;

/// Anchor, EPSG code, label scheme, format and creator, as metadata of a file or a grid.
openvdb::MetaMap metadata_of_map(const VoxelMap& map);

/// A grid of a level with the name of its channel, that of the level behind it, and the metadata of the map.
openvdb::GridBase::Ptr labelled(openvdb::GridBase::Ptr grid, const std::string& channel, const VoxelMap& map,
                                const VoxelLevel& level);

/// Reads anchor and EPSG code. Throws IoError where `metadata` is not of a map, or of a newer format.
MapFrame frame_of_metadata(const openvdb::MetaMap& metadata, const std::filesystem::path& path);

/// Reads the label scheme; unknown where nothing is said, or a name that we do not know.
LabelScheme label_scheme_of_metadata(const openvdb::MetaMap& metadata);

/// Whether the metadata is that of a map of ours.
bool has_map_format(const openvdb::MetaMap& metadata);

/// Whether the metadata is that of any file of ours, be it damaged.
bool is_file_of_vdbmap(const openvdb::MetaMap& metadata);

}  // namespace vdbmap

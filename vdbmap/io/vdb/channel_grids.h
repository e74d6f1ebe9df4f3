// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "vdbmap/core/voxel.h"
#include "vdbmap/io/vdb/standard_grids.h"
#include "vdbmap/io/vdb/vdb_file.h"

namespace vdbmap {

/// Channel grids of one level, found by name and judged; a null pointer where the file lacks an optional one.
struct ChannelGrids {
  std::string suffix;     ///< of the names: "" or "_1m"
  double voxel_size = 0;  ///< [m]
  openvdb::Int32Grid::Ptr count;
  openvdb::Vec3SGrid::Ptr mean;  ///< [m] offset from the voxel's centre
  openvdb::Vec3SGrid::Ptr cov_diag;
  openvdb::Vec3SGrid::Ptr cov_offdiag;
  openvdb::Vec3SGrid::Ptr normal;
  openvdb::Vec3SGrid::Ptr color;
  openvdb::FloatGrid::Ptr planarity;
  openvdb::FloatGrid::Ptr intensity;
  openvdb::Int32Grid::Ptr label;
  openvdb::Int32Grid::Ptr first_epoch;
  openvdb::Int32Grid::Ptr last_epoch;
};

/// The channels of all levels, finest first: one level for each grid `count`. Throws IoError where the finest level or
/// a required channel is missing, a grid has the wrong type or transform, a value is not finite, or the grids of a
/// level do not hold the same voxels.
std::vector<ChannelGrids> find_channel_grids(const VdbContent& content, const std::filesystem::path& path);

}  // namespace vdbmap

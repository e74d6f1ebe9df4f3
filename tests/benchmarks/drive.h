// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include <Eigen/Geometry>

#include "vdbmap/core/point_cloud.h"

namespace vdbmap::benchmarks {

/// Real scans and the pose of each.
struct Drive {
  std::vector<std::filesystem::path> files;
  std::vector<PointCloud> scans;
  std::vector<Eigen::Isometry3d> map_from_scan;
};

/// The drive in the folder $VDBMAP_DRIVE (velodyne/ and poses.txt), else kitti_drive5 in $VDBMAP_DATA or in
/// ../shared/data beside the source tree; nullptr where there is none.
const Drive* kitti_drive();

/// kitti00 beside that drive, a residential street; nullptr where there is none.
const Drive* kitti_residential();

/// What a row says that needs the drive where it is missing.
inline constexpr const char* kNoDrive = "no drive found; set VDBMAP_DRIVE to a folder with velodyne/ and poses.txt";

}  // namespace vdbmap::benchmarks

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>

#include <Eigen/Geometry>

#include "vdbmap/core/point_cloud.h"
#include "vdbmap/io/poses/trajectory_file.h"
#include "vdbmap/io/scans/scan_sequence.h"

namespace vdbmap {

/// Whose poses a file holds: KITTI's and SemanticKITTI's are those of the left camera.
enum class PoseFrame {
  kUnknown,  ///< decided by the motion
  kLidar,
  kCamera,
};

/// By the motion from pose to pose: a camera moves mostly along its own z axis, a LiDAR across it. Unknown where they
/// hardly move: less than 1 m in all.
PoseFrame frame_by_motion(const Trajectory& poses);

/// Whether the points spread more along z than along y, as those of a camera's frame do, where y points down; a scan
/// of few points does not tell, and is taken to lie level.
bool lies_level(const PointCloud& scan);

/// The pose of the LiDAR in the frame of the camera by a calib.txt of KITTI: its line "Tr:" or "Tr_velo_to_cam:".
/// Throws IoError where it has none or that is no rigid motion.
Eigen::Isometry3d read_camera_from_lidar(const std::filesystem::path& calibration);

/// The poses of the LiDAR, in its frame at the origin of the camera's.
Trajectory lidar_poses(Trajectory camera_poses, const Eigen::Isometry3d& camera_from_lidar);

/// The calib.txt beside the file of poses, beside the scan or above its folder.
std::optional<std::filesystem::path> find_calibration(const std::filesystem::path& poses,
                                                      const std::filesystem::path& scan);

/// Poses of scans, and whose they were.
struct ScanPoses {
  Trajectory poses;  ///< of the LiDAR; the findings say what was done
  PoseFrame frame = PoseFrame::kLidar;
  std::filesystem::path calibration;  ///< used; empty where the poses were the LiDAR's
};

/// Reads the poses of scans in the LiDAR's frame. Where `frame` is unknown, the motion decides: poses that go along
/// their z while a scan lies level are the camera's. Throws IoError as read_trajectory(), for the camera's poses
/// without a calib.txt, and where one lies there but the poses hardly move, so that whose they are is not known; a
/// single pose is then taken as the LiDAR's.
ScanPoses read_scan_poses(const std::filesystem::path& path, std::span<const ScanPlace> scans,
                          PoseFrame frame = PoseFrame::kUnknown);

}  // namespace vdbmap

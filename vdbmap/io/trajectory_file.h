// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

namespace vdbmap {

/// Poses in the order of their scans.
struct Trajectory {
  std::vector<std::optional<Eigen::Isometry3d>> map_from_scan;  ///< nothing where the scan was not found
  std::vector<double> times;                                    ///< [s] one a pose (TUM), or empty (KITTI)

  std::size_t size() const { return map_from_scan.size(); }
};

enum class TrajectoryFormat {
  kKitti,  ///< a line a pose: 3x4 row-major; twelve times nan where there is no pose
  kTum,    ///< a line a pose: time x y z qx qy qz qw; absent where there is no pose
};

/// Reads KITTI (12 numbers a line) or TUM (8 numbers, '#' comments); the first data line decides. Throws IoError with
/// the line for other numbers of columns, infinity, half-missing poses, and matrices that are not rotations (1e-3). The
/// rotation is made exactly orthonormal.
Trajectory read_trajectory(const std::filesystem::path& path);

/// Writes atomically with 17 significant digits. TUM without times numbers the poses 0, 1, 2, ... Throws IoError.
void write_trajectory(const std::filesystem::path& path, const Trajectory& trajectory, TrajectoryFormat format);

}  // namespace vdbmap

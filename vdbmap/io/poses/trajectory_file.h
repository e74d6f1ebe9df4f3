// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "vdbmap/io/file/read_finding.h"

namespace vdbmap {

/// Poses in the order of their scans.
struct Trajectory {
  std::vector<std::optional<Eigen::Isometry3d>> map_from_scan;  ///< nothing where the scan was not found
  std::vector<double> times;               ///< [s] one a pose (TUM), nan where not known, or empty (KITTI)
  std::vector<ReadFinding> findings = {};  ///< what was doubtful in the file that it was read from

  std::size_t size() const { return map_from_scan.size(); }
};

enum class TrajectoryFormat {
  kKitti,  ///< a line a pose: 3x4 row-major; twelve times nan where there is no pose
  kTum,    ///< a line a pose: time x y z qx qy qz qw; absent where there is no pose or its time is not known
};

/// Reads KITTI (12 numbers a line, or the 16 of a 4x4 matrix) or TUM (8 numbers); the first line with numbers decides.
/// Between the numbers are white space, commas or semicolons; '#', '%' and '//' begin comments. A header before the
/// numbers, also one that is a comment, may name the columns, those of EuRoC for example: then it says which is which.
/// A pose is missing where its numbers are nan or empty or its quaternion is zero. Times in nanoseconds and the like
/// become seconds. Throws IoError with the line for other numbers of columns, decimal commas, infinity, half-missing
/// poses, matrices that are not rotations (1e-3) and quaternions that are not of length 1 (1e-2). The rotation is made
/// exactly orthonormal.
Trajectory read_trajectory(const std::filesystem::path& path);

/// Writes atomically with 17 significant digits. TUM without times numbers the poses 0, 1, 2, ... Throws IoError.
void write_trajectory(const std::filesystem::path& path, const Trajectory& trajectory, TrajectoryFormat format);

}  // namespace vdbmap

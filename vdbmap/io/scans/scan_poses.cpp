// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/scans/scan_poses.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/line_reader.h"
#include "vdbmap/io/file/text.h"

namespace vdbmap {
namespace {

constexpr double kCalibrationTolerance = 1e-3;  // as of poses

std::optional<Eigen::Isometry3d> rigid_motion(std::span<const std::string_view> words) {
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> matrix;
  if (words.size() != static_cast<std::size_t>(matrix.size())) return std::nullopt;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::optional<double> number = parse_number(words[i]);
    if (!number || !std::isfinite(*number)) return std::nullopt;
    matrix.data()[i] = *number;
  }
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.matrix().topRows<3>() = matrix;
  const Eigen::Matrix3d rotation = motion.linear();
  if (!(rotation.transpose() * rotation).isIdentity(kCalibrationTolerance) || rotation.determinant() < 0) {
    return std::nullopt;
  }
  motion.linear() = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
  return motion;
}

bool is_file(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

// Where a scan cannot be read, the command that reads it for its points says so.
bool first_scan_lies_level(std::span<const ScanPlace> scans) {
  if (scans.empty()) return true;
  try {
    return lies_level(ScanReader().read(scans.front()).cloud);
  } catch (const IoError&) {
    return true;
  }
}

constexpr const char* kCalibrationAdvice =
    "; put KITTI's calib.txt beside them for --pose-frame camera, or say --pose-frame lidar";

}  // namespace

PoseFrame frame_by_motion(const Trajectory& poses) {
  constexpr double kLeastWay = 1;  // [m]
  double way = 0;
  double along_z = 0;  // [m^2]
  double across = 0;   // [m^2]
  const Eigen::Isometry3d* last = nullptr;
  for (const auto& pose : poses.map_from_scan) {
    if (!pose) continue;
    if (last) {
      const Eigen::Vector3d step = last->linear().transpose() * (pose->translation() - last->translation());
      way += step.norm();
      along_z += step.z() * step.z();
      across += step.head<2>().squaredNorm();
    }
    last = &*pose;
  }
  if (!(way >= kLeastWay)) return PoseFrame::kUnknown;
  return along_z > across ? PoseFrame::kCamera : PoseFrame::kLidar;
}

bool lies_level(const PointCloud& scan) {
  constexpr std::size_t kFewPoints = 100;
  if (scan.size() < kFewPoints) return true;
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (const Eigen::Vector3d& point : scan.positions) sum += point.array();
  const Eigen::Array3d mean = sum / static_cast<double>(scan.size());
  Eigen::Array3d spread = Eigen::Array3d::Zero();
  for (const Eigen::Vector3d& point : scan.positions) spread += (point.array() - mean).square();
  return spread.z() <= spread.y();
}

Eigen::Isometry3d read_camera_from_lidar(const std::filesystem::path& calibration) {
  LineReader lines(calibration);
  while (const auto line = lines.next()) {
    const std::vector<std::string_view> words = split_words(*line);
    if (words.empty()) continue;
    const std::string_view name = words.front();
    if (name != "Tr:" && name != "Tr_velo_to_cam:" && name != "Tr_velo_cam:" && name != "Tr") continue;
    if (const auto motion = rigid_motion(std::span(words).subspan(1))) return *motion;
    throw IoError::malformed_at_line(calibration, lines.number(),
                                     std::string(name) + " is no rigid motion of 12 numbers");
  }
  throw IoError::malformed(calibration, "has no line 'Tr:' with the pose of the LiDAR in the camera's frame");
}

Trajectory lidar_poses(Trajectory camera_poses, const Eigen::Isometry3d& camera_from_lidar) {
  const Eigen::Isometry3d lidar_from_camera = camera_from_lidar.inverse();
  for (auto& pose : camera_poses.map_from_scan) {
    if (pose) pose = lidar_from_camera * *pose * camera_from_lidar;
  }
  return camera_poses;
}

std::optional<std::filesystem::path> find_calibration(const std::filesystem::path& poses,
                                                      const std::filesystem::path& scan) {
  const std::filesystem::path scans_folder = std::filesystem::absolute(scan).parent_path();
  for (const std::filesystem::path& folder :
       {std::filesystem::absolute(poses).parent_path(), scans_folder, scans_folder.parent_path()}) {
    if (is_file(folder / "calib.txt")) return folder / "calib.txt";
  }
  return std::nullopt;
}

ScanPoses read_scan_poses(const std::filesystem::path& path, std::span<const ScanPlace> scans, PoseFrame frame) {
  ScanPoses read{read_trajectory(path), frame, {}};
  if (frame == PoseFrame::kLidar) return read;
  const auto calibration = find_calibration(path, scans.empty() ? path : scans.front().file);
  const bool is_told = frame == PoseFrame::kCamera;
  const PoseFrame by_motion = is_told ? frame : frame_by_motion(read.poses);
  if (by_motion == PoseFrame::kUnknown && calibration && read.poses.size() > 1) {
    throw IoError::malformed(path, "the poses hardly move, so that they may be the LiDAR's or the camera's of " +
                                       calibration->string() + "; say --pose-frame lidar or camera");
  }
  const bool is_camera = by_motion == PoseFrame::kCamera && (is_told || first_scan_lies_level(scans));
  read.frame = is_camera ? PoseFrame::kCamera : PoseFrame::kLidar;
  if (!is_camera) {
    if (calibration) {
      read.poses.findings.push_back({"the poses are taken as the LiDAR's, " + calibration->string() + " is not used"});
    }
    return read;
  }
  if (!calibration) {
    throw IoError::malformed(path, (is_told ? std::string("the poses are the camera's, but there is no calib.txt")
                                            : "the poses go mostly along their z axis, as a camera's do") +
                                       kCalibrationAdvice);
  }
  read.poses = lidar_poses(std::move(read.poses), read_camera_from_lidar(*calibration));
  read.calibration = *calibration;
  read.poses.findings.push_back(
      {"the poses are taken as the camera's, moved to the LiDAR by " + calibration->string()});
  return read;
}

}  // namespace vdbmap

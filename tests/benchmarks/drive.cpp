// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/benchmarks/drive.h"

#include <cstdlib>
#include <optional>

#include "tests/support/folders.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::benchmarks {
namespace {

std::optional<std::filesystem::path> drive_folder() {
  if (const char* chosen = std::getenv("VDBMAP_DRIVE")) return chosen;
  const auto data = test::real_data_folder();
  if (!data || !std::filesystem::is_directory(*data / "kitti_drive5")) return std::nullopt;
  return *data / "kitti_drive5";
}

std::optional<std::filesystem::path> residential_folder() {
  const auto drive = drive_folder();
  if (!drive) return std::nullopt;
  const std::filesystem::path folder = std::filesystem::absolute(*drive) / ".." / "kitti00";
  return std::filesystem::is_directory(folder) ? std::optional(folder) : std::nullopt;
}

std::optional<Drive> read_drive(const std::optional<std::filesystem::path>& folder) {
  if (!folder) return std::nullopt;
  Drive drive;
  drive.files = list_point_files({*folder / "velodyne"});
  for (const auto& file : drive.files) drive.scans.push_back(read_points(file).cloud);
  for (const auto& pose : read_trajectory(*folder / "poses.txt").map_from_scan) {
    drive.map_from_scan.push_back(pose.value());
  }
  return drive;
}

}  // namespace

const Drive* kitti_drive() {
  static const std::optional<Drive> drive = read_drive(drive_folder());
  return drive ? &*drive : nullptr;
}

const Drive* kitti_residential() {
  static const std::optional<Drive> drive = read_drive(residential_folder());
  return drive ? &*drive : nullptr;
}

}  // namespace vdbmap::benchmarks

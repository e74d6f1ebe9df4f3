// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/tools/map_command.h"

#include <algorithm>
#include <random>
#include <utility>

#include "tests/support/raw_files.h"
#include "vdbmap/io/kitti/kitti_bin.h"
#include "vdbmap/io/ply/ply.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::cli {

const Eigen::Vector3d kUtm(548'901.25, 5'804'077.5, 43.75);

test::CommandResult vdbmap(const std::vector<std::string>& arguments) {
  return test::run_command(VDBMAP_COMMAND, arguments);
}

nlohmann::json json_of(std::vector<std::string> arguments) {
  arguments.emplace_back("--json");
  const test::CommandResult result = vdbmap(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return nlohmann::json::parse(result.out, nullptr, /*allow_exceptions=*/false);
}

std::size_t num_lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

void expect_error(const test::CommandResult& result, ExitCode code, const std::string& part) {
  EXPECT_EQ(result.exit_code, static_cast<int>(code)) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(num_lines(result.err), 1U) << result.err;
  EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
}

PointCloud scan(unsigned seed, std::size_t count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> along(-8.0, 8.0);
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = along(random);
    const double across = along(random);
    const bool on_wall = i % 4 == 0;
    cloud.positions.emplace_back(x, on_wall ? 5.03 : across, on_wall ? across / 4 : -1.72);
    cloud.intensities.push_back(static_cast<float>(i % 100) / 100.0F);
  }
  return cloud;
}

PointCloud points(std::vector<Eigen::Vector3d> positions) {
  PointCloud cloud;
  cloud.positions = std::move(positions);
  return cloud;
}

PointCloud moved(PointCloud cloud, const Eigen::Vector3d& offset) {
  for (Eigen::Vector3d& position : cloud.positions) position += offset;
  return cloud;
}

std::string MapCommand::ply(const std::string& name, const PointCloud& cloud) const {
  write_ply(folder_ / name, cloud);
  return path(name);
}

std::string MapCommand::built(const std::string& name, const PointCloud& cloud,
                              std::vector<std::string> options) const {
  build({ply(name + ".ply", cloud)}, name, options);
  return path(name);
}

std::string MapCommand::scans(std::size_t count) const {
  std::filesystem::create_directories(folder_ / "scans");
  Trajectory poses;
  for (std::size_t i = 0; i < count; ++i) {
    write_kitti_bin(folder_ / "scans" / (std::to_string(i) + ".bin"), scan(static_cast<unsigned>(i)));
    Eigen::Isometry3d pose(Eigen::AngleAxisd(0.1 * static_cast<double>(i), Eigen::Vector3d::UnitZ()));
    pose.translation().x() = static_cast<double>(i);
    poses.map_from_scan.emplace_back(pose);
  }
  write_trajectory(folder_ / "poses.txt", poses, TrajectoryFormat::kKitti);
  return path("scans");
}

void MapCommand::build(const std::vector<std::string>& inputs, const std::string& name,
                       const std::vector<std::string>& options) const {
  std::vector<std::string> arguments = {"build", "-o", path(name)};
  arguments.insert(arguments.end(), inputs.begin(), inputs.end());
  arguments.insert(arguments.end(), options.begin(), options.end());
  const test::CommandResult result = vdbmap(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

void MapCommand::expect_same_bytes(const std::string& name_a, const std::string& name_b) const {
  const std::string a = test::read_raw(folder_ / name_a);
  const std::string b = test::read_raw(folder_ / name_b);
  EXPECT_FALSE(a.empty());
  EXPECT_TRUE(a == b) << name_a << " and " << name_b << " differ";  // EXPECT_EQ would print both
}

}  // namespace vdbmap::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/raw_files.h"
#include "tests/tools/map_command.h"
#include "vdbmap/io/kitti/kitti_bin.h"
#include "vdbmap/io/las/las.h"
#include "vdbmap/io/ply/ply.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::cli {
namespace {

using nlohmann::json;
using test::CommandResult;
using test::read_raw;
using test::write_raw;

using Build = MapCommand;

TEST_F(Build, PrintsASummaryOfTheMap) {
  const PointCloud cloud = points({{0.05, 0.05, 0.05}, {0.06, 0.05, 0.05}, {0.15, 0.05, 0.05}});
  const CommandResult result = vdbmap({"build", ply("a.ply", cloud), "-o", path("map.vdb"), "--epsg", "25832"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_NE(result.out.find("points     3\n"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("level      0.1 m, 2 voxels\n"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("level      1 m, 1 voxels\n"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("extent     0, 0, 0 to 0.2, 0.1, 0.1\n"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("EPSG       25832\n"), std::string::npos) << result.out;
}

TEST_F(Build, TheSummaryAsJsonIsThatOfInfo) {
  const json build = json_of({"build", ply("a.ply", scan(1)), "-o", path("map.vdb"), "--epoch", "3"});
  const json info = json_of({"info", path("map.vdb")});
  for (const char* key : {"points", "levels", "extent", "anchor", "epsg", "attributes", "epochs", "file_bytes"}) {
    EXPECT_EQ(build[key], info[key]) << key;
  }
  EXPECT_EQ(build["points"], 5000);
  EXPECT_EQ(build["dropped_points"], 0);
  EXPECT_EQ(build["files"], 1);
  EXPECT_EQ(info["epochs"], json({{"first", 3}, {"last", 3}}));
}

TEST_F(Build, OneAndTwoThreadsWriteTheSameBytes) {
  const std::string folder = scans(4);
  for (const std::string threads : {"1", "2"}) {
    build({folder}, threads, {"--poses", path("poses.txt"), "--threads", threads});
  }
  expect_same_bytes("1", "2");
}

TEST_F(Build, TheOrderOfTheFilesDoesNotMatter) {
  const std::string a = ply("a.ply", scan(1));
  const std::string b = ply("b.ply", moved(scan(2), {3, 2, 0}));
  const std::string c = ply("c.ply", moved(scan(3), {-3, 1, 0.05}));
  build({a, b, c}, "abc.vdb");
  build({c, a, b}, "cab.vdb");
  expect_same_bytes("abc.vdb", "cab.vdb");
}

TEST_F(Build, PosesMoveTheScans) {
  const std::string folder = scans(3);
  build({folder}, "posed.vdb", {"--poses", path("poses.txt")});
  const Trajectory poses = read_trajectory(path("poses.txt"));
  std::vector<std::string> clouds;
  for (std::size_t i = 0; i < 3; ++i) {
    PointCloud cloud = read_kitti_bin(folder_ / "scans" / (std::to_string(i) + ".bin")).cloud;
    for (Eigen::Vector3d& position : cloud.positions) position = *poses.map_from_scan[i] * position;
    clouds.push_back(ply(std::to_string(i) + ".ply", cloud));
  }
  build(clouds, "moved.vdb");
  const json posed = json_of({"info", path("posed.vdb")});
  const json by_hand = json_of({"info", path("moved.vdb")});
  EXPECT_EQ(posed["points"], by_hand["points"]);
  EXPECT_EQ(posed["extent"], by_hand["extent"]);
}

TEST_F(Build, SelectsScansAndPosesByTheSameNumbers) {
  const std::string folder = scans(5);
  build({folder}, "selected.vdb", {"--poses", path("poses.txt"), "--every", "2", "--offset", "1"});
  const Trajectory poses = read_trajectory(path("poses.txt"));
  Trajectory odd;
  odd.map_from_scan = {poses.map_from_scan[1], poses.map_from_scan[3]};
  write_trajectory(path("odd.txt"), odd, TrajectoryFormat::kKitti);
  build({folder + "/1.bin", folder + "/3.bin"}, "odd.vdb", {"--poses", path("odd.txt")});
  expect_same_bytes("selected.vdb", "odd.vdb");
}

TEST_F(Build, ScansWithoutAPoseAreLeftOutWithAWarning) {
  const std::string folder = scans(3);
  Trajectory poses = read_trajectory(path("poses.txt"));
  poses.map_from_scan[1].reset();
  write_trajectory(path("gaps.txt"), poses, TrajectoryFormat::kKitti);
  const CommandResult result = vdbmap({"build", folder, "--poses", path("gaps.txt"), "-o", path("map.vdb"), "--json"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("gaps.txt: 1 of 3 scans have no pose and are left out"), std::string::npos) << result.err;
  EXPECT_EQ(json::parse(result.out)["points"], 10'000);
}

// A wall's point 10 m ahead of the first scan, which the drive comes nearer to by a metre a scan.
TEST_F(Build, PosesOfKittisCameraAreMovedToTheLidarAndSaid) {
  std::filesystem::create_directories(folder_ / "velodyne");
  std::string poses;
  for (int i = 0; i < 5; ++i) {
    PointCloud cloud = points({{10.05 - i, 0.05, 1.05}});
    cloud.intensities = {0};
    write_kitti_bin(folder_ / "velodyne" / (std::to_string(i) + ".bin"), cloud);
    poses += "1 0 0 0 0 1 0 0 0 0 1 " + std::to_string(i) + "\n";
  }
  write_raw(folder_ / "camera.txt", poses);
  const std::vector<std::string> arguments = {"build", path("velodyne"), "--poses", path("camera.txt"),
                                              "-o",    path("map.vdb"),  "--json"};
  expect_error(vdbmap(arguments), ExitCode::kBadInput, "camera.txt: the poses go mostly along their z axis");
  write_raw(folder_ / "calib.txt", "Tr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n");
  const CommandResult result = vdbmap(arguments);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("camera.txt: the poses are taken as the camera's"), std::string::npos) << result.err;
  const json built = json::parse(result.out);
  EXPECT_EQ(built["pose_frame"], "camera");
  EXPECT_EQ(built["calibration"], path("calib.txt"));
  EXPECT_EQ(built["levels"][0]["voxels"], 1);
}

TEST_F(Build, PosesBeyondTheLastScanAreNotUsed) {
  const std::string folder = scans(3);
  std::filesystem::remove(folder + "/2.bin");
  const CommandResult result = vdbmap({"build", folder, "--poses", path("poses.txt"), "-o", path("map.vdb")});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("3 poses for 2 scans, those left over are not used"), std::string::npos) << result.err;
}

TEST_F(Build, PointsThatAreNotFiniteAreDroppedAndCounted) {
  const std::string file = write_raw(folder_ / "holes.xyz", "1 1 1\nnan 2 2\n2 2 2\n3 inf 3\n");
  const json build = json_of({"build", file, "-o", path("map.vdb")});
  EXPECT_EQ(build["points"], 2);
  EXPECT_EQ(build["dropped_points"], 2);
  const CommandResult text = vdbmap({"build", file, "-o", path("map.vdb")});
  EXPECT_NE(text.out.find("dropped    2 points that are not finite\n"), std::string::npos) << text.out;
}

TEST_F(Build, LevelsFollowTheVoxelSize) {
  const std::string cloud = ply("a.ply", scan(1));
  const auto levels = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"build", cloud, "-o", path("map.vdb")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const json build = json_of(arguments);
    std::vector<double> sizes;
    for (const json& level : build["levels"]) sizes.push_back(level["voxel_size_m"]);
    return sizes;
  };
  EXPECT_EQ(levels({}), (std::vector<double>{0.1, 1}));
  EXPECT_EQ(levels({"--voxel-size", "0.2"}), (std::vector<double>{0.2, 2}));
  EXPECT_EQ(levels({"--voxel-size", "0.25"}), (std::vector<double>{0.25}));  // 2.5 m does not divide 8 m
  EXPECT_EQ(levels({"--levels", "0.5"}), (std::vector<double>{0.5}));
  EXPECT_EQ(levels({"--levels", "0.1,0.5,1"}), (std::vector<double>{0.1, 0.5, 1}));
  EXPECT_EQ(levels({"--voxel-size", "0.5", "--levels", "0.5,1"}), (std::vector<double>{0.5, 1}));
}

TEST_F(Build, TheEpsgCodeOfLasFilesIsTaken) {
  const PointCloud cloud = moved(scan(1), kUtm);
  write_las(folder_ / "a.las", cloud, {.epsg = 25832});
  const json build = json_of({"build", path("a.las"), ply("b.ply", cloud), "-o", path("map.vdb")});
  EXPECT_EQ(build["epsg"], 25832);
  const CommandResult other = vdbmap({"build", path("a.las"), "--epsg", "32632", "-o", path("map.vdb"), "--json"});
  EXPECT_EQ(json::parse(other.out)["epsg"], 32632);
  EXPECT_EQ(other.err, "vdbmap: the files are in EPSG:25832, the map says EPSG:32632\n");
}

TEST_F(Build, WrongUsageIsRefusedBeforeAnyWork) {
  const std::string cloud = ply("a.ply", scan(1));
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"--voxel-size", "0.3"},
      {"--voxel-size", "0.64"},
      {"--levels", "0.1,64"},
      {"--voxel-size", "nan"},
      {"--voxel-size", "0"},
      {"--levels", "0.1,0.25"},
      {"--levels", "1,0.1"},
      {"--levels", "0.1,"},
      {"--levels", ""},
      {"--voxel-size", "0.2", "--levels", "0.1,1"},
      {"--anchor", "1,2,3"},
      {"--anchor", "64,64"},
      {"--anchor", "nan,0,0"},
      {"--epsg", "0"},
      {"--epsg", "4326"},    // degrees
      {"--min-range", "2"},  // from which sensor
      {"--max-range", "50"},
      {"--sensor", "lidar"},
      {"--sensor", "192.168.1.201"},  // of which capture
      {"--epoch", "-1"},
      {"--epoch", "1.5"},
      {"--density", "0"},
      {"--density", "nan"},
      {"--density", "1e9"},
      {"--offset", "1"},
  };
  for (const std::vector<std::string>& options : wrong) {
    SCOPED_TRACE(testing::PrintToString(options));
    std::vector<std::string> arguments = {"build", cloud};
    if (!options.empty()) arguments.insert(arguments.end(), {"-o", path("map.vdb")});
    arguments.insert(arguments.end(), options.begin(), options.end());
    expect_error(vdbmap(arguments), ExitCode::kWrongUsage, "");
    EXPECT_FALSE(std::filesystem::exists(path("map.vdb")));
  }
}

TEST_F(Build, AnInputIsNeverOverwritten) {
  const std::string cloud = ply("a.ply", scan(1));
  const std::string before = read_raw(cloud);
  expect_error(vdbmap({"build", cloud, "-o", folder_ / "." / "a.ply"}), ExitCode::kWrongUsage, "is an input too");
  const std::string folder = scans(1);
  expect_error(vdbmap({"build", folder, "-o", folder + "/0.bin"}), ExitCode::kWrongUsage, "is an input too");
  expect_error(vdbmap({"build", folder, "--poses", path("poses.txt"), "-o", path("poses.txt")}), ExitCode::kWrongUsage,
               "is an input too");
  EXPECT_EQ(read_raw(cloud) == before, true);
}

TEST_F(Build, AnOutputThatCannotBeWrittenIsToldFirst) {
  const std::string broken = write_raw(folder_ / "broken.ply", "ply\nnothing else");
  expect_error(vdbmap({"build", broken, "-o", path("no/such/folder/map.vdb")}), ExitCode::kInputOutputFailed,
               "no/such/folder");
  expect_error(vdbmap({"build", broken, "-o", folder_.path()}), ExitCode::kBadInput,
               "is no city: it holds 'broken.ply'");
  expect_error(vdbmap({"build", path("missing.ply"), "-o", path("map.vdb")}), ExitCode::kInputOutputFailed,
               "missing.ply");
}

}  // namespace
}  // namespace vdbmap::cli

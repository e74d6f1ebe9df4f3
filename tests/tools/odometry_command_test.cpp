// SPDX-License-Identifier: GPL-3.0-or-later
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/support/raw_files.h"
#include "tests/tools/map_command.h"
#include "tools/cli/stop_request.h"
#include "vdbmap/io/kitti/kitti_bin.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/io/poses/trajectory_file.h"
#include "vdbmap/io/vdb/map_file.h"

namespace vdbmap::cli {
namespace {

class OdometryCommand : public MapCommand {
 protected:
  // Scans "0.bin", "1.bin", ... of the same place, each 0.2 m further along x.
  std::string drive(int count) const {
    std::filesystem::create_directories(folder_ / "drive");
    for (int i = 0; i < count; ++i) {
      write_kitti_bin(folder_ / "drive" / (std::to_string(i) + ".bin"), moved(scan(1), {-0.2 * i, 0, 0}));
    }
    return path("drive");
  }

  Trajectory poses(const std::string& name = "odometry.txt") const { return read_trajectory(folder_ / name); }
};

TEST_F(OdometryCommand, WritesAPoseForEveryScan) {
  const test::CommandResult result = vdbmap({"odometry", drive(5), "-o", path("odometry.txt")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(result.out, path("odometry.txt") + ": 5 of 5 scans, 0.8 m\n");
  const Trajectory trajectory = poses();
  ASSERT_EQ(trajectory.size(), 5U);
  for (int i = 0; i < 5; ++i) {
    // The points are those of the map, so that nothing but the spacing of its points is between them.
    EXPECT_NEAR(trajectory.map_from_scan[static_cast<std::size_t>(i)]->translation().x(), 0.2 * i, 0.02) << i;
  }
}

TEST_F(OdometryCommand, WritesTheCombinedCloudAndItsMap) {
  const test::CommandResult result = vdbmap({"odometry", drive(3), "-o", path("odometry.txt"), "--combined",
                                             path("combined.ply"), "--map", path("local.vdb")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const PointCloud combined = read_points(folder_ / "combined.ply").cloud;
  const PointCloud first = read_points(folder_ / "drive" / "0.bin").cloud;
  ASSERT_EQ(combined.size(), 3 * first.size());
  EXPECT_EQ(combined.intensities.size(), combined.size());
  for (std::size_t i = 0; i < first.size(); i += 100) {
    EXPECT_EQ(combined.positions[i], first.positions[i]);  // in the frame of the first scan
    EXPECT_NEAR((combined.positions[2 * first.size() + i] - first.positions[i]).norm(), 0, 0.03);
  }
  const VoxelMap map = load_map(folder_ / "local.vdb");
  EXPECT_EQ(num_points(map.finest()), combined.size());
  EXPECT_EQ(map.levels.size(), 2U);
}

TEST_F(OdometryCommand, ChoosesScansAndFormat) {
  const test::CommandResult result =
      vdbmap({"odometry", drive(6), "--every", "2", "--offset", "1", "--format", "tum", "-o", path("odometry.tum")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Trajectory trajectory = poses("odometry.tum");
  EXPECT_EQ(trajectory.times, (std::vector<double>{0, 1, 2}));
  EXPECT_NEAR(trajectory.map_from_scan[2]->translation().x(), 0.8, 0.02);
}

TEST_F(OdometryCommand, ScansOfNoUseHaveNoPoseAndAreWarnedOf) {
  const std::string folder = drive(6);
  std::ofstream(folder_ / "drive" / "3.bin").close();
  write_kitti_bin(folder_ / "drive" / "4.bin", points({{5, 0, 0}, {0, 5, 0}}));
  const test::CommandResult result = vdbmap({"odometry", folder, "-o", path("odometry.txt")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("3.bin: no pose: "), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("4.bin: no pose: only 2 of 2 points are left"), std::string::npos) << result.err;
  EXPECT_EQ(num_lines(result.err), 2U) << result.err;
  const Trajectory trajectory = poses();
  ASSERT_EQ(trajectory.size(), 6U);
  EXPECT_FALSE(trajectory.map_from_scan[3]);
  EXPECT_FALSE(trajectory.map_from_scan[4]);
  EXPECT_NEAR(trajectory.map_from_scan[5]->translation().x(), 1.0, 0.03);
}

TEST_F(OdometryCommand, WithoutAnyPoseTheAnswerIsNo) {
  write_kitti_bin(folder_ / "few.bin", points({{5, 0, 0}}));
  const test::CommandResult result =
      vdbmap({"odometry", path("few.bin"), "-o", path("odometry.txt"), "--combined", path("combined.ply")});
  EXPECT_EQ(result.exit_code, static_cast<int>(ExitCode::kNo)) << result.err;
  EXPECT_FALSE(poses().map_from_scan.front());
  EXPECT_FALSE(std::filesystem::exists(folder_ / "combined.ply"));
}

TEST_F(OdometryCommand, JsonTellsOfEveryScan) {
  const nlohmann::json report = json_of({"odometry", drive(3), "-o", path("odometry.txt")});
  EXPECT_EQ(report["registered"], 3);
  ASSERT_EQ(report["results"].size(), 3U);
  EXPECT_FALSE(report["results"][0].contains("covariance"));
  EXPECT_EQ(report["results"][1]["covariance"].size(), 6U);
  EXPECT_NEAR(report["results"][2]["previous_from_scan"][0][3], 0.2, 0.02);
  EXPECT_EQ(report["results"][2]["refound"], false);
}

TEST_F(OdometryCommand, AnyNumberOfThreadsGivesTheSameBytes) {
  const std::string folder = drive(4);
  for (const std::string threads : {"1", "4"}) {
    vdbmap({"odometry", folder, "-o", path("poses" + threads), "--map", path(threads + ".vdb"), "--threads", threads});
  }
  expect_same_bytes("poses1", "poses4");
  expect_same_bytes("1.vdb", "4.vdb");
}

TEST_F(OdometryCommand, RefusesOutputsThatCannotBe) {
  const std::string folder = drive(2);
  const std::string poses = path("odometry.txt");
  expect_error(vdbmap({"odometry", folder, "-o", folder + "/0.bin"}), ExitCode::kWrongUsage, "is an input too");
  expect_error(vdbmap({"odometry", folder, "-o", poses, "--combined", path("c.pcd")}), ExitCode::kWrongUsage,
               "expected .ply, .las or .xyz");
  expect_error(vdbmap({"odometry", folder, "-o", poses, "--map", poses}), ExitCode::kWrongUsage,
               "two outputs go to this file");
  expect_error(vdbmap({"odometry", folder, "-o", path("no/where.txt")}), ExitCode::kInputOutputFailed, "no/where.txt");
  expect_error(vdbmap({"odometry", folder, "-o", poses, "--offset", "7"}), ExitCode::kWrongUsage, "chooses none");
  expect_error(vdbmap({"odometry", folder, "-o", poses, "--min-range", "200"}), ExitCode::kWrongUsage, "range.max");
  expect_error(vdbmap({"odometry", path("missing"), "-o", poses}), ExitCode::kInputOutputFailed, "missing");
  EXPECT_FALSE(std::filesystem::exists(poses));
}

TEST_F(OdometryCommand, CtrlCWritesThePosesSoFar) {
  const std::string folder = drive(5);
  test::write_raw(folder_ / "cut.bin", "no whole point");
  for (const int signal : {SIGINT, SIGTERM}) {
    // The same scans again and again, for longer than a signal takes; the second is damaged, and told when its turn has
    // come.
    std::vector<std::string> arguments = {"odometry", "-o", path("odometry.txt"), folder + "/0.bin", path("cut.bin")};
    arguments.insert(arguments.end(), 1000, folder);
    test::RunOptions options;
    options.while_running = [signal](pid_t process) { ::kill(process, signal); };
    options.running_when_err_says = "cut.bin: no pose";
    const test::CommandResult result = test::run_command(VDBMAP_COMMAND, arguments, options);
    EXPECT_EQ(result.exit_code, 128 + signal) << result.err;
    EXPECT_NE(result.err.find("stopped after "), std::string::npos) << result.err;
    const Trajectory trajectory = poses();
    EXPECT_GT(trajectory.size(), 0U);
    EXPECT_LT(trajectory.size(), 5000U);
    EXPECT_TRUE(trajectory.map_from_scan.front());
    std::filesystem::remove(folder_ / "odometry.txt");
  }
}

TEST(StopRequest, ASecondSignalEndsTheProcessAtOnce) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  const StopRequest stop;
  EXPECT_FALSE(stop.is_made());
  EXPECT_EXIT(
      {
        std::raise(SIGINT);
        if (stop.is_made() && static_cast<int>(stop.exit_code()) == 128 + SIGINT) std::raise(SIGTERM);
        std::_Exit(1);
      },
      testing::ExitedWithCode(128 + SIGTERM), "");
}

}  // namespace
}  // namespace vdbmap::cli

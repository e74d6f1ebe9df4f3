// SPDX-License-Identifier: GPL-3.0-or-later
// vdbmap localize with no first guess, on a village that is scanned from a drive through it.
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/pose_distance.h"
#include "tests/support/raw_files.h"
#include "tests/support/synthetic_scene.h"
#include "tests/tools/map_command.h"
#include "vdbmap/io/kitti/kitti_bin.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::cli {
namespace {

using nlohmann::json;

// The map and the scans of a drive through it, made once a program.
class VillageFiles : public MapCommand {
 public:
  VillageFiles() {
    built("village.vdb", test::survey_of_village());
    std::filesystem::create_directories(folder_ / "drive");
    for (int i = 0; i < kNumScans; ++i) {
      Eigen::Isometry3d pose(Eigen::Translation3d(-14 + i, 0.5 + 0.02 * i, 1.8));
      pose.rotate(Eigen::AngleAxisd(2.3 + 0.01 * i, Eigen::Vector3d::UnitZ()));
      truth.map_from_scan.emplace_back(pose);
      test::Scanner scanner;
      scanner.num_azimuths = 600;
      scanner.range_noise = 0.01;
      scanner.seed = static_cast<unsigned>(i) + 1;
      PointCloud cloud = test::scan_scene(test::village(), pose, scanner);
      cloud.intensities.assign(cloud.size(), 0.5F);
      write_kitti_bin(folder_ / "drive" / (std::to_string(i) + ".bin"), cloud);
    }
  }

  const std::filesystem::path& folder() const { return folder_.path(); }

  Trajectory truth;

 private:
  static constexpr int kNumScans = 4;

  void TestBody() override {}
};

class Localize : public MapCommand {
 protected:
  Localize() {
    static const VillageFiles files;
    std::filesystem::copy(files.folder(), folder_.path(), std::filesystem::copy_options::recursive);
    truth_ = files.truth;
  }

  void expect_true(const std::string& poses) const {
    const Trajectory found = read_trajectory(poses);
    ASSERT_EQ(found.size(), truth_.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      ASSERT_TRUE(found.map_from_scan[i]) << i;
      EXPECT_LT(test::distance_between(*found.map_from_scan[i], *truth_.map_from_scan[i]).translation,
                0.04);  // 1 cm of noise
    }
  }

  Trajectory truth_;
};

TEST_F(Localize, FindsScansAndReportsTheEvidence) {
  const test::CommandResult run = vdbmap(
      {"localize", path("village.vdb"), path("drive"), "-o", path("poses.txt"), "--report", path("report.json")});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out, path("poses.txt") + ": 4 of 4 scans found\n");
  expect_true(path("poses.txt"));

  const json report = json::parse(test::read_raw(folder_ / "report.json"));
  EXPECT_EQ(report["found"], 4);
  ASSERT_EQ(report["results"].size(), 4U);
  EXPECT_EQ(report["results"][0]["covariance"].size(), 6U);
  ASSERT_EQ(report["batches"].size(), 1U);
  EXPECT_EQ(report["batches"][0]["scans"], 4);
  EXPECT_GT(report["batches"][0]["candidates"][0]["surface_agreement"], 0.5);
}

TEST_F(Localize, TakesTheOdometryOfTheOtherCommand) {
  EXPECT_EQ(vdbmap({"odometry", path("drive"), "-o", path("odometry.txt")}).exit_code, 0);
  EXPECT_EQ(vdbmap({"localize", path("village.vdb"), path("drive"), "--odometry", path("odometry.txt"), "--batch", "4",
                    "--upright", "-o", path("poses.txt")})
                .exit_code,
            0);
  expect_true(path("poses.txt"));
}

TEST_F(Localize, GivesTheSameBytesForAnyNumberOfThreads) {
  for (const std::string threads : {"1", "4"}) {
    vdbmap({"localize", path("village.vdb"), path("drive"), "--threads", threads, "-o", path(threads), "--report",
            path("report" + threads)});
  }
  expect_same_bytes("1", "4");
}

TEST_F(Localize, AMapOfAnotherPlaceFindsNothing) {
  built("room.vdb", test::sample_scene(test::room(), 200, 1));
  const test::CommandResult run = vdbmap({"localize", path("room.vdb"), path("drive"), "-o", path("poses.txt")});
  EXPECT_EQ(run.exit_code, static_cast<int>(ExitCode::kNo));
  EXPECT_NE(run.err.find("0.bin: not found: "), std::string::npos) << run.err;
  const Trajectory poses = read_trajectory(path("poses.txt"));
  ASSERT_EQ(poses.size(), 4U);
  for (const auto& pose : poses.map_from_scan) EXPECT_FALSE(pose);
}

TEST_F(Localize, ScansOfNoUseAreNamedAndTheOthersFound) {
  std::ofstream(folder_ / "drive" / "1b.bin") << "no scan";
  std::ofstream far(folder_ / "drive" / "2b.csv");
  far << "x,y,z\n500,0,0\n0,500,0\n";
  far.close();
  Trajectory guess;
  guess.map_from_scan = {truth_.map_from_scan.front()};
  write_trajectory(folder_ / "guess.txt", guess, TrajectoryFormat::kKitti);
  for (const std::vector<std::string>& mode : {std::vector<std::string>{}, {"--initial", path("guess.txt")}}) {
    std::vector<std::string> arguments = {"localize", path("village.vdb"), path("drive"), "-o", path("poses.txt")};
    arguments.insert(arguments.end(), mode.begin(), mode.end());
    const test::CommandResult run = vdbmap(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out, path("poses.txt") + ": 4 of 6 scans found\n");
    EXPECT_NE(run.err.find("1b.bin: not found: "), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("2b.csv: not found: "), std::string::npos) << run.err;
  }
}

TEST_F(Localize, AMapWithoutTheCoarseLevelIsBadInput) {
  built("fine.vdb", test::sample_scene(test::room(), 20, 1), {"--levels", "0.1"});
  expect_error(vdbmap({"localize", path("fine.vdb"), path("drive"), "-o", path("poses.txt")}), ExitCode::kBadInput,
               "fine.vdb: the map has no level of 1 m");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "poses.txt"));
}

TEST_F(Localize, OdometryWithOtherThanOnePoseAScanIsBadInput) {
  Trajectory three = truth_;
  three.map_from_scan.pop_back();
  write_trajectory(folder_ / "three.txt", three, TrajectoryFormat::kKitti);
  expect_error(vdbmap({"localize", path("village.vdb"), path("drive"), "--odometry", path("three.txt"), "-o",
                       path("poses.txt")}),
               ExitCode::kBadInput, "three.txt");
}

TEST_F(Localize, GuessesExcludeWhatBelongsToTheSearch) {
  write_trajectory(folder_ / "guess.txt", truth_, TrajectoryFormat::kKitti);
  for (const std::vector<std::string>& option :
       {std::vector<std::string>{"--batch", "3"}, {"--upright"}, {"--odometry", path("guess.txt")}}) {
    std::vector<std::string> arguments = {
        "localize", path("village.vdb"), path("drive"), "--initial", path("guess.txt"), "-o", path("poses.txt")};
    arguments.insert(arguments.end(), option.begin(), option.end());
    EXPECT_EQ(vdbmap(arguments).exit_code, static_cast<int>(ExitCode::kWrongUsage)) << option.front();
  }
  EXPECT_EQ(vdbmap({"localize", path("village.vdb"), path("drive"), "--batch", "0", "-o", path("p")}).exit_code, 2);
}

}  // namespace
}  // namespace vdbmap::cli

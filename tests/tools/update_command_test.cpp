// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/raw_files.h"
#include "tests/support/synthetic_scene.h"
#include "tests/tools/map_command.h"
#include "vdbmap/io/kitti/kitti_bin.h"
#include "vdbmap/io/kitti/label_file.h"
#include "vdbmap/io/las/las.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::cli {
namespace {

using nlohmann::json;
using test::CommandResult;

test::Scene yard(bool has_box) {
  test::Scene scene = {{{-15, -10, 0.03}, {30, 0, 0}, {0, 20, 0}}, {{-15, 8, 0}, {30, 0, 0}, {0, 0, 5}}};
  if (!has_box) return scene;
  const test::Scene more = test::box({0, 3, 0.3}, {3, 5, 1.6});
  scene.insert(scene.end(), more.begin(), more.end());
  return scene;
}

class Update : public MapCommand {
 protected:
  // Six scans along x and their poses, in a folder of this name.
  std::string drive(const std::string& name, bool has_box) const {
    const std::string folder = path(name);
    std::filesystem::create_directory(folder);
    Trajectory poses;
    for (int i = 0; i < 6; ++i) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.translation() = Eigen::Vector3d(-4 + i, 0.02 * i, 1.9);
      const test::Scanner scanner{
          .num_beams = 32, .num_azimuths = 600, .min_elevation_deg = -24, .max_elevation_deg = 8};
      write_kitti_bin(folder + "/" + std::to_string(i) + ".bin", test::scan_scene(yard(has_box), pose, scanner));
      poses.map_from_scan.emplace_back(pose);
    }
    write_trajectory(poses_of(name), poses, TrajectoryFormat::kKitti);
    return folder;
  }

  std::string poses_of(const std::string& name) const { return path(name) + "_poses.txt"; }

  std::string map_with_box() const {
    const std::string map = path("before.vdb");
    const CommandResult result = vdbmap({"build", drive("first", true), "--poses", poses_of("first"), "--visibility",
                                         "--pose-frame", "lidar", "--epoch", "1", "--date", "2023-03-02", "-o", map});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return map;
  }

  std::vector<std::string> arguments(const std::string& map, const std::string& name, const std::string& output) const {
    return {"update", map, path(name), "--poses", poses_of(name), "--pose-frame", "lidar", "-o", path(output)};
  }
};

TEST_F(Update, TakesAwayWhatIsGoneAndKeepsTheHistory) {
  const std::string before = map_with_box();
  drive("second", false);
  std::vector<std::string> command = arguments(before, "second", "after.vdb");
  command.insert(command.end(), {"--date", "2023-09-14"});
  const json report = json_of(command);
  EXPECT_EQ(report["epoch"], 2);
  EXPECT_EQ(report["date"], "2023-09-14");
  EXPECT_EQ(report["scans"], 6);
  EXPECT_GT(report["voxels"]["gone"], 50);
  EXPECT_GT(report["voxels"]["confirmed"], 1000);
  const json log = json_of({"log", path("after.vdb")});
  ASSERT_EQ(log.size(), 2U);
  EXPECT_EQ(log[0]["date"], "2023-03-02");
  EXPECT_EQ(log[1]["changes"]["gone"], report["voxels"]["gone"]);
  EXPECT_EQ(log[1]["new_sources"].size(), 6U);
  const json info = json_of({"info", path("after.vdb")});
  EXPECT_EQ(info["visibility"], true);
  EXPECT_EQ(info["epochs"], json({{"first", 1}, {"last", 2}}));
  EXPECT_EQ(vdbmap({"check", path("after.vdb")}).exit_code, 0);
}

TEST_F(Update, ClassesThatAreNotWantedDoNotComeIntoTheMap) {
  const std::string before = map_with_box();
  drive("second", false);
  constexpr std::uint16_t kPerson = 30;
  constexpr std::uint16_t kRoad = 40;
  std::filesystem::create_directory(path("labels"));
  std::size_t num_persons = 0;
  for (int i = 0; i < 6; ++i) {
    const std::string name = std::to_string(i);
    std::vector<PointLabel> labels;
    for (const Eigen::Vector3d& point : read_points(path("second/" + name + ".bin")).cloud.positions) {
      labels.push_back({point.x() > 0 ? kPerson : kRoad, 0});
      num_persons += point.x() > 0 ? 1 : 0;
    }
    write_labels(path("labels/" + name + ".label"), labels);
  }
  std::vector<std::string> command = arguments(before, "second", "after.vdb");
  command.insert(command.end(), {"--labels", path("labels"), "--drop", "person"});
  const json report = json_of(command);
  EXPECT_EQ(report["points_of_dropped_classes"], num_persons);
  std::size_t num_points = 0;
  for (int i = 0; i < 6; ++i) {
    num_points += read_points(path("second/" + std::to_string(i) + ".bin")).cloud.size();
  }
  EXPECT_EQ(report["voxels"]["points"], num_points - num_persons);
}

TEST_F(Update, TheSameScansAreNotCountedTwice) {
  const std::string before = map_with_box();
  expect_error(vdbmap(arguments(before, "first", "twice.vdb")), ExitCode::kWrongUsage, "were counted in");
  EXPECT_FALSE(std::filesystem::exists(path("twice.vdb")));
}

TEST_F(Update, TheSameInputGivesTheSameBytesForAnyNumberOfThreads) {
  const std::string before = map_with_box();
  drive("second", false);
  std::vector<std::string> one = arguments(before, "second", "one.vdb");
  one.insert(one.end(), {"--threads", "1"});
  std::vector<std::string> four = arguments(before, "second", "four.vdb");
  four.insert(four.end(), {"--threads", "4"});
  EXPECT_EQ(vdbmap(one).exit_code, 0);
  EXPECT_EQ(vdbmap(four).exit_code, 0);
  expect_same_bytes("one.vdb", "four.vdb");
}

TEST_F(Update, ScansWithoutAPoseAreLeftOutAndSaid) {
  const std::string before = map_with_box();
  drive("second", false);
  Trajectory poses = read_trajectory(poses_of("second"));
  poses.map_from_scan[2].reset();
  write_trajectory(poses_of("second"), poses, TrajectoryFormat::kKitti);
  const CommandResult result = vdbmap(arguments(before, "second", "after.vdb"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("1 of 6 scans have no pose"), std::string::npos) << result.err;
}

TEST_F(Update, UncertainScansAreLeftOutAndCounted) {
  const std::string before = map_with_box();
  const std::string folder = drive("second", false);
  json report = {{"results", json::array()}};
  for (int i = 0; i < 6; ++i) {
    json covariance = json::array();
    for (int row = 0; row < 6; ++row) {
      std::vector<double> values(6, 0.0);
      values[static_cast<std::size_t>(row)] = i == 3 && row == 4 ? 0.09 : 1e-4;  // 0.3 m along y
      covariance.push_back(values);
    }
    report["results"].push_back(
        {{"file", folder + "/" + std::to_string(i) + ".bin"}, {"found", true}, {"covariance", covariance}});
  }
  test::write_raw(path("report.json"), report.dump());
  std::vector<std::string> command = arguments(before, "second", "after.vdb");
  command.insert(command.end(), {"--localized", path("report.json")});
  const json updated = json_of(command);
  EXPECT_EQ(updated["scans_too_uncertain"], 1);
  EXPECT_EQ(updated["scans"], 5);
  test::write_raw(path("other.json"), "{\"scans\": 3}");
  command.back() = path("other.json");
  expect_error(vdbmap(command), ExitCode::kBadInput, "no report of vdbmap localize");
}

TEST_F(Update, ScansThatDoNotMeetTheMapChangeNothing) {
  const std::string before = map_with_box();
  drive("far", false);
  Trajectory poses = read_trajectory(poses_of("far"));
  for (auto& pose : poses.map_from_scan) pose->translation().x() += 5000;
  write_trajectory(poses_of("far"), poses, TrajectoryFormat::kKitti);
  expect_error(vdbmap(arguments(before, "far", "after.vdb")), ExitCode::kBadInput, "do not meet the map");
  EXPECT_FALSE(std::filesystem::exists(path("after.vdb")));
}

TEST_F(Update, WrongUseIsSaidInOneLine) {
  const std::string before = map_with_box();
  drive("second", false);
  std::vector<std::string> date = arguments(before, "second", "after.vdb");
  date.insert(date.end(), {"--date", "2023-02-30"});
  expect_error(vdbmap(date), ExitCode::kWrongUsage, "2023-02-30");
  std::vector<std::string> epoch = arguments(before, "second", "after.vdb");
  epoch.insert(epoch.end(), {"--epoch", "0"});
  expect_error(vdbmap(epoch), ExitCode::kWrongUsage, "the map is of epoch 1");
  expect_error(vdbmap(arguments(path("missing.vdb"), "second", "after.vdb")), ExitCode::kInputOutputFailed,
               "missing.vdb");
}

TEST_F(Update, CitiesAreRefusedByName) {
  const std::string before = map_with_box();
  drive("second", false);
  EXPECT_EQ(vdbmap({"export", before, path("city/")}).exit_code, 0);
  expect_error(vdbmap(arguments(path("city/"), "second", "after.vdb")), ExitCode::kWrongUsage, "is a city");
  expect_error(vdbmap(arguments(before, "second", "city/")), ExitCode::kWrongUsage, "is a city");
}

TEST_F(Update, ChangesOfAnEpochThatGoesOnAddUp) {
  const std::string before = map_with_box();
  drive("second", false);
  drive("third", true);
  Trajectory poses = read_trajectory(poses_of("third"));  // a hair beside those of the first drive, or it were counted
  for (auto& pose : poses.map_from_scan) pose->translation().y() += 0.001;
  write_trajectory(poses_of("third"), poses, TrajectoryFormat::kKitti);
  const auto in_epoch_5 = [&](const std::string& map, const std::string& name, const std::string& output) {
    std::vector<std::string> command = arguments(map, name, output);
    command.insert(command.end(), {"--epoch", "5"});
    return json_of(command)["voxels"];
  };
  const json first = in_epoch_5(before, "second", "b.vdb");
  const json second = in_epoch_5(path("b.vdb"), "third", "c.vdb");
  const json log = json_of({"log", path("c.vdb")});
  ASSERT_EQ(log.size(), 2U);
  EXPECT_EQ(log[1]["changes"]["added"], first["added"].get<int>() + second["added"].get<int>());
}

// A survey whose points have times, and its trajectory.
class SurveyRaysCommand : public MapCommand {
 protected:
  std::string survey(bool has_times, double first_time) const {
    PointCloud cloud;
    for (int i = 0; i < 4000; ++i) {
      cloud.positions.emplace_back(0.01 * (i % 400), 5 + 0.001 * (i % 7), 0.02 * (i / 40 % 100));
      if (has_times) cloud.times.push_back(first_time + 0.001 * i);
    }
    write_las(path("survey.las"), cloud);
    return path("survey.las");
  }

  std::string trajectory() const {
    Trajectory poses;
    for (int i = 0; i < 5; ++i) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.translation() = Eigen::Vector3d(i, 0, 0);
      poses.map_from_scan.emplace_back(pose);
      poses.times.push_back(100 + i);
    }
    write_trajectory(path("way.tum"), poses, TrajectoryFormat::kTum);
    return path("way.tum");
  }
};

TEST_F(SurveyRaysCommand, KeepWhatIsFree) {
  const CommandResult result =
      vdbmap({"build", survey(true, 100), "--trajectory", trajectory(), "--lever-arm", "0,0,1", "-o", path("a.vdb")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(json_of({"info", path("a.vdb")})["visibility"], true);
  const CommandResult plain = vdbmap({"build", survey(true, 100), "-o", path("b.vdb")});
  EXPECT_EQ(plain.exit_code, 0);
  EXPECT_NE(vdbmap({"info", path("b.vdb")}).out.find("was never seen"), std::string::npos);
}

TEST_F(SurveyRaysCommand, ADateNeedsNone) {
  EXPECT_EQ(vdbmap({"build", survey(false, 0), "--date", "2023-03-02", "-o", path("a.vdb")}).exit_code, 0);
  EXPECT_EQ(json_of({"log", path("a.vdb")})[0]["date"], "2023-03-02");
  expect_error(vdbmap({"build", survey(false, 0), "--date", "2023-03-02", "-o", path("city/")}), ExitCode::kWrongUsage,
               "--date");
}

TEST_F(SurveyRaysCommand, NeedTimesOfTheTrajectory) {
  expect_error(vdbmap({"build", survey(false, 0), "--trajectory", trajectory(), "-o", path("a.vdb")}),
               ExitCode::kBadInput, "have no times");
  expect_error(vdbmap({"build", survey(true, 5000), "--trajectory", trajectory(), "-o", path("a.vdb")}),
               ExitCode::kBadInput, "5000.000 to");
  EXPECT_FALSE(std::filesystem::exists(path("a.vdb")));
}

}  // namespace
}  // namespace vdbmap::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/raw_files.h"
#include "tests/support/sample_maps.h"
#include "tests/support/synthetic_scene.h"
#include "tests/tools/map_command.h"
#include "vdbmap/io/kitti/kitti_bin.h"
#include "vdbmap/io/kitti/label_file.h"
#include "vdbmap/io/las/las.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/io/poses/trajectory_file.h"
#include "vdbmap/store/city_lock.h"
#include "vdbmap/store/seen_window.h"

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

// The map with the box as a city, and what of a second drive without it is known.
class UpdateCity : public Update {
 protected:
  UpdateCity() {
    drive("second", false);
    EXPECT_EQ(vdbmap({"export", map_with_box(), city()}).exit_code, 0);
    manifest_ = test::read_raw(path("city/map.json"));
  }

  std::string city() const { return path("city/"); }

  std::vector<std::string> into(const std::string& name, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"update",       "--into", city(),    path(name), "--poses", poses_of(name),
                                          "--pose-frame", "lidar",  "--epoch", "2",        "--date",  "2023-09-14"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  // Refused, and the city is what it was.
  void expect_refused(const std::vector<std::string>& command, ExitCode code, const std::string& part) const {
    expect_error(vdbmap(command), code, part);
    EXPECT_EQ(test::read_raw(path("city/map.json")), manifest_);
    EXPECT_EQ(vdbmap({"check", city()}).exit_code, 0);
  }

  std::string manifest_;
};

TEST_F(UpdateCity, IsThatOfTheMapByteForByte) {
  std::vector<std::string> command = arguments(path("before.vdb"), "second", "after.vdb");
  command.insert(command.end(), {"--epoch", "2", "--date", "2023-09-14"});
  const json expected = json_of(command);
  const json report = json_of(into("second", {"--memory", "1M"}));
  EXPECT_EQ(report["voxels"], expected["voxels"]);
  EXPECT_GT(report["tiles"], 1);
  EXPECT_EQ(vdbmap({"export", city(), path("exported.vdb")}).exit_code, 0);
  expect_same_bytes("exported.vdb", "after.vdb");
  EXPECT_EQ(vdbmap({"export", path("city@1"), path("exported_before.vdb")}).exit_code, 0);
  expect_same_bytes("exported_before.vdb", "before.vdb");
  EXPECT_EQ(vdbmap({"check", city()}).exit_code, 0);
}

TEST_F(UpdateCity, TellsItsEpochsAndItsRays) {
  EXPECT_EQ(json_of({"info", city()})["visibility"], true);
  const json report = json_of(into("second"));
  const json log = json_of({"log", city()});
  ASSERT_EQ(log.size(), 2U);
  EXPECT_EQ(log[0]["date"], "2023-03-02");
  EXPECT_EQ(log[1]["date"], "2023-09-14");
  EXPECT_EQ(log[1]["changes"]["gone"], report["voxels"]["gone"]);
  EXPECT_EQ(log[1]["new_sources"].size(), 6U);
  const CommandResult text = vdbmap({"log", city()});
  EXPECT_NE(text.out.find("epoch 2 (2023-09-14)"), std::string::npos) << text.out;
  EXPECT_NE(vdbmap({"info", city()}).out.find("rays       kept in"), std::string::npos);
}

TEST_F(UpdateCity, DiffOfItsEpochsIsThatOfTheMaps) {
  EXPECT_EQ(vdbmap(arguments(path("before.vdb"), "second", "after.vdb")).exit_code, 0);
  EXPECT_EQ(vdbmap(into("second")).exit_code, 0);
  const json expected = json_of({"diff", path("before.vdb"), path("after.vdb")});
  EXPECT_GT(expected["voxels"]["vanished"], 20);
  const json found = json_of({"diff", path("city@1"), path("city@2")});
  EXPECT_EQ(found["voxels"], expected["voxels"]);
  EXPECT_EQ(found["regions"], expected["regions"]);
}

TEST_F(UpdateCity, KeepsWhatRaysSawWhenItIsSegmented) {
  EXPECT_EQ(vdbmap(into("second")).exit_code, 0);
  EXPECT_EQ(vdbmap({"segment", city(), "-o", path("labelled/")}).exit_code, 0);
  const LoadedMap plain = load_seen_map_or_city(city());
  const LoadedMap labelled = load_seen_map_or_city(path("labelled/"));
  EXPECT_EQ(labelled.map.finest().channels().labels.size(), plain.map.finest().size());
  ASSERT_TRUE(labelled.visibility);
  EXPECT_TRUE(labelled.visibility->hits == plain.visibility->hits);
  EXPECT_TRUE(labelled.visibility->passes == plain.visibility->passes);
  EXPECT_EQ(labelled.visibility->seen_empty.num_voxels(), plain.visibility->seen_empty.num_voxels());
  EXPECT_EQ(vdbmap({"check", path("labelled/")}).exit_code, 0);
}

TEST_F(UpdateCity, TheSameScansAreNotCountedTwice) {
  EXPECT_EQ(vdbmap(into("second")).exit_code, 0);
  const std::string manifest = test::read_raw(path("city/map.json"));
  expect_error(vdbmap(into("second")), ExitCode::kWrongUsage, "were counted in " + city() + " before");
  EXPECT_EQ(test::read_raw(path("city/map.json")), manifest);
}

TEST_F(UpdateCity, GoesToAnotherFolder) {
  std::vector<std::string> command = arguments(city(), "second", "other/");
  EXPECT_EQ(vdbmap(command).exit_code, 0);
  EXPECT_EQ(test::read_raw(path("city/map.json")), manifest_);
  EXPECT_EQ(vdbmap({"check", path("other/")}).exit_code, 0);
  expect_error(vdbmap(command), ExitCode::kBadInput, "holds a city already");
}

TEST_F(UpdateCity, WrongUseChangesNothing) {
  expect_refused(arguments(city(), "second", "after.vdb"), ExitCode::kWrongUsage, "is a city, write what comes of it");
  expect_refused(arguments(path("before.vdb"), "second", "other/"), ExitCode::kWrongUsage, "is no city");
  expect_refused(arguments(city(), "second", "city"), ExitCode::kWrongUsage, "use --into");
  expect_refused({"update", path("before.vdb"), "--poses", poses_of("second"), "-o", path("after.vdb")},
                 ExitCode::kWrongUsage, "SCANS is required");
  expect_refused({"update", city(), path("second"), "--poses", poses_of("second")}, ExitCode::kWrongUsage,
                 "--output or --into is required");
  std::vector<std::string> early = into("second");
  early[std::distance(early.begin(), std::ranges::find(early, "2"))] = "0";
  expect_refused(early, ExitCode::kWrongUsage, "is in epoch 1 already");
  std::vector<std::string> past = into("second");
  past[2] = path("city@1");
  expect_refused(past, ExitCode::kWrongUsage, "is an epoch of a city");
  std::vector<std::string> missing = into("second");
  missing[2] = path("none/");
  expect_refused(missing, ExitCode::kInputOutputFailed, "none");
}

TEST_F(UpdateCity, PosesThatCannotBeChangeNothing) {
  const Trajectory good = read_trajectory(poses_of("second"));
  Trajectory poses = good;
  for (auto& pose : poses.map_from_scan) pose->translation().x() += 5000;
  write_trajectory(poses_of("second"), poses, TrajectoryFormat::kKitti);
  expect_refused(into("second"), ExitCode::kBadInput, "do not meet the map " + city());
  poses = good;
  poses.map_from_scan.pop_back();
  write_trajectory(poses_of("second"), poses, TrajectoryFormat::kKitti);
  expect_refused(into("second"), ExitCode::kBadInput, "5 poses for 6 scans");
  std::filesystem::remove(poses_of("second"));
  expect_refused(into("second"), ExitCode::kInputOutputFailed, "second_poses.txt");
  poses = good;
  poses.map_from_scan[2].reset();
  write_trajectory(poses_of("second"), poses, TrajectoryFormat::kKitti);
  const CommandResult result = vdbmap(into("second"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("1 of 6 scans have no pose"), std::string::npos) << result.err;
}

TEST_F(UpdateCity, AnotherWriterAndADamagedTileAreNamed) {
  {
    const CityLock lock(path("city"));
    expect_refused(into("second"), ExitCode::kInputOutputFailed, "city");
  }
  for (const auto& tile : std::filesystem::directory_iterator(path("city/tiles"))) {
    test::write_raw(tile.path(), "damaged");
  }
  expect_error(vdbmap(into("second")), ExitCode::kBadInput, "city/tiles/");
  EXPECT_EQ(test::read_raw(path("city/map.json")), manifest_);
}

TEST_F(UpdateCity, OneThatCannotBeWrittenStaysAsItIs) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  ::chmod(path("city").c_str(), 0555);
  expect_refused(into("second"), ExitCode::kInputOutputFailed, "cannot");
  ::chmod(path("city").c_str(), 0755);
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

  // A wall along x on both sides of the border of two tiles, `farther` [m] behind that of the first survey.
  std::string wide_survey(const std::string& name, double farther) const {
    PointCloud cloud;
    for (int i = 0; i < 12'000; ++i) {
      cloud.positions.emplace_back(0.05 * (i % 400) - 10, 5 + farther + 0.001 * (i % 7), 0.03 * (i / 400 % 100) + 0.01);
      cloud.times.push_back(100 + 0.0003 * i);
    }
    write_las(path(name), cloud);
    return path(name);
  }

  std::string wide_trajectory() const {
    Trajectory poses;
    for (int i = 0; i < 5; ++i) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.translation() = Eigen::Vector3d(5.0 * i - 10, 0, 1);
      poses.map_from_scan.emplace_back(pose);
      poses.times.push_back(100 + i);
    }
    write_trajectory(path("wide.tum"), poses, TrajectoryFormat::kTum);
    return path("wide.tum");
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

// What two maps, files or cities, know of rays.
void expect_same_rays(const LoadedMap& a, const LoadedMap& b) {
  EXPECT_EQ(test::difference(a.map, b.map), "");
  ASSERT_TRUE(a.visibility && b.visibility);
  EXPECT_TRUE(a.visibility->hits == b.visibility->hits);
  EXPECT_TRUE(a.visibility->passes == b.visibility->passes);
  ASSERT_EQ(a.visibility->seen_empty.leaves().size(), b.visibility->seen_empty.leaves().size());
  for (std::size_t i = 0; i < a.visibility->seen_empty.leaves().size(); ++i) {
    const VoxelLeaf& leaf = a.visibility->seen_empty.leaves()[i];
    const VoxelLeaf* other = b.visibility->seen_empty.find_leaf(leaf.origin());
    ASSERT_TRUE(other && other->getValueMask() == leaf.getValueMask()) << leaf.origin();
  }
}

TEST_F(SurveyRaysCommand, OfACityAreThoseOfTheMapForAnyMemory) {
  const std::string wide = wide_survey("wide.las", 0);
  const std::vector<std::string> rays = {"--trajectory", wide_trajectory(), "--date", "2023-03-02", "--epoch", "1"};
  std::vector<std::string> one = {"build", wide, "-o", path("one.vdb")};
  one.insert(one.end(), rays.begin(), rays.end());
  EXPECT_EQ(vdbmap(one).exit_code, 0);
  for (const char* memory : {"1M", "2G"}) {
    const std::string city = path(std::string("city") + memory) + "/";
    std::vector<std::string> command = {"build", wide, "-o", city, "--memory", memory};
    command.insert(command.end(), rays.begin(), rays.end());
    EXPECT_EQ(vdbmap(command).exit_code, 0);
    expect_same_rays(load_seen_map_or_city(city), load_seen_map_or_city(path("one.vdb")));
    EXPECT_EQ(json_of({"info", city})["visibility"], true);
    EXPECT_EQ(json_of({"log", city})[0]["date"], "2023-03-02");
    EXPECT_EQ(vdbmap({"check", city}).exit_code, 0);
  }
}

TEST_F(SurveyRaysCommand, AddToThoseOfTheCity) {
  const std::string city = path("city/");
  const std::string way = wide_trajectory();
  EXPECT_EQ(vdbmap({"build", wide_survey("a.las", 0), "--trajectory", way, "-o", city}).exit_code, 0);
  const LoadedMap before = load_seen_map_or_city(city);
  EXPECT_EQ(vdbmap({"build", wide_survey("b.las", 2), "--trajectory", way, "--into", city}).exit_code, 0);
  const LoadedMap after = load_seen_map_or_city(city);
  const VoxelLevel& level = after.map.finest();
  for (std::size_t i = 0; i < level.size(); ++i) ASSERT_EQ(after.visibility->hits[i], level.records()[i].count);
  // What was seen empty is still, or now occupied; the wall of the second survey hides nothing that was seen.
  const SightFinder sight(level, *after.visibility);
  for (const VoxelLeaf& leaf : before.visibility->seen_empty.leaves()) {
    for (auto it = leaf.getValueMask().beginOn(); it; ++it) {
      ASSERT_NE(sight.find(leaf.offsetToGlobalCoord(it.pos())), Sight::kNeverSeen);
    }
  }
  EXPECT_GT(after.visibility->seen_empty.num_voxels(), before.visibility->seen_empty.num_voxels());
  // The second survey's rays went through the first one's wall, which is nearer.
  std::uint64_t num_passes = 0;
  for (const std::uint32_t passes : after.visibility->passes) num_passes += passes;
  EXPECT_GT(num_passes, 100U);
  // Points without rays leave what is known of others.
  EXPECT_EQ(vdbmap({"build", survey(false, 0), "--into", city}).exit_code, 0);
  const LoadedMap last = load_seen_map_or_city(city);
  EXPECT_EQ(std::accumulate(last.visibility->passes.begin(), last.visibility->passes.end(), std::uint64_t{0}),
            num_passes);
  EXPECT_EQ(vdbmap({"check", city}).exit_code, 0);
}

TEST_F(SurveyRaysCommand, OfScansAreForMapsInOneFile) {
  write_trajectory(path("poses.txt"), read_trajectory(trajectory()), TrajectoryFormat::kKitti);
  expect_error(vdbmap({"build", survey(false, 0), "--poses", path("poses.txt"), "--visibility", "-o", path("city/")}),
               ExitCode::kWrongUsage, "--visibility is for maps in one file");
}

TEST_F(SurveyRaysCommand, ADateNeedsNone) {
  EXPECT_EQ(vdbmap({"build", survey(false, 0), "--date", "2023-03-02", "-o", path("a.vdb")}).exit_code, 0);
  EXPECT_EQ(json_of({"log", path("a.vdb")})[0]["date"], "2023-03-02");
  EXPECT_EQ(vdbmap({"build", survey(false, 0), "--date", "2023-03-02", "-o", path("city/")}).exit_code, 0);
  EXPECT_EQ(json_of({"log", path("city/")})[0]["date"], "2023-03-02");
  EXPECT_EQ(json_of({"info", path("city/")})["visibility"], false);
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

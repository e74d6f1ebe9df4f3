// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/city_folders.h"
#include "tests/support/raw_files.h"
#include "tests/support/sample_maps.h"
#include "tests/tools/map_command.h"
#include "vdbmap/core/map_merge.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/io/poses/trajectory_file.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/store/city_lock.h"
#include "vdbmap/store/city_window.h"

namespace vdbmap::cli {
namespace {

using nlohmann::json;
using test::CommandResult;

// Two surveys: a in the tiles 0_0 and 1_0, b beside it in 1_0 and 2_0; anchored at the origin.
class CityCommandTest : public MapCommand {
 protected:
  std::string a() const { return ply("a.ply", moved(scan(1), {60, 32, 3})); }
  std::string b() const { return ply("b.ply", moved(scan(2), {124, 30, 3})); }

  void build_city_of_a(const std::vector<std::string>& options = {}) const {
    std::vector<std::string> arguments = {"--anchor", "0,0,0"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    build({a()}, "city/", arguments);
  }

  std::string city() const { return path("city"); }
};

using CityCommand = CityCommandTest;

TEST_F(CityCommand, AFolderHoldsTheMapOfTheFile) {
  build_city_of_a();
  build({a()}, "a.vdb", {"--anchor", "0,0,0"});
  EXPECT_EQ(test::difference(load_map_or_city(city()), load_map(path("a.vdb"))), "");
  EXPECT_EQ(vdbmap({"export", city(), path("back.vdb")}).exit_code, 0);
  expect_same_bytes("back.vdb", "a.vdb");
  EXPECT_EQ(vdbmap({"export", path("a.vdb"), path("again/")}).exit_code, 0);
  EXPECT_EQ(test::difference(load_map_or_city(path("again")), load_map(path("a.vdb"))), "");
}

TEST_F(CityCommand, InfoTellsOfItWhatItTellsOfTheFile) {
  build_city_of_a({"--epsg", "25832"});
  build({a()}, "a.vdb", {"--anchor", "0,0,0", "--epsg", "25832"});
  const json of_city = json_of({"info", city() + "/"});
  const json of_file = json_of({"info", path("a.vdb")});
  for (const char* key : {"points", "levels", "extent", "anchor", "epsg", "attributes", "has_color"}) {
    EXPECT_EQ(of_city[key], of_file[key]) << key;
  }
  EXPECT_EQ(of_city["tiles"], 2);
  EXPECT_NE(vdbmap({"info", city()}).out.find("a city of vdbmap\npoints     5000\n"), std::string::npos);
}

TEST_F(CityCommand, QueriesOfItAreThoseOfTheFile) {
  build_city_of_a();
  build({a()}, "a.vdb", {"--anchor", "0,0,0"});
  const json voxels = json_of({"query", path("a.vdb"), "--box", "63.5,32,0,64.5,33,9"});
  ASSERT_GT(voxels.size(), 5U);
  EXPECT_EQ(json_of({"query", city(), "--box", "63.5,32,0,64.5,33,9"}), voxels);
  for (std::size_t i = 0; i < voxels.size(); i += voxels.size() / 4) {
    const std::string id = voxels[i]["id"];
    EXPECT_EQ(json_of({"query", city(), "--id", id}), json_of({"query", path("a.vdb"), "--id", id}));
  }
  const std::string at = "60.05,32.05,1.28";
  for (const std::string level : {"0.1", "1"}) {
    const CommandResult of_file = vdbmap({"query", path("a.vdb"), "--at", at, "--level", level});
    const CommandResult of_city = vdbmap({"query", city(), "--at", at, "--level", level});
    EXPECT_EQ(of_city.out, of_file.out);
    EXPECT_EQ(of_city.exit_code, of_file.exit_code);
  }
  EXPECT_EQ(vdbmap({"query", city(), "--at", "5000,5000,0"}).exit_code, 1);
  EXPECT_EQ(vdbmap({"query", city(), "--at", "1e8,5000,0"}).exit_code, 1);
}

TEST_F(CityCommand, WhatIsAddedIsMerged) {
  build_city_of_a({"--epoch", "1"});
  const json added = json_of({"build", b(), "--into", city() + "/", "--epoch", "2"});
  EXPECT_EQ(added["points"], 10'000);
  EXPECT_EQ(added["added_sources"], 1);
  build({a()}, "a.vdb", {"--anchor", "0,0,0", "--epoch", "1"});
  build({b()}, "b.vdb", {"--anchor", "0,0,0", "--epoch", "2"});
  EXPECT_EQ(test::difference(load_map_or_city(city()), merge_maps(load_map(path("a.vdb")), load_map(path("b.vdb")))),
            "");
  EXPECT_EQ(test::difference(load_map_or_city(city() + "@1"), load_map(path("a.vdb"))), "");
  EXPECT_EQ(json_of({"info", city() + "@1"})["points"], 5000);
}

TEST_F(CityCommand, ASourceThatIsCountedIsSkippedAndSaid) {
  build_city_of_a({"--epoch", "1"});
  const auto before = test::files_of_city(city());
  const CommandResult again = vdbmap({"build", a(), "--into", city(), "--epoch", "1"});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(again.err, "vdbmap: a.ply: counted already, left out\n");
  EXPECT_TRUE(test::files_of_city(city()) == before);
}

TEST_F(CityCommand, WithPartsSourcesAreReplacedAndTakenOutExactly) {
  const std::vector<std::string> options = {"--anchor", "0,0,0", "--epoch", "1", "--keep-parts"};
  build({a()}, "city/", options);
  json_of({"build", b(), "--into", city()});
  build({a(), b()}, "both/", options);
  EXPECT_TRUE(test::files_of_city(city()) == test::files_of_city(path("both")));

  const std::string c = ply("c.ply", moved(scan(3), {126, 30, 3}));
  const json replaced = json_of({"build", "--into", city(), "--replace", "b.ply=" + c});
  EXPECT_EQ(replaced["removed_sources"], json::array({"b.ply"}));
  EXPECT_EQ(replaced["added_sources"], 1);
  EXPECT_TRUE(replaced["keeps_parts"]);
  build({a(), c}, "other/", options);
  EXPECT_TRUE(test::files_of_city(city()) == test::files_of_city(path("other")));

  const CommandResult removed = vdbmap({"build", "--into", city(), "--remove", "a.ply"});
  EXPECT_EQ(removed.exit_code, 0) << removed.err;
  EXPECT_NE(removed.out.find("city: 1 sources removed, 0 added in "), std::string::npos) << removed.out;
  build({c}, "left/", options);
  EXPECT_TRUE(test::files_of_city(city()) == test::files_of_city(path("left")));
  EXPECT_NE(vdbmap({"info", city()}).out.find("parts      kept of each source, "), std::string::npos);
  EXPECT_EQ(vdbmap({"check", city()}).out, "passed  2 tiles and 1 parts of 1 epochs\n");

  const CommandResult again = vdbmap({"build", "--into", city(), "--remove", "a.ply"});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(again.err, "vdbmap: a.ply: is no source of the city, so not removed\n");
  EXPECT_TRUE(test::files_of_city(city()) == test::files_of_city(path("left")));

  const std::filesystem::path part = *std::filesystem::directory_iterator(path("city/parts"));
  std::filesystem::resize_file(part, 50);
  expect_error(vdbmap({"build", a(), "--into", city()}), ExitCode::kBadInput,
               part.filename().string() + ": is no part");
  EXPECT_NE(vdbmap({"check", city()}).out.find("FAILED  " + part.string() + ": is no part"), std::string::npos);
}

TEST_F(CityCommand, WhatNeedsPartsSaysSo) {
  build_city_of_a();
  expect_error(
      vdbmap({"build", "--into", city(), "--remove", "a.ply"}), ExitCode::kWrongUsage,
      "city: does not keep the sums of its sources, so none can be taken out: build it anew with --keep-parts");
  expect_error(vdbmap({"build", "--into", city(), "--replace", "a.ply=" + b()}), ExitCode::kWrongUsage,
               "so none can be taken out");
  expect_error(vdbmap({"build", b(), "--into", city(), "--keep-parts"}), ExitCode::kWrongUsage,
               "so those of new ones are of no use: build it anew");
  expect_error(vdbmap({"build", "--into", city(), "--replace", "a.ply"}), ExitCode::kWrongUsage,
               "--replace is a.ply, expected SOURCE=FILE");
  expect_error(vdbmap({"build", "--into", city()}), ExitCode::kWrongUsage, "INPUTS is required");
  expect_error(vdbmap({"build", a(), "-o", path("x/"), "--remove", "a.ply"}), ExitCode::kWrongUsage,
               "--remove requires --into");
  expect_error(vdbmap({"build", a(), "-o", path("x.vdb"), "--keep-parts"}), ExitCode::kWrongUsage,
               "--keep-parts is for a city: -o FOLDER/");
}

TEST_F(CityCommand, TheLogListsTheEpochs) {
  build_city_of_a({"--epoch", "1"});
  json_of({"build", b(), "--into", city(), "--epoch", "4"});
  const json log = json_of({"log", city()});
  ASSERT_EQ(log.size(), 2U);
  EXPECT_EQ(log[0]["epoch"], 1);
  EXPECT_EQ(log[0]["new_tiles"], 2);
  EXPECT_EQ(log[1]["epoch"], 4);
  EXPECT_EQ(log[1]["tiles"], 3);
  EXPECT_EQ(log[1]["new_tiles"], 2);  // 0_0 is out of reach
  EXPECT_EQ(log[1]["new_sources"][0]["name"], "b.ply");
  EXPECT_NE(vdbmap({"log", city()}).out.find("epoch 4: 10000 points, "), std::string::npos);

  json_of({"build", ply("c.ply", moved(scan(3), {60, 30, 3})), "--into", city(), "--epoch", "5", "--keep-epochs", "1"});
  EXPECT_EQ(json_of({"log", city()}).size(), 1U);
  expect_error(vdbmap({"info", city() + "@4"}), ExitCode::kBadInput, "city: keeps no epoch 4, its latest is 5");
}

TEST_F(CityCommand, CheckListsAllThatIsWrong) {
  build_city_of_a();
  json_of({"build", b(), "--into", city(), "--epoch", "2"});
  EXPECT_EQ(vdbmap({"check", city()}).out, "passed  5 tiles of 2 epochs\n");
  std::vector<std::filesystem::path> tiles;
  for (const auto& entry : std::filesystem::directory_iterator(path("city/tiles"))) tiles.push_back(entry.path());
  std::filesystem::remove(tiles[0]);
  std::filesystem::resize_file(tiles[1], 100);
  std::filesystem::copy_file(tiles[3], tiles[2], std::filesystem::copy_options::overwrite_existing);
  const CommandResult result = vdbmap({"check", city()});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.out.find(tiles[0].string() + ": is missing\n"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("FAILED  " + tiles[1].string()), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(tiles[2].string() + ": is not the tile that its name says"), std::string::npos);
  EXPECT_EQ(num_lines(result.out), 4U) << result.out;
  const json checked = json::parse(vdbmap({"check", city(), "--json"}).out);
  EXPECT_EQ(checked["problems"].size(), 3U);
}

TEST_F(CityCommand, ABoxOfItBecomesPoints) {
  build_city_of_a();
  const std::string box = "62,30,0,66,34,9";
  EXPECT_EQ(vdbmap({"export", city(), path("part.ply"), "--box", box}).exit_code, 0);
  EXPECT_EQ(vdbmap({"export", city(), path("all.ply")}).exit_code, 0);
  const PointCloud part = read_points(path("part.ply")).cloud;
  std::vector<Eigen::Vector3d> expected;
  for (const Eigen::Vector3d& point : read_points(path("all.ply")).cloud.positions) {
    if (point.x() >= 62 && point.x() <= 66 && point.y() >= 30 && point.y() <= 34 && point.z() >= 0 && point.z() <= 9) {
      expected.push_back(point);
    }
  }
  EXPECT_GT(expected.size(), 20U);
  EXPECT_EQ(part.positions, expected);
  expect_error(vdbmap({"export", city(), path("none.ply"), "--box", "0,0,50,9,9,60"}), ExitCode::kWrongUsage,
               "no voxel of the level has its mean in the box");
}

TEST_F(CityCommand, MergesWithMapsInOneFile) {
  build_city_of_a();
  build({b()}, "b.vdb", {"--anchor", "0,0,0"});
  EXPECT_EQ(vdbmap({"merge", city(), path("b.vdb"), "-o", path("both/")}).exit_code, 0);
  EXPECT_EQ(
      test::difference(load_map_or_city(path("both")), merge_maps(load_map_or_city(city()), load_map(path("b.vdb")))),
      "");
  expect_error(vdbmap({"merge", city(), city(), "-o", path("twice/")}), ExitCode::kBadInput, "has counted a.ply");
}

TEST_F(CityCommand, IsDrawnAsTheFileIs) {
  build_city_of_a();
  build({a()}, "a.vdb", {"--anchor", "0,0,0"});
  for (const std::string map : {"city", "a.vdb"}) {
    EXPECT_EQ(vdbmap({"render", path(map), "-o", path(map + ".png"), "--view", "plan", "--size", "200x100"}).exit_code,
              0);
  }
  expect_same_bytes("city.png", "a.vdb.png");
}

TEST_F(CityCommand, ScansAreFoundInItAsInTheFile) {
  const std::string folder = scans(2);
  build({folder}, "a.vdb", {"--poses", path("poses.txt"), "--anchor", "0,0,0"});
  build({folder}, "city/", {"--poses", path("poses.txt"), "--anchor", "0,0,0"});
  for (const std::string map : {"a.vdb", "city"}) {
    EXPECT_EQ(
        vdbmap({"localize", path(map), folder, "--initial", path("poses.txt"), "-o", path(map + ".txt")}).exit_code, 0);
  }
  expect_same_bytes("city.txt", "a.vdb.txt");
  const auto find = [&](const std::string& map) {
    return vdbmap({"localize", path(map), folder, "-o", path(map + ".found.txt")}).exit_code;
  };
  EXPECT_EQ(find("city"), find("a.vdb"));
  expect_same_bytes("city.found.txt", "a.vdb.found.txt");
  EXPECT_TRUE(std::filesystem::exists(path("city/cache")));
  EXPECT_EQ(vdbmap({"check", city()}).exit_code, 0);
  expect_error(vdbmap({"localize", city(), folder, "--near", "5000,5000,50", "-o", path("none.txt")}),
               ExitCode::kBadInput, "has no voxels where the scans are looked for");
  expect_error(vdbmap({"localize", path("a.vdb"), folder, "--near", "0,0,50", "-o", path("none.txt")}),
               ExitCode::kWrongUsage, "--near needs a city");
}

TEST_F(CityCommand, WhatIsNoCityIsRefusedWithOneLine) {
  std::filesystem::create_directory(city());
  for (const char* command : {"info", "check", "log"}) {
    expect_error(vdbmap({command, city()}), ExitCode::kBadInput, "city: is no city: it has no map.json");
  }
  expect_error(vdbmap({"build", a(), "--into", city()}), ExitCode::kBadInput, "is no city");
  expect_error(vdbmap({"build", a(), "--into", path("none")}), ExitCode::kInputOutputFailed, "none: cannot open");
  test::write_raw(path("city/letter.txt"), "x");
  expect_error(vdbmap({"build", a(), "-o", city()}), ExitCode::kBadInput, "is no city: it holds 'letter.txt'");
  expect_error(vdbmap({"build", a()}), ExitCode::kWrongUsage, "--output or --into is required");
}

TEST_F(CityCommand, ASecondWriterIsToldWhoTheFirstIs) {
  build_city_of_a();
  const CityLock lock(city());
  expect_error(vdbmap({"build", b(), "--into", city()}), ExitCode::kInputOutputFailed,
               "city: process " + std::to_string(::getpid()));
  EXPECT_EQ(vdbmap({"info", city()}).exit_code, 0);
}

TEST_F(CityCommand, DamagedAndNewerManifestsAreRefused) {
  build_city_of_a();
  const std::string manifest = test::read_raw(path("city/map.json"));
  test::write_raw(path("city/map.json"), manifest.substr(0, manifest.size() / 2));
  expect_error(vdbmap({"info", city()}), ExitCode::kBadInput, "map.json: is damaged");
  expect_error(vdbmap({"build", b(), "--into", city()}), ExitCode::kBadInput, "map.json: is damaged");
  std::string newer = manifest;
  newer.replace(newer.find("\"version\": 1"), 12, "\"version\": 9");
  test::write_raw(path("city/map.json"), newer);
  expect_error(vdbmap({"query", city(), "--at", "1,1,1"}), ExitCode::kBadInput, "version is 9, newer than the 2");
}

TEST_F(CityCommand, ACityThatCannotBeWrittenCanBeRead) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  build_city_of_a();
  ::chmod(city().c_str(), 0555);
  EXPECT_EQ(vdbmap({"info", city()}).exit_code, 0);
  expect_error(vdbmap({"build", b(), "--into", city()}), ExitCode::kInputOutputFailed, "cannot");
  ::chmod(city().c_str(), 0755);
}

// The command with a fault at the n-th call; see tests/fault.
CommandResult with_fault(const std::string& fault, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"LD_PRELOAD=" VDBMAP_FAULT, fault, VDBMAP_COMMAND});
  return test::run_command("/usr/bin/env", arguments);
}

using Files = std::map<std::string, std::string>;

class CityFaultTest : public CityCommandTest {
 protected:
  void SetUp() override {
    build_city_of_a({"--epoch", "1"});
    before_ = test::files_of_city(city());
    std::filesystem::copy(city(), path("kept"), std::filesystem::copy_options::recursive);
    EXPECT_EQ(vdbmap(add()).exit_code, 0);
    after_ = test::files_of_city(city());
  }

  std::vector<std::string> add() const {
    return {"build", b(), "--into", city(), "--epoch", "2", "--memory", "1M", "--threads", "1"};
  }

  void restore() const {
    std::filesystem::remove_all(city());
    std::filesystem::copy(path("kept"), city(), std::filesystem::copy_options::recursive);
  }

  // Whatever happened, a reader sees one of the two states.
  bool is_readable() const {
    const std::size_t points = num_points(load_map_or_city(city()).finest());
    return points == 5000 || points == 10'000;
  }

  Files before_;
  Files after_;
};

using CityFault = CityFaultTest;

TEST_F(CityFault, KilledAtAnyCallTheSameCommandGivesTheSameBytes) {
  int num_kills = 0;
  for (int n = 1; n < 2000; ++n) {
    restore();
    const CommandResult killed = with_fault("VDBMAP_KILL_AT=" + std::to_string(n), add());
    if (killed.signal == 0) break;
    ++num_kills;
    ASSERT_TRUE(is_readable()) << n;
    const CommandResult again = vdbmap(add());
    ASSERT_EQ(again.exit_code, 0) << n << again.err;
    ASSERT_TRUE(test::files_of_city(city()) == after_) << n;  // _EQ would print all bytes
  }
  EXPECT_GT(num_kills, 20);
}

TEST_F(CityFault, ANewCityToo) {
  const std::vector<std::string> command = {"build", a(), "-o", path("new/"), "--memory", "1M", "--threads", "1"};
  EXPECT_EQ(vdbmap(command).exit_code, 0);
  const Files expected = test::files_of_city(path("new"));
  int num_kills = 0;
  for (int n = 1; n < 2000; ++n) {
    std::filesystem::remove_all(path("new"));
    if (with_fault("VDBMAP_KILL_AT=" + std::to_string(n), command).signal == 0) break;
    ++num_kills;
    const CommandResult again = vdbmap(command);
    ASSERT_EQ(again.exit_code, 0) << n << again.err;
    ASSERT_TRUE(test::files_of_city(path("new")) == expected) << n;
  }
  EXPECT_GT(num_kills, 15);
}

// A city that keeps parts, of one tile, in which a source is replaced.
TEST_F(CityFault, AReplacedSourceToo) {
  const auto small = [&](const std::string& name, unsigned seed) {
    return ply(name, moved(scan(seed, 200), {30, 30, 3}));
  };
  build({small("s.ply", 1), small("t.ply", 2)}, "small/", {"--anchor", "0,0,0", "--epoch", "1", "--keep-parts"});
  const std::filesystem::path city = path("small");
  const Files before = test::files_of_city(city);
  std::filesystem::copy(city, path("small_before"), std::filesystem::copy_options::recursive);
  const std::vector<std::string> command = {
      "build",    "--into", city.string(), "--replace", "s.ply=" + small("u.ply", 3), "--epoch", "2",
      "--memory", "1M",     "--threads",   "1"};
  EXPECT_EQ(vdbmap(command).exit_code, 0);
  const Files after = test::files_of_city(city);
  const auto with = [&](const char* fault, int n) {
    std::filesystem::remove_all(city);
    std::filesystem::copy(path("small_before"), city, std::filesystem::copy_options::recursive);
    return with_fault(fault + std::to_string(n), command);
  };
  int num_kills = 0;
  while (num_kills < 2000 && with("VDBMAP_KILL_AT=", num_kills + 1).signal != 0) {
    ++num_kills;
    ASSERT_EQ(num_points(load_map_or_city(city).finest()), 400U) << num_kills;
    const CommandResult again = vdbmap(command);
    ASSERT_EQ(again.exit_code, 0) << num_kills << again.err;
    ASSERT_TRUE(test::files_of_city(city) == after) << num_kills;
  }
  EXPECT_GT(num_kills, 20);
  int num_failures = 0;
  while (num_failures < 2000 && with("VDBMAP_FULL_AT=", num_failures + 1).exit_code == 4) {
    ++num_failures;
    ASSERT_TRUE(test::files_of_city(city) == before) << num_failures;
  }
  EXPECT_TRUE(test::files_of_city(city) == after);
  EXPECT_GT(num_failures, 3);
}

// Two scans from the middle of what the city shows.
class DriveFaultTest : public CityFaultTest {
 protected:
  void SetUp() override {
    build_city_of_a({"--epoch", "1"});
    std::filesystem::copy(city(), path("kept"), std::filesystem::copy_options::recursive);
    before_ = test::files_of_city(city());
    scans(2);
    Trajectory poses = read_trajectory(path("poses.txt"));
    for (auto& pose : poses.map_from_scan) pose->translation() = Eigen::Vector3d(60, 32, 3);
    write_trajectory(path("poses.txt"), poses, TrajectoryFormat::kKitti);
    const CommandResult updated = vdbmap(update());
    EXPECT_EQ(updated.exit_code, 0) << updated.err;
    after_ = test::files_of_city(city());
  }

  std::vector<std::string> update() const {
    return {"update",       "--into", city(),    path("scans"), "--poses",   path("poses.txt"),
            "--pose-frame", "lidar",  "--epoch", "2",           "--threads", "1"};
  }
};

using DriveFault = DriveFaultTest;

TEST_F(DriveFault, KilledAtAnyCallTheSameCommandGivesTheSameBytes) {
  int num_kills = 0;
  constexpr int kStep = 17;  // all calls would take minutes
  for (int n = 1; n < 5000; n += kStep) {
    restore();
    const CommandResult killed = with_fault("VDBMAP_KILL_AT=" + std::to_string(n), update());
    if (killed.signal == 0) break;
    ++num_kills;
    const std::string manifest = test::read_raw(path("city/map.json"));
    ASSERT_TRUE(manifest == before_["map.json"] || manifest == after_["map.json"]) << n;
    const CommandResult again = vdbmap(update());
    if (manifest == after_["map.json"]) {  // all was done: the scans are counted
      ASSERT_EQ(again.exit_code, 2) << n << again.err;
    } else {
      ASSERT_EQ(again.exit_code, 0) << n << again.err;
      ASSERT_TRUE(test::files_of_city(city()) == after_) << n;
    }
  }
  EXPECT_GT(num_kills, 5);
}

TEST_F(CityFault, AFullDiskLeavesTheCityAsItWas) {
  int num_failures = 0;
  for (int n = 1; n < 2000; ++n) {
    restore();
    const CommandResult failed = with_fault("VDBMAP_FULL_AT=" + std::to_string(n), add());
    if (failed.exit_code == 0) break;
    ++num_failures;
    ASSERT_EQ(failed.exit_code, 4) << n << failed.err;
    ASSERT_EQ(num_lines(failed.err), 1U) << n << failed.err;
    ASSERT_TRUE(test::files_of_city(city()) == before_) << n;
  }
  EXPECT_GT(num_failures, 3);
}

}  // namespace
}  // namespace vdbmap::cli

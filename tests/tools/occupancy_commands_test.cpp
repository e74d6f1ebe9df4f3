// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/labelled_street.h"
#include "tests/support/picture.h"
#include "tests/support/raw_files.h"
#include "tests/support/sample_maps.h"
#include "tests/support/synthetic_scene.h"
#include "tests/tools/map_command.h"
#include "vdbmap/io/poses/trajectory_file.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/store/city_folder.h"

namespace vdbmap::cli {
namespace {

using parking::SurfaceClass;
using test::CommandResult;

constexpr int kUtm32 = 25832;

// Cars in the first and third of three places along x, 6 m from each other; nothing was there before in the second.
test::LabelledStreet first_epoch() {
  test::LabelledStreet street;
  street.add_body({0, 0}, 0);
  street.add_body({12, 0}, 0);
  street.add_patch({-12, -10, 0}, {36, 16}, SurfaceClass::kGround);
  return street;
}

// The first car is still there, the second place is free, walls hide the third, from which the car is gone.
test::Scene second_epoch() {
  test::Scene scene = test::box({-2.2, -0.9, 0.2}, {2.2, 0.9, 1.4});
  scene.push_back({{-30, -20, 0}, {80, 0, 0}, {0, 40, 0}});
  scene.push_back({{9.2, -1.4, 0}, {7, 0, 0}, {0, 0, 3}});
  scene.push_back({{9.2, -1.4, 0}, {0, 6, 0}, {0, 0, 3}});
  return scene;
}

std::string feature(int id, double x, double y, double length = 5.4) {
  nlohmann::json ring = nlohmann::json::array();
  const Eigen::Vector2d half(length / 2, 1);
  for (const auto& [side_x, side_y] :
       {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1), std::pair(-1, -1)}) {
    ring.push_back({test::kUtm.x() + x + side_x * half.x(), test::kUtm.y() + y + side_y * half.y()});
  }
  return nlohmann::json({{"type", "Feature"},
                         {"properties", {{"id", id}, {"kerb_side", "N"}}},
                         {"geometry", {{"type", "Polygon"}, {"coordinates", nlohmann::json::array({ring})}}}})
      .dump();
}

std::string collection(const std::string& features, int epsg = kUtm32) {
  return R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::)" +
         std::to_string(epsg) + R"("}},"features":[)" + features + "]}";
}

class OccupancyCommands : public MapCommand {
 protected:
  OccupancyCommands() {
    save_map(labelled(), first_epoch().map_at(test::kUtm, kUtm32));
    write("city.geojson", collection(feature(1, 0, 0) + "," + feature(2, 6, 0) + "," + feature(3, 12, 0)));
    write_drive({0, 0});
  }

  std::string labelled() const { return path("labelled.vdb"); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
    return path(name);
  }

  // Scans of the second epoch along the row, 6 m beside it; their points and poses moved by `offset`.
  void write_drive(const Eigen::Vector2d& offset) const {
    std::filesystem::create_directories(path("scans"));
    Trajectory poses;
    for (const double x : {-4.0, 2.0, 6.0, 9.0}) {
      Eigen::Isometry3d map_from_scan = Eigen::Isometry3d::Identity();
      map_from_scan.translation() = Eigen::Vector3d(x, -6, 1.8);
      ply("scans/" + std::to_string(poses.size()) + ".ply", test::scan_scene(second_epoch(), map_from_scan));
      map_from_scan.translation() += test::kUtm + Eigen::Vector3d(offset.x(), offset.y(), 0);
      poses.map_from_scan.emplace_back(map_from_scan);
    }
    write_trajectory(path("poses.txt"), poses, TrajectoryFormat::kKitti);
  }

  std::vector<std::string> occupancy(const std::string& spaces, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"occupancy", labelled(),        path(spaces), path("scans"),
                                          "--poses",   path("poses.txt"), "-o",         path("occupancy.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  // States by the ids of the spaces.
  std::map<std::string, std::string> states() const {
    const auto document = nlohmann::json::parse(test::read_raw(path("occupancy.json")));
    std::map<std::string, std::string> states;
    for (const auto& space : document["spaces"]) states[space["id"]] = space["state"];
    return states;
  }
};

using States = std::map<std::string, std::string>;

TEST_F(OccupancyCommands, OfACityIsThatOfTheMapAndReadsOnlyTheTilesAroundTheSpaces) {
  EXPECT_EQ(vdbmap(occupancy("city.geojson")).exit_code, 0);
  auto expected = nlohmann::json::parse(test::read_raw(path("occupancy.json")));
  test::LabelledStreet street = first_epoch();
  street.add_patch({300, 300, 0}, {10, 10}, SurfaceClass::kGround);
  save_map(path("wide.vdb"), street.map_at(test::kUtm, kUtm32));
  EXPECT_EQ(vdbmap({"export", path("wide.vdb"), path("labelled/")}).exit_code, 0);
  const CityManifest manifest = open_city(path("labelled")).manifest;
  const auto far = std::ranges::max_element(manifest.tiles, {}, &CityTile::id);
  test::write_raw(tile_path(path("labelled"), *far), "not read");
  std::vector<std::string> command = occupancy("city.geojson");
  command[1] = path("labelled/");
  const CommandResult result = vdbmap(command);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  auto found = nlohmann::json::parse(test::read_raw(path("occupancy.json")));
  EXPECT_EQ(found["spaces"], expected["spaces"]);
  // The city is a later epoch too: of a map.
  const auto by_map = [&](const std::string& later) {
    const CommandResult seen = vdbmap({"occupancy", labelled(), path("city.geojson"), later, "-o", path("later.json")});
    EXPECT_NE(seen.out.find("3 spaces"), std::string::npos) << seen.out << seen.err;
    return nlohmann::json::parse(test::read_raw(path("later.json")))["spaces"];
  };
  EXPECT_EQ(by_map(path("labelled/")), by_map(labelled()));
}

TEST_F(OccupancyCommands, SpacesOfACityAreThoseOfTheMap) {
  EXPECT_EQ(vdbmap({"export", labelled(), path("labelled/")}).exit_code, 0);
  EXPECT_EQ(vdbmap({"spaces", labelled(), "-o", path("a.geojson")}).exit_code, 0);
  EXPECT_EQ(vdbmap({"spaces", path("labelled/"), "-o", path("b.geojson")}).exit_code, 0);
  expect_same_bytes("a.geojson", "b.geojson");
}

TEST_F(OccupancyCommands, SpacesAreMadeOfVehiclesAndKeepTheirIds) {
  const nlohmann::json made = json_of({"spaces", labelled(), "-o", path("a.geojson"), "--date", "2023-03-01"});
  EXPECT_EQ(made["vehicles"], 2);
  EXPECT_EQ(made["spaces"], 2);
  EXPECT_EQ(made["candidates"], 1);
  const nlohmann::json again =
      json_of({"spaces", labelled(), "-o", path("b.geojson"), "--merge", path("a.geojson"), "--map-coordinates"});
  EXPECT_EQ(again["new"], 0);
  EXPECT_EQ(again["seen_again"], 2);
  const auto a = nlohmann::json::parse(test::read_raw(path("a.geojson"))),
             b = nlohmann::json::parse(test::read_raw(path("b.geojson")));
  ASSERT_EQ(a["features"].size(), b["features"].size());
  EXPECT_FALSE(a.contains("crs"));
  EXPECT_EQ(b["crs"]["properties"]["name"], "urn:ogc:def:crs:EPSG::25832");
  for (std::size_t i = 0; i < a["features"].size(); ++i) {
    EXPECT_EQ(a["features"][i]["properties"]["id"], b["features"][i]["properties"]["id"]);
  }
}

TEST_F(OccupancyCommands, TellOccupiedVacantAndHiddenSpacesApart) {
  const test::CommandResult result = vdbmap(occupancy("city.geojson"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(states(), (States{{"1", "occupied"}, {"2", "vacant"}, {"3", "unknown"}}));
  EXPECT_NE(result.out.find("3 spaces: 1 occupied, 1 vacant, 1 unknown"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("occupancy  33 % to 67 %, 50 %"), std::string::npos) << result.out;
  EXPECT_EQ(vdbmap(occupancy("city.geojson", {"--as-paper"})).exit_code, 0);
  EXPECT_EQ(states()["3"], "vacant");
}

TEST_F(OccupancyCommands, WriteAllDocumentsAlikeForAnyNumberOfThreads) {
  const auto files = [&](const std::string& name) {
    return std::vector<std::string>{"--date",    "2023-03-02",
                                    "--geojson", path(name + ".geojson"),
                                    "--csv",     path(name + ".csv"),
                                    "--cds",     path(name + "_cds.json"),
                                    "--fiware",  path(name + "_fiware.json"),
                                    "--report",  path(name + ".png"),
                                    "--city",    "Hannover"};
  };
  std::vector<std::string> one = files("a"), three = files("b");
  one.insert(one.end(), {"--threads", "1"});
  three.insert(three.end(), {"--threads", "3"});
  ASSERT_EQ(vdbmap(occupancy("city.geojson", one)).exit_code, 0);
  const std::string bytes = test::read_raw(path("occupancy.json"));
  ASSERT_EQ(vdbmap(occupancy("city.geojson", three)).exit_code, 0);
  EXPECT_EQ(test::read_raw(path("occupancy.json")), bytes);
  for (const std::string end : {".geojson", ".csv", "_cds.json", "_fiware.json", ".png", "_2.png", "_3.png"}) {
    expect_same_bytes("a" + end, "b" + end);
  }
  EXPECT_FALSE(std::filesystem::exists(path("a_4.png")));
}

TEST_F(OccupancyCommands, TheNextEpochStartsFromTheLast) {
  ASSERT_EQ(vdbmap(occupancy("city.geojson", {"--geojson", path("now.geojson"), "--date", "2023-03-02"})).exit_code, 0);
  ASSERT_EQ(vdbmap(occupancy("now.geojson", {"--date", "2023-03-05"})).exit_code, 0);
  const auto document = nlohmann::json::parse(test::read_raw(path("occupancy.json")));
  EXPECT_EQ(document["spaces"][1]["previous_state"], "vacant");
  EXPECT_EQ(document["spaces"][1]["days_in_state"], 3);
  EXPECT_EQ(document["turnover"]["known_in_both"], 2);
  EXPECT_EQ(document["turnover"]["days"], 3);
}

TEST_F(OccupancyCommands, AMapWithoutRaysShowsNoSpaceVacant) {
  test::LabelledStreet later;
  later.add_body({0, 0}, 0);
  later.add_patch({-12, -10, 0}, {36, 16}, SurfaceClass::kGround);
  VoxelMap map = later.map_at(test::kUtm, kUtm32);
  save_map(path("later.vdb"), map);
  const std::vector<std::string> arguments = {"occupancy",       labelled(), path("city.geojson"),
                                              path("later.vdb"), "-o",       path("occupancy.json")};
  const test::CommandResult result = vdbmap(arguments);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("does not say what rays passed"), std::string::npos) << result.err;
  EXPECT_EQ(states(), (States{{"1", "occupied"}, {"2", "unknown"}, {"3", "unknown"}}));

  std::vector<VoxelIndex> empty;
  for (std::int32_t x = 30; x < 90; ++x) {
    for (std::int32_t y = -12; y < 12; ++y) {
      for (std::int32_t z = 3; z < 16; ++z) empty.emplace_back(x, y, z);
    }
  }
  const VoxelMap seen = test::map_of_voxels(empty);
  Visibility visibility;
  visibility.voxel_size = 0.1;
  visibility.seen_empty = seen.finest().tree();
  visibility.hits.resize(map.finest().size(), 1);
  visibility.passes.resize(map.finest().size());
  save_map(path("later.vdb"), map, MapExtras{std::move(visibility), {}});
  EXPECT_EQ(vdbmap(arguments).exit_code, 0);
  EXPECT_EQ(states(), (States{{"1", "occupied"}, {"2", "vacant"}, {"3", "unknown"}}));
}

TEST_F(OccupancyCommands, ScansThatNeverComeNearSayNothing) {
  write_drive({0, 400});
  const test::CommandResult result = vdbmap(occupancy("city.geojson"));
  EXPECT_EQ(result.exit_code, static_cast<int>(ExitCode::kNo));
  EXPECT_NE(result.err.find("comes near none of the spaces"), std::string::npos) << result.err;
  EXPECT_EQ(states(), (States{{"1", "unknown"}, {"2", "unknown"}, {"3", "unknown"}}));
}

TEST_F(OccupancyCommands, WarnOfSpacesThatOverlapOrLieElsewhere) {
  write("odd.geojson", collection(feature(1, 0, 0) + "," + feature(2, 4, 0) + "," + feature(3, 300, 0)));
  const test::CommandResult result = vdbmap(occupancy("odd.geojson"));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("spaces '1' and '2' overlap by 26 %"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("1 of 3 spaces lie where the map has no ground"), std::string::npos) << result.err;
  EXPECT_EQ(states()["3"], "unknown");
}

TEST_F(OccupancyCommands, RefuseSpacesThatCannotBe) {
  const auto expect_bad = [&](const std::string& text, const std::string& part) {
    write("bad.geojson", text);
    expect_error(vdbmap(occupancy("bad.geojson")), ExitCode::kBadInput, part);
  };
  expect_bad(collection(""), "holds no spaces");
  expect_bad(collection(feature(1, 3000, 0)), "none of its 1 spaces lies on ground");
  expect_bad(collection(feature(1, 0, 0), 25833), "EPSG:25833, the map's in EPSG:25832");
  expect_bad(collection(feature(1, 0, 0) + "," + feature(1, 6, 0)), "feature 2 ('1') has the id of feature 1");
  expect_bad(
      collection(
          R"({"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[[[0,0],[4,2],[4,0],[0,2],[0,0]]]}})"),
      "feature 1 ('1') crosses itself");
  expect_bad("no json", "is no JSON");
  EXPECT_FALSE(std::filesystem::exists(path("occupancy.json")));
}

TEST_F(OccupancyCommands, SayWhatTheyCannotDo) {
  test::LabelledStreet bare;
  bare.add_patch({0, 0, 0}, {10, 10}, SurfaceClass::kGround);
  save_map(path("bare.vdb"), bare.map());
  expect_error(vdbmap({"spaces", path("bare.vdb"), "-o", path("out.geojson")}), ExitCode::kNo, "holds no vehicles");
  const std::string plain = built("plain.vdb", scan(1));
  expect_error(vdbmap({"spaces", plain, "-o", path("out.geojson")}), ExitCode::kBadInput, "plain.vdb: has no classes");
  expect_error(vdbmap({"spaces", labelled(), "-o", path("out.png")}), ExitCode::kWrongUsage, "'.png'");
  expect_error(vdbmap({"spaces", labelled(), "-o", path("out.geojson"), "--date", "soon"}), ExitCode::kWrongUsage,
               "soon");
  EXPECT_FALSE(std::filesystem::exists(path("out.geojson")));

  const std::string city = path("city.geojson");
  expect_error(vdbmap({"occupancy", labelled(), city, path("scans"), "-o", path("out.json")}), ExitCode::kWrongUsage,
               "--poses");
  expect_error(
      vdbmap({"occupancy", labelled(), city, labelled(), "--poses", path("poses.txt"), "-o", path("out.json")}),
      ExitCode::kWrongUsage, "no use for --poses");
  expect_error(vdbmap({"occupancy", labelled(), city, path("bare.vdb"), "-o", path("out.json")}), ExitCode::kBadInput,
               "another anchor or EPSG code");
  expect_error(vdbmap(occupancy("city.geojson", {"--csv", path("occupancy.json")})), ExitCode::kWrongUsage,
               "another output");
  expect_error(vdbmap(occupancy("city.geojson", {"--cds", path("cds.json")})), ExitCode::kWrongUsage, "needs the date");
  EXPECT_FALSE(std::filesystem::exists(path("out.json")));
  EXPECT_FALSE(std::filesystem::exists(path("occupancy.json")));
}

}  // namespace
}  // namespace vdbmap::cli

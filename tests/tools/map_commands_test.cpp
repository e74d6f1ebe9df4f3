// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/raw_files.h"
#include "tests/tools/map_command.h"
#include "vdbmap/io/vdb/vdb_file.h"

namespace vdbmap::cli {
namespace {

using nlohmann::json;
using test::CommandResult;
using test::read_raw;
using test::write_raw;

using Info = MapCommand;
using Query = MapCommand;
using Merge = MapCommand;

TEST_F(Info, DescribesAFileOfAnotherProgram) {
  auto grid = openvdb::FloatGrid::create();
  grid->setName("smoke");
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
  grid->tree().setValueOn({-1, 2, 3}, 1.0F);
  grid->tree().setValueOn({4, 5, 6}, 1.0F);
  grid->insertMeta("artist", openvdb::StringMetadata("somebody"));
  write_vdb(path("smoke.vdb"), {grid}, {});

  const CommandResult text = vdbmap({"info", path("smoke.vdb")});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_NE(text.out.find("not a map of vdbmap\n"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("grid 'smoke': float, fog volume\n  2 active voxels, -1 2 3 to 4 5 6\n"), std::string::npos)
      << text.out;
  const json info = json_of({"info", path("smoke.vdb")});
  EXPECT_EQ(info["is_map"], false);
  ASSERT_EQ(info["grids"].size(), 1U);
  EXPECT_EQ(info["grids"][0]["name"], "smoke");
  EXPECT_EQ(info["grids"][0]["active_voxels"], 2);
  EXPECT_EQ(info["grids"][0]["bounding_box"], json({{"min", {-1, 2, 3}}, {"max", {4, 5, 6}}}));
  EXPECT_EQ(info["grids"][0]["voxel_size"], json({0.25, 0.25, 0.25}));
  EXPECT_EQ(info["grids"][0]["metadata"]["artist"], "somebody");
}

TEST_F(Info, AGridWithoutVoxelsHasNoBox) {
  auto grid = openvdb::FloatGrid::create();
  grid->setName("nothing");
  write_vdb(path("nothing.vdb"), {grid}, {});
  EXPECT_TRUE(json_of({"info", path("nothing.vdb")})["grids"][0]["bounding_box"].is_null());
}

TEST_F(Info, FilesThatAreNoOrDamagedVdbAreBadInput) {
  const std::string map = built("map.vdb", scan(1));
  std::string bytes = read_raw(map);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  write_raw(folder_ / "damaged.vdb", bytes);
  expect_error(vdbmap({"info", path("damaged.vdb")}), ExitCode::kBadInput, "damaged.vdb: is damaged");
  expect_error(vdbmap({"info", path("map.vdb.ply")}), ExitCode::kBadInput, "is not an OpenVDB file");
  expect_error(vdbmap({"info", path("missing.vdb")}), ExitCode::kInputOutputFailed, "missing.vdb");
}

TEST_F(Query, FindsUtmCoordinatesToATenthOfAMillimetre) {
  const Eigen::Vector3d point = kUtm + Eigen::Vector3d(0.0123, 0.0456, 0.0789);
  const std::string map = built("map.vdb", points({point}));
  const std::string at = "548901.2623,5804077.5456,43.8289";
  const json voxels = json_of({"query", map, "--at", at});
  ASSERT_EQ(voxels.size(), 1U);
  EXPECT_EQ(voxels[0]["count"], 1);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(voxels[0]["mean"][axis].get<double>(), point[axis], 1e-4);

  const CommandResult text = vdbmap({"query", map, "--at", at});
  EXPECT_NE(text.out.find("mean         548901.2623 5804077.5456 43.8289 m\n"), std::string::npos) << text.out;
}

TEST_F(Query, PointIdAndBoxLeadToTheSameVoxel) {
  const std::string map = built("map.vdb", points({{-1.05, 2.05, -3.05}, {-1.04, 2.05, -3.05}, {5, 5, 5}}));
  const json at = json_of({"query", map, "--at", "-1.05,2.05,-3.05"});
  ASSERT_EQ(at.size(), 1U);
  EXPECT_EQ(at[0]["count"], 2);
  EXPECT_EQ(at[0]["index"], json({-11, 20, -31}));
  EXPECT_NEAR(at[0]["covariance_m2"][0][0].get<double>(), 0.01 * 0.01 / 2, 1e-7);
  EXPECT_TRUE(at[0]["color"].is_null());
  EXPECT_EQ(json_of({"query", map, "--id", at[0]["id"].get<std::string>()}), at);
  EXPECT_EQ(json_of({"query", map, "--box", "-1.1,2,-3.1,-1,2.1,-3.01"}).size(), 1U);
  EXPECT_EQ(json_of({"query", map, "--box", "-10,-10,-10,10,10,10"}).size(), 2U);
  const json coarse = json_of({"query", map, "--at", "-1.05,2.05,-3.05", "--level", "1"});
  EXPECT_EQ(coarse[0]["index"], json({-2, 2, -4}));
}

TEST_F(Query, NothingFoundIsANo) {
  const std::string map = built("map.vdb", points({{1, 1, 1}}));
  const CommandResult at = vdbmap({"query", map, "--at", "7,8,9"});
  EXPECT_EQ(at.exit_code, static_cast<int>(ExitCode::kNo));
  EXPECT_EQ(at.out, "no voxel of the 0.1 m level holds 7,8,9\n");
  const CommandResult as_json = vdbmap({"query", map, "--box", "7,8,9,8,9,10", "--json"});
  EXPECT_EQ(as_json.exit_code, static_cast<int>(ExitCode::kNo));
  EXPECT_EQ(json::parse(as_json.out), json::array());
  EXPECT_EQ(vdbmap({"query", map, "--id", "0000000000000000"}).exit_code, static_cast<int>(ExitCode::kNo));
}

TEST_F(Query, WrongQuestionsAreWrongUsage) {
  const std::string map = built("map.vdb", points({{1, 1, 1}}));
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"--at", "1,2"},
      {"--at", "1,2,x"},
      {"--at", "1,2,nan"},
      {"--at", "1,2,3", "--id", "0000000000000000"},
      {"--id", "12"},
      {"--id", "zzzzzzzzzzzzzzzz"},
      {"--box", "0,0,0,1,1"},
      {"--box", "1,1,1,0,0,0"},
      {"--at", "1,2,3", "--level", "0.3"},
  };
  for (const std::vector<std::string>& question : wrong) {
    SCOPED_TRACE(testing::PrintToString(question));
    std::vector<std::string> arguments = {"query", map};
    arguments.insert(arguments.end(), question.begin(), question.end());
    expect_error(vdbmap(arguments), ExitCode::kWrongUsage, "");
  }
}

TEST_F(Query, AForeignFileIsRefusedWithTheReason) {
  write_vdb(path("smoke.vdb"), {openvdb::FloatGrid::create()}, {});
  expect_error(vdbmap({"query", path("smoke.vdb"), "--at", "1,2,3"}), ExitCode::kBadInput, "not a map of vdbmap");
}

TEST_F(Merge, TheMergedMapHasAllPoints) {
  const std::string a = built("a.vdb", moved(scan(1), kUtm), {"--epsg", "25832"});
  const std::string b = built("b.vdb", moved(scan(2), kUtm), {"--anchor", "548800,5804032,64"});
  const std::string c = built("c.vdb", moved(scan(3), kUtm + Eigen::Vector3d(5, 0, 0)));
  build({a + ".ply", b + ".ply", c + ".ply"}, "all.vdb");
  const json merged = json_of({"merge", a, b, c, "-o", path("merged.vdb")});
  const json all = json_of({"info", path("all.vdb")});
  for (const char* key : {"points", "levels", "extent", "anchor", "attributes"})
    EXPECT_EQ(merged[key], all[key]) << key;
  EXPECT_EQ(merged["epsg"], 25832);
  EXPECT_EQ(json_of({"info", path("merged.vdb")})["points"], 15'000);
}

TEST_F(Merge, OneAndTwoThreadsWriteTheSameBytes) {
  const std::string a = built("a.vdb", scan(1));
  const std::string b = built("b.vdb", moved(scan(2), {3, 2, 0}), {"--anchor", "-64,0,0"});
  ASSERT_EQ(vdbmap({"merge", a, b, "-o", path("1.vdb"), "--threads", "1"}).exit_code, 0);
  ASSERT_EQ(vdbmap({"merge", a, b, "-o", path("2.vdb"), "--threads", "2"}).exit_code, 0);
  expect_same_bytes("1.vdb", "2.vdb");
}

TEST_F(Merge, MapsThatDoNotFitAreBadInput) {
  const std::string a = built("a.vdb", scan(1), {"--epsg", "25832"});
  const std::string other_system = built("b.vdb", scan(1), {"--epsg", "32632"});
  const std::string other_levels = built("c.vdb", scan(1), {"--levels", "0.2,1"});
  const std::string far = built("d.vdb", moved(scan(1), kUtm));
  const std::string out = path("merged.vdb");
  expect_error(vdbmap({"merge", a, other_system, "-o", out}), ExitCode::kBadInput, "b.vdb: maps of EPSG:25832 and");
  expect_error(vdbmap({"merge", a, other_levels, "-o", out}), ExitCode::kBadInput,
               "levels of 0.1, 1 m and of 0.2, 1 m");
  expect_error(vdbmap({"merge", a, far, "-o", out}), ExitCode::kBadInput, "d.vdb: a voxel of the map with anchor");
  expect_error(vdbmap({"merge", a, path("a.vdb.ply"), "-o", out}), ExitCode::kBadInput, "is not an OpenVDB file");
  expect_error(vdbmap({"merge", a, "-o", out}), ExitCode::kWrongUsage, "two maps");
  expect_error(vdbmap({"merge", a, far, "-o", a}), ExitCode::kWrongUsage, "is an input too");
  EXPECT_FALSE(std::filesystem::exists(out));
}

class RealData : public MapCommand {
 protected:
  void SetUp() override {
    if (!test::real_data_folder()) GTEST_SKIP() << test::kNeedsRealData;
    data_ = *test::real_data_folder();
  }

  // A map of every `every`-th scan of the drive from `offset` on.
  json drive(const std::string& name, const std::string& every, const std::string& offset) const {
    const std::filesystem::path folder = data_ / "kitti_drive5";
    return json_of({"build", folder / "velodyne", "--poses", folder / "poses.txt", "--every", every, "--offset", offset,
                    "-o", path(name)});
  }

  std::filesystem::path data_;
};

TEST_F(RealData, MergingTwoHalvesEqualsBuildingFromAll) {
  const json first = drive("first.vdb", "8", "0");
  const json second = drive("second.vdb", "8", "4");
  const json all = drive("all.vdb", "4", "0");
  const json merged = json_of({"merge", path("first.vdb"), path("second.vdb"), "-o", path("merged.vdb")});
  EXPECT_EQ(all["files"], 16);
  EXPECT_EQ(merged["points"], first["points"].get<int>() + second["points"].get<int>());
  for (const char* key : {"points", "levels", "extent", "anchor", "attributes"})
    EXPECT_EQ(merged[key], all[key]) << key;
}

TEST_F(RealData, AVoxelOfTheStreetIsFoundAgain) {
  drive("map.vdb", "16", "0");
  const json voxels = json_of({"query", path("map.vdb"), "--box", "10,0,-2,12,2,-1.5"});
  ASSERT_GT(voxels.size(), 100U);
  for (std::size_t i = 0; i < voxels.size(); i += 37) {
    EXPECT_EQ(json_of({"query", path("map.vdb"), "--id", voxels[i]["id"].get<std::string>()})[0], voxels[i]);
    const bool is_road = voxels[i]["planarity"] > 0.8;
    EXPECT_GT(voxels[i]["normal"][2], is_road ? 0.9 : 0.0);
  }
}

TEST_F(RealData, FilesOfOtherProgramsAreDescribedAndRefusedAsMaps) {
  for (const char* name : {"arnold_grids.vdb", "arnold_smoke.vdb", "arnold_torus01.vdb"}) {
    const std::string file = data_ / "vdb" / name;
    const json info = json_of({"info", file});
    EXPECT_EQ(info["is_map"], false);
    ASSERT_FALSE(info["grids"].empty());
    for (const json& grid : info["grids"]) EXPECT_GT(grid["active_voxels"], 0);
    expect_error(vdbmap({"query", file, "--at", "1,2,3"}), ExitCode::kBadInput, "not a map of vdbmap");
    expect_error(vdbmap({"merge", file, file, "-o", path("x.vdb")}), ExitCode::kBadInput, "not a map of vdbmap");
  }
}

TEST_F(RealData, ALasFileInFeetIsWarnedOf) {
  const std::string file = data_ / "las" / "color_utm_feet.las";
  const CommandResult result = vdbmap({"build", file, "-o", path("map.vdb"), "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(num_lines(result.err), 1U) << result.err;
  EXPECT_NE(result.err.find("its unit is 0.3048"), std::string::npos) << result.err;
  const json build = json::parse(result.out);
  EXPECT_EQ(build["points"], 10'126);
  EXPECT_EQ(build["has_color"], true);
  EXPECT_TRUE(build["epsg"].is_number());
}

}  // namespace
}  // namespace vdbmap::cli

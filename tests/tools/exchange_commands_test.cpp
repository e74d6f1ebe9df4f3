// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/raw_files.h"
#include "tests/tools/map_command.h"
#include "vdbmap/io/vdb/vdb_file.h"

namespace vdbmap::cli {
namespace {

using nlohmann::json;
using test::CommandResult;
using test::write_raw;

using Check = MapCommand;
using Export = MapCommand;
using Import = MapCommand;

std::string foreign_file(const std::string& path) {
  auto grid = openvdb::FloatGrid::create();
  grid->setName("smoke");
  grid->tree().setValueOn({1, 2, 3}, 1.0F);
  write_vdb(path, {grid}, {});
  return path;
}

TEST_F(Check, NamesEveryRuleOfAMap) {
  const std::string map = built("map.vdb", scan(1));
  const CommandResult text = vdbmap({"check", map});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_TRUE(text.out.starts_with("passed  file_version: 224\n")) << text.out;
  EXPECT_EQ(text.out.find("FAILED"), std::string::npos) << text.out;

  const json report = json_of({"check", map});
  EXPECT_EQ(report["passed"], true);
  EXPECT_EQ(report["rules"].size(), num_lines(text.out));
  EXPECT_EQ(report["rules"][0], json({{"name", "file_version"}, {"passed", true}, {"detail", "224"}}));
}

TEST_F(Check, ABrokenRuleEndsWithOne) {
  const std::string smoke = foreign_file(path("smoke.vdb"));
  const CommandResult text = vdbmap({"check", smoke});
  EXPECT_EQ(text.exit_code, 1);
  EXPECT_EQ(text.err, "");
  EXPECT_NE(text.out.find("\nFAILED  density_and_color: no grid 'density'\n"), std::string::npos) << text.out;
  const CommandResult report = vdbmap({"check", smoke, "--json"});
  EXPECT_EQ(report.exit_code, 1);
  EXPECT_EQ(json::parse(report.out)["passed"], false);
}

TEST_F(Check, FilesThatAreNoVdbAreBadInput) {
  write_raw(folder_ / "text.vdb", "text");
  expect_error(vdbmap({"check", path("text.vdb")}), ExitCode::kBadInput, "text.vdb: is not an OpenVDB file");
  expect_error(vdbmap({"check", path("missing.vdb")}), ExitCode::kInputOutputFailed, "missing.vdb: cannot open");
}

TEST_F(Export, PointsMakeTheSameVoxelsAgain) {
  const std::string map = built("map.vdb", moved(scan(1), kUtm), {"--epsg", "25832"});
  const std::size_t num_voxels = json_of({"info", map})["levels"][0]["voxels"];
  for (const std::string name : {"out.ply", "out.las", "out.xyz"}) {
    EXPECT_EQ(json_of({"export", map, path(name)}), json({{"file", path(name)}, {"num_voxels", num_voxels}}));
    // A mean at the border of its voxel may be rounded into the next one.
    json_of({"build", path(name), "-o", path("again.vdb")});
    EXPECT_NEAR(json_of({"info", path("again.vdb")})["levels"][0]["voxels"].get<double>(),
                static_cast<double>(num_voxels), 0.01 * static_cast<double>(num_voxels))
        << name;
  }
}

TEST_F(Export, WritesTheVoxelsOfTheChosenLevel) {
  const std::string map = built("map.vdb", scan(1));
  EXPECT_EQ(json_of({"export", map, path("out.ply"), "--level", "1"})["num_voxels"],
            json_of({"info", map})["levels"][1]["voxels"]);
  expect_error(vdbmap({"export", map, path("out.ply"), "--level", "7"}), ExitCode::kWrongUsage, "no level of 7 m");
}

TEST_F(Export, WrongUsageLeavesNoFile) {
  const std::string map = built("map.vdb", scan(1));
  const std::string out = path("out.ply");
  expect_error(vdbmap({"export", map}), ExitCode::kWrongUsage, "nothing to export");
  expect_error(vdbmap({"export", map, path("out.laz")}), ExitCode::kWrongUsage, "expected .ply, .las or .xyz");
  expect_error(vdbmap({"export", map, out, "--channels", path("c.vdb")}), ExitCode::kWrongUsage, "excludes");
  expect_error(vdbmap({"export", map, out, "--density", "3"}), ExitCode::kWrongUsage, "requires --channels");
  expect_error(vdbmap({"export", map, "--channels", map}), ExitCode::kWrongUsage, "is an input too");
  expect_error(vdbmap({"export", foreign_file(path("smoke.vdb")), out}), ExitCode::kBadInput, "not a map of vdbmap");
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_FALSE(std::filesystem::exists(path("out.laz")));
  EXPECT_FALSE(std::filesystem::exists(path("c.vdb")));
}

TEST_F(Import, ExportedChannelsMakeTheSameFile) {
  const std::string map = built("map.vdb", moved(scan(1), kUtm), {"--epsg", "25832", "--epoch", "4"});
  for (const std::vector<std::string>& options : {std::vector<std::string>{}, {"--integers-as-float"}}) {
    std::vector<std::string> arguments = {"export", map, "--channels", path("channels.vdb"), "--density", "7"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(vdbmap(arguments).exit_code, 0);
    EXPECT_EQ(vdbmap({"check", path("channels.vdb")}).exit_code, 0);
    EXPECT_EQ(vdbmap({"import", path("channels.vdb"), "-o", path("again.vdb")}).exit_code, 0);
    expect_same_bytes("map.vdb", "again.vdb");
  }
}

TEST_F(Import, OtherFilesAreBadInputAndLeaveNoFile) {
  const std::string map = built("map.vdb", scan(1));
  expect_error(vdbmap({"import", map, "-o", path("again.vdb")}), ExitCode::kBadInput, "lacks grid 'count'");
  EXPECT_FALSE(std::filesystem::exists(path("again.vdb")));
}

}  // namespace
}  // namespace vdbmap::cli

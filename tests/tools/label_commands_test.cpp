// SPDX-License-Identifier: GPL-3.0-or-later
// Classes of points on their way through the commands.
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/picture.h"
#include "tests/support/raw_files.h"
#include "tests/tools/map_command.h"
#include "vdbmap/io/kitti/label_file.h"
#include "vdbmap/io/las/las.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/render/label_colors.h"

namespace vdbmap::cli {
namespace {

using json = nlohmann::json;
using test::CommandResult;

constexpr std::uint16_t kRoad = 40;
constexpr std::uint16_t kBuilding = 50;

class Labels : public MapCommand {
 protected:
  // Two scans of ground and a wall, their poses, and a .label file for each; what to build from.
  std::vector<std::string> labelled_scans() const {
    const std::string folder = scans(2);
    std::filesystem::create_directories(folder_ / "labels");
    for (const std::string name : {"0", "1"}) label(folder + "/" + name + ".bin", "labels/" + name + ".label");
    return {folder, "--poses", path("poses.txt"), "--labels", path("labels")};
  }

  // Road below, building above.
  void label(const std::string& file, const std::string& name) const {
    std::vector<PointLabel> labels;
    for (const Eigen::Vector3d& point : read_points(file).cloud.positions) {
      labels.push_back({point.z() < 0.3 ? kRoad : kBuilding, 0});
    }
    write_labels(folder_ / name, labels);
  }

  std::string labelled_map() const {
    build(labelled_scans(), "map.vdb");
    return path("map.vdb");
  }
};

TEST_F(Labels, InfoTellsTheClassesAndTheirShares) {
  const json info = json_of({"info", labelled_map()});
  EXPECT_EQ(info["labels"]["scheme"], "semantickitti");
  const json& classes = info["labels"]["classes"];
  ASSERT_EQ(classes.size(), 2U);
  EXPECT_EQ(classes[0]["voxels"].get<int>() + classes[1]["voxels"].get<int>(), info["levels"][0]["voxels"].get<int>());
  EXPECT_GE(classes[0]["voxels"], classes[1]["voxels"]);
  const std::string text = vdbmap({"info", path("map.vdb")}).out;
  EXPECT_NE(text.find("classes    semantickitti: "), std::string::npos) << text;
  EXPECT_NE(text.find("road "), std::string::npos) << text;
}

TEST_F(Labels, ClassesThatAreNotWantedDoNotComeIntoTheMap) {
  std::vector<std::string> command = labelled_scans();
  build(command, "all.vdb");
  command.insert(command.begin(), "build");
  command.insert(command.end(), {"--drop", "road", "-o", path("map.vdb")});
  const json built = json_of(command);
  const json all = json_of({"info", path("all.vdb")});
  const json map = json_of({"info", path("map.vdb")});
  EXPECT_EQ(built["points_of_dropped_classes"].get<int>() + map["points"].get<int>(), all["points"].get<int>());
  ASSERT_EQ(map["labels"]["classes"].size(), 1U);
  EXPECT_EQ(map["labels"]["classes"][0]["name"], "building");
  // With rays too, of which scans are read twice.
  command.back() = path("rays.vdb");
  command.insert(command.end(), {"--visibility", "--pose-frame", "lidar"});
  EXPECT_EQ(json_of(command)["points_of_dropped_classes"], built["points_of_dropped_classes"]);
  EXPECT_EQ(json_of({"info", path("rays.vdb")})["labels"]["classes"], map["labels"]["classes"]);
}

TEST_F(Labels, ClassesThatNobodyKnowsAreNotDroppedInSilence) {
  std::vector<std::string> command = labelled_scans();
  command.insert(command.begin(), "build");
  command.insert(command.end(), {"-o", path("map.vdb"), "--drop", "roads"});
  expect_error(vdbmap(command), ExitCode::kWrongUsage, "none is \"roads\"");
  expect_error(vdbmap({"build", ply("a.ply", scan(1)), "--drop", "person", "-o", path("map.vdb")}),
               ExitCode::kWrongUsage, "have no classes");
  EXPECT_FALSE(std::filesystem::exists(path("map.vdb")));
}

TEST_F(Labels, QueryNamesTheClass) {
  const std::string map = labelled_map();
  const json voxels = json_of({"query", map, "--box=-9,-9,-9,9,9,9"});
  std::size_t num_roads = 0;
  for (const json& voxel : voxels) {
    ASSERT_TRUE(voxel["label"] == kRoad || voxel["label"] == kBuilding);
    EXPECT_EQ(voxel["label_name"], voxel["label"] == kRoad ? "road" : "building");
    num_roads += voxel["label"] == kRoad ? 1 : 0;
  }
  EXPECT_GT(num_roads, 10U);
  EXPECT_LT(num_roads, voxels.size());
  EXPECT_NE(vdbmap({"query", map, "--id", voxels[0]["id"]}).out.find("  class        "), std::string::npos);
}

TEST_F(Labels, MapsOfLabelsKeepTheRulesAndComeBackFromTheirChannels) {
  const std::string map = labelled_map();
  EXPECT_EQ(vdbmap({"check", map}).exit_code, 0);
  ASSERT_EQ(vdbmap({"export", map, "--channels", path("channels.vdb")}).exit_code, 0);
  EXPECT_EQ(vdbmap({"check", path("channels.vdb")}).exit_code, 0);
  ASSERT_EQ(vdbmap({"import", path("channels.vdb"), "-o", path("again.vdb")}).exit_code, 0);
  expect_same_bytes("map.vdb", "again.vdb");
  ASSERT_EQ(vdbmap({"merge", map, map, "-o", path("both.vdb")}).exit_code, 0);
  EXPECT_EQ(json_of({"info", path("both.vdb")})["labels"], json_of({"info", map})["labels"]);
}

TEST_F(Labels, LasFilesGetNumbersOfAsprsAndOthersTheMapsOwn) {
  const std::string map = labelled_map();
  const auto labels_in = [&](const std::string& name) {
    EXPECT_EQ(vdbmap({"export", map, path(name)}).exit_code, 0);
    const std::vector<std::uint16_t> labels = read_points(path(name)).cloud.labels;
    return std::set<std::uint16_t>(labels.begin(), labels.end());
  };
  EXPECT_EQ(labels_in("map.las"), (std::set<std::uint16_t>{6, 11}));
  EXPECT_EQ(labels_in("map.ply"), (std::set<std::uint16_t>{kRoad, kBuilding}));
  EXPECT_EQ(labels_in("map.xyz"), (std::set<std::uint16_t>{kRoad, kBuilding}));
  build({path("map.las")}, "las.vdb");
  EXPECT_EQ(json_of({"info", path("las.vdb")})["labels"]["scheme"], "asprs");
}

TEST_F(Labels, OneFileServesOneCloud) {
  const std::string cloud = ply("a.ply", scan(1));
  label(cloud, "a.label");
  build({cloud, "--labels", path("a.label")}, "file.vdb");
  std::filesystem::create_directories(folder_ / "folder");
  label(cloud, "folder/a.label");
  build({cloud, "--labels", path("folder")}, "folder.vdb");
  expect_same_bytes("file.vdb", "folder.vdb");
  build({cloud, "--labels", path("a.label"), "--label-scheme", "asprs"}, "asprs.vdb");
  EXPECT_EQ(json_of({"info", path("asprs.vdb")})["labels"]["scheme"], "asprs");
}

TEST_F(Labels, RenderDrawsClassesInTheirColorsWithALegend) {
  const std::string map = labelled_map();
  const CommandResult result =
      vdbmap({"render", map, "-o", path("classes.png"), "--view", "plan", "--color-by", "label", "--size", "640x400"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Image image = test::read_picture(path("classes.png"));
  for (const std::int32_t label : {kRoad, kBuilding}) {
    EXPECT_GT(test::count_pixels(image, label_color(LabelScheme::kSemanticKitti, label)), 50U);  // of the legend
  }
  EXPECT_EQ(test::count_pixels(image, label_color(LabelScheme::kSemanticKitti, 10)), 0U);
}

TEST_F(Labels, FilesThatDoNotFitAreToldInOneLineAndLeaveNoMap) {
  labelled_scans();
  const auto build_with = [&](const std::string& labels) {
    return vdbmap({"build", path("scans"), "--labels", labels, "-o", path("map.vdb")});
  };
  test::write_raw(folder_ / "labels" / "1.label", std::string(12, '\0'));
  expect_error(build_with(path("labels")), ExitCode::kBadInput, "1.label: has labels of 3 points, the scan has ");
  test::write_raw(folder_ / "labels" / "1.label", "12345");
  expect_error(build_with(path("labels")), ExitCode::kBadInput, "1.label");
  std::filesystem::remove(folder_ / "labels" / "1.label");
  expect_error(build_with(path("labels")), ExitCode::kInputOutputFailed, "1.label: cannot open");
  expect_error(build_with(path("none")), ExitCode::kInputOutputFailed, "none: cannot open");
  expect_error(build_with(path("labels/0.label")), ExitCode::kWrongUsage, "cannot hold the labels of both");
  const std::string cloud = ply("a.ply", scan(1));
  expect_error(vdbmap({"build", cloud, "--label-scheme", "mine", "-o", path("map.vdb")}), ExitCode::kWrongUsage,
               "--label-scheme");
  label(cloud, "a.label");
  expect_error(vdbmap({"build", cloud, "--labels", path("a.label"), "-o", path("a.label")}), ExitCode::kWrongUsage,
               "is an input too");
  std::filesystem::create_directories(folder_ / "folder");
  label(cloud, "folder/a.label");
  expect_error(vdbmap({"build", cloud, "--labels", path("folder"), "-o", path("folder/a.label")}),
               ExitCode::kWrongUsage, "is an input too");
  EXPECT_EQ(read_labels(folder_ / "folder" / "a.label").size(), read_points(cloud).cloud.size());
  std::filesystem::create_directories(folder_ / "other");
  std::filesystem::copy_file(cloud, folder_ / "other" / "a.ply");
  expect_error(vdbmap({"build", cloud, path("other/a.ply"), "--labels", path("folder"), "-o", path("map.vdb")}),
               ExitCode::kWrongUsage, "cannot hold the labels of both");
  EXPECT_FALSE(std::filesystem::exists(path("map.vdb")));
}

TEST_F(Labels, MapsOfOtherSchemesAreNotMerged) {
  const std::string cloud = ply("a.ply", scan(1));
  label(cloud, "a.label");
  build({cloud, "--labels", path("a.label")}, "a.vdb");
  build({cloud, "--labels", path("a.label"), "--label-scheme", "asprs"}, "b.vdb");
  expect_error(vdbmap({"merge", path("a.vdb"), path("b.vdb"), "-o", path("c.vdb")}), ExitCode::kBadInput,
               "has labels of asprs, a map before it of semantickitti");
  PointCloud unknown = scan(1);
  unknown.labels.assign(unknown.size(), 3);
  build({ply("unknown.ply", unknown)}, "unknown.vdb");
  // The order does not matter.
  for (const std::vector<std::string>& order :
       {std::vector<std::string>{"a", "unknown", "b"}, {"unknown", "a", "b"}, {"a", "b", "unknown"}}) {
    std::vector<std::string> arguments = {"merge"};
    for (const std::string& name : order) arguments.push_back(path(name + ".vdb"));
    arguments.insert(arguments.end(), {"-o", path("c.vdb")});
    expect_error(vdbmap(arguments), ExitCode::kBadInput, "labels of ");
  }
}

TEST_F(Labels, ASchemeForFilesWithoutLabelsIsWarnedOf) {
  const CommandResult result =
      vdbmap({"build", ply("a.ply", scan(1)), "--label-scheme", "asprs", "-o", path("map.vdb")});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("the files hold no labels"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace vdbmap::cli

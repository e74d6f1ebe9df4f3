// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/raw_files.h"
#include "tests/support/synthetic_scene.h"
#include "tests/tools/map_command.h"
#include "vdbmap/io/kitti/label_file.h"
#include "vdbmap/io/vdb/map_file.h"

namespace vdbmap::cli {
namespace {

class SegmentCommand : public MapCommand {
 protected:
  PointCloud street() const { return moved(test::sample_scene(test::village(), 40, 2), kUtm); }
};

TEST_F(SegmentCommand, LabelsAMapThatOtherCommandsRead) {
  const std::string map = built("map.vdb", street());
  const nlohmann::json result = json_of({"segment", map, "-o", path("labelled.vdb")});
  const nlohmann::json info = json_of({"info", path("labelled.vdb")});
  EXPECT_EQ(result["voxels"], info["levels"][0]["voxels"]);
  EXPECT_EQ(info["labels"]["scheme"], "semantickitti");
  EXPECT_EQ(vdbmap({"check", path("labelled.vdb")}).exit_code, 0);
  const VoxelMap before = load_map(map), after = load_map(path("labelled.vdb"));
  EXPECT_TRUE(std::ranges::equal(before.finest().records(), after.finest().records()));
  EXPECT_EQ(after.coarsest().channels().labels.size(), after.coarsest().size());
}

TEST_F(SegmentCommand, GivesTheSameBytesForAnyNumberOfThreads) {
  const std::string map = built("map.vdb", street());
  vdbmap({"segment", map, "-o", path("a.vdb"), "--threads", "1"});
  vdbmap({"segment", map, "-o", path("b.vdb"), "--threads", "3"});
  expect_same_bytes("a.vdb", "b.vdb");
}

TEST_F(SegmentCommand, GivesACityTheLabelsOfTheMapThatItIs) {
  PointCloud cloud = street();  // across the border of two tiles, 10 m from its beginning
  for (Eigen::Vector3d& point : cloud.positions) point.x() += 54;
  const std::string map = built("map.vdb", cloud, {"--anchor", "548864,5804032,0"});
  ASSERT_EQ(vdbmap({"export", map, path("city/")}).exit_code, 0);
  EXPECT_EQ(json_of({"segment", path("city/"), "-o", path("labelled/")})["tiles"],
            json_of({"info", path("city/")})["tiles"]);
  ASSERT_EQ(vdbmap({"segment", map, "-o", path("labelled.vdb")}).exit_code, 0);
  EXPECT_EQ(vdbmap({"check", path("labelled/")}).exit_code, 0);
  ASSERT_EQ(vdbmap({"export", path("labelled/"), path("one.vdb")}).exit_code, 0);
  expect_same_bytes("one.vdb", "labelled.vdb");
  expect_error(vdbmap({"segment", path("city/"), "-o", path("labelled/")}), ExitCode::kWrongUsage, "something in it");
  for (const std::string name : {"city.label", "city.png"}) {
    expect_error(vdbmap({"segment", path("city/"), "-o", path(name)}), ExitCode::kWrongUsage, name);
    EXPECT_FALSE(std::filesystem::exists(path(name)));
  }
}

TEST_F(SegmentCommand, LabelsThePointsOfACloudInTheirOrder) {
  const PointCloud cloud = street();
  const nlohmann::json result = json_of({"segment", ply("cloud.ply", cloud), "-o", path("cloud.label")});
  EXPECT_EQ(result["points"], cloud.size());
  const std::vector<PointLabel> labels = read_labels(path("cloud.label"));
  ASSERT_EQ(labels.size(), cloud.size());
  std::size_t num_ground = 0, num_low = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (cloud.positions[i].z() - kUtm.z() > 0.05) continue;
    ++num_low;
    num_ground += labels[i].label == 40 ? 1 : 0;
  }
  EXPECT_GT(static_cast<double>(num_ground), 0.8 * static_cast<double>(num_low));
}

TEST_F(SegmentCommand, CountsPointsThatWereLeftOut) {
  std::ofstream(path("cloud.xyz")) << "0 0 0\nnan 0 0\n0.5 0 0\n0.6 0 0\n";
  EXPECT_EQ(vdbmap({"segment", path("cloud.xyz"), "-o", path("cloud.label")}).exit_code, 0);
  const std::vector<PointLabel> labels = read_labels(path("cloud.label"));
  ASSERT_EQ(labels.size(), 4U);
  EXPECT_NE(labels[0].label, 0);
  EXPECT_EQ(labels[1].label, 0);
  EXPECT_NE(labels[3].label, 0);
}

TEST_F(SegmentCommand, WritesAFolderOfLabelsForScans) {
  const std::string folder = scans(2);
  EXPECT_EQ(vdbmap({"segment", folder, "-o", path("labels")}).exit_code, 0);
  EXPECT_EQ(read_labels(path("labels/0.label")).size(), 5000U);
  EXPECT_EQ(read_labels(path("labels/1.label")).size(), 5000U);
  expect_error(vdbmap({"segment", folder, "-o", path("labels")}), ExitCode::kWrongUsage, "something in it");
}

TEST_F(SegmentCommand, SaysWhatItCannotDo) {
  const std::string map = built("map.vdb", scan(1)), cloud = ply("cloud.ply", scan(1));
  expect_error(vdbmap({"segment", cloud, "-o", path("out.vdb")}), ExitCode::kBadInput, "cloud.ply");
  expect_error(vdbmap({"segment", map, "-o", path("out.label")}), ExitCode::kBadInput, "map.vdb: not a point file");
  expect_error(vdbmap({"segment", map, map, "-o", path("out.vdb")}), ExitCode::kWrongUsage, "one map");
  expect_error(vdbmap({"segment", cloud, scans(1), "-o", path("out.label")}), ExitCode::kWrongUsage, "to a folder");
  expect_error(vdbmap({"segment", cloud, "-o", path("out.png")}), ExitCode::kWrongUsage, "'.png'");
  expect_error(vdbmap({"segment", map, "-o", map}), ExitCode::kWrongUsage, "map.vdb");
  expect_error(vdbmap({"segment", map, "-o", path("out.vdb"), "--weights", cloud}), ExitCode::kBadInput,
               "cloud.ply: is no file of network weights");
  expect_error(vdbmap({"segment", map, "-o", path("out.vdb"), "--weights", path("none")}), ExitCode::kInputOutputFailed,
               "none");
  const std::string coarse = built("coarse.vdb", scan(1), {"--levels", "0.2,1"});
  expect_error(vdbmap({"segment", coarse, "-o", path("out.vdb")}), ExitCode::kBadInput, "coarse.vdb: voxels");
  EXPECT_FALSE(std::filesystem::exists(path("out.vdb")));
  EXPECT_FALSE(std::filesystem::exists(path("out.label")));
}

}  // namespace
}  // namespace vdbmap::cli

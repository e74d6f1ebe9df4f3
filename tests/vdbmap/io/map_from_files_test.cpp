// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/map_from_files.h"

#include <algorithm>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "vdbmap/io/kitti/label_file.h"
#include "vdbmap/io/las/las.h"
#include "vdbmap/io/ply/ply.h"

namespace vdbmap {
namespace {

using test::io_error_of;
using test::write_raw;

PointCloud line(std::size_t count, const Eigen::Vector3d& first) {
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    cloud.positions.push_back(first + Eigen::Vector3d(0.03 * static_cast<double>(i), 0, 0));
  }
  return cloud;
}

class MapFromFilesTest : public testing::Test {
 protected:
  MapInput whole_file(const std::string& name) const { return {{folder_ / name, std::nullopt}, std::nullopt}; }

  MapInput ply(const std::string& name, const PointCloud& cloud) const {
    write_ply(folder_ / name, cloud);
    return whole_file(name);
  }

  test::TemporaryFolder folder_;
};

TEST_F(MapFromFilesTest, EqualsBuildingFromAllPoints) {
  const PointCloud a = line(100, {0.01, 0.01, 0.01});
  const PointCloud b = line(50, {1.02, 0.05, 0.01});
  const MapFromFiles built = build_map_from_files({ply("a.ply", a), ply("b.ply", b)});

  MapBuilder builder({});
  builder.add(a);
  builder.add(b);
  const VoxelMap expected = builder.finish();
  EXPECT_EQ(built.notes.num_points, 150U);
  EXPECT_EQ(built.map.frame, expected.frame);
  EXPECT_TRUE(std::ranges::equal(built.map.finest().records(), expected.finest().records()));
}

TEST_F(MapFromFilesTest, ReadingAheadChangesNothing) {
  const std::vector<MapInput> inputs = {ply("a.ply", line(100, {0, 0, 0})), ply("b.ply", line(9, {0, 5, 0})),
                                        ply("c.ply", line(30, {1, 0, 0}))};
  MapFromFilesOptions options;
  int num_done = 0;
  options.inputs.on_scan_done = [&num_done] { ++num_done; };
  const MapFromFiles ahead = build_map_from_files(inputs, options);
  EXPECT_EQ(num_done, 3);
  options.inputs.reads_ahead = false;
  const MapFromFiles one_by_one = build_map_from_files(inputs, options);
  EXPECT_TRUE(std::ranges::equal(ahead.map.finest().records(), one_by_one.map.finest().records()));
}

TEST_F(MapFromFilesTest, APoseMovesTheScan) {
  MapInput input = ply("a.ply", line(1, {1.05, 0.05, 0.05}));
  input.map_from_scan = Eigen::Isometry3d(Eigen::AngleAxisd(EIGEN_PI / 2, Eigen::Vector3d::UnitZ()));
  input.map_from_scan->translation().z() = 7;
  const MapFromFiles built = build_map_from_files({input});
  for_each_voxel(built.map.finest(),
                 [](const VoxelIndex& voxel, std::size_t) { EXPECT_EQ(voxel, VoxelIndex(-1, 10, 70)); });
}

TEST_F(MapFromFilesTest, TheRangeIsMeasuredFromTheSensor) {
  PointCloud cloud;
  cloud.positions = {{1.5, 0, 0}, {0, 2, 0}, {0, 0, -2.5}, {3, 4, 0}, {3, 4, 0.1}};
  cloud.labels = {1, 2, 3, 4, 5};
  MapInput input = ply("a.ply", cloud);
  write_labels(folder_ / "a.label", {{11, 0}, {12, 0}, {13, 0}, {14, 0}, {15, 0}});
  input.labels = folder_ / "a.label";
  input.map_from_scan = Eigen::Translation3d(1000, 0, 0);
  MapFromFilesOptions options;
  options.inputs.range = {2, 5};
  const MapFromFiles built = build_map_from_files({input}, options);
  EXPECT_EQ(built.notes.num_points, 3U);
  EXPECT_EQ(built.notes.num_out_of_range, 2U);
  std::vector<std::int32_t> labels = built.map.finest().channels().labels;
  std::ranges::sort(labels);
  EXPECT_EQ(labels, (std::vector<std::int32_t>{12, 13, 14}));

  input.map_from_scan = std::nullopt;  // no sensor is known to measure from
  EXPECT_EQ(build_map_from_files({input}, options).notes.num_points, 5U);
  input.map_from_scan = Eigen::Isometry3d::Identity();
  options.inputs.range = {50, 60};
  EXPECT_THROW(build_map_from_files({input}, options), std::invalid_argument);
}

TEST_F(MapFromFilesTest, TellsWhatTheFilesHeld) {
  write_raw(folder_ / "holes.xyz", "1 1 1\n2 nan 2\n");
  write_las(folder_ / "a.las", line(10, {0, 0, 0}), {.epsg = 25832});
  const MapFromFiles built = build_map_from_files({whole_file("holes.xyz"), whole_file("a.las")});
  EXPECT_EQ(built.notes.num_points, 11U);
  EXPECT_EQ(built.notes.num_dropped, 1U);
  EXPECT_EQ(built.notes.epsg_of_files, 25832);
  EXPECT_EQ(built.map.frame.epsg, 25832);
  EXPECT_TRUE(built.notes.foreign_units.empty());
}

TEST_F(MapFromFilesTest, LasFilesAndLabelFilesSayWhoseNumbersTheirLabelsAre) {
  PointCloud cloud = line(2, {0.01, 0.01, 0.01});
  cloud.labels = {6, 6};
  write_las(folder_ / "a.las", cloud, {});
  EXPECT_EQ(build_map_from_files({whole_file("a.las")}).map.label_scheme, LabelScheme::kAsprs);

  write_labels(folder_ / "a.label", {{50, 3}, {50, 3}});
  MapInput input = whole_file("a.las");
  input.labels = folder_ / "a.label";
  const VoxelMap map = build_map_from_files({input}).map;
  EXPECT_EQ(map.label_scheme, LabelScheme::kSemanticKitti);
  EXPECT_EQ(map.finest().channels().labels, std::vector<std::int32_t>{50});

  const MapInput ply_input = ply("b.ply", cloud);
  EXPECT_EQ(build_map_from_files({ply_input}).map.label_scheme, LabelScheme::kUnknown);
  EXPECT_EQ(build_map_from_files({ply_input, whole_file("a.las")}).map.label_scheme, LabelScheme::kUnknown);
  EXPECT_EQ(build_map_from_files({whole_file("a.las"), ply("plain.ply", line(2, {5, 0, 0}))}).map.label_scheme,
            LabelScheme::kAsprs);
  MapFromFilesOptions options;
  options.inputs.label_scheme = LabelScheme::kSemanticKitti;
  EXPECT_EQ(build_map_from_files({ply_input, whole_file("a.las")}, options).map.label_scheme,
            LabelScheme::kSemanticKitti);
  EXPECT_EQ(io_error_of([&] {
              build_map_from_files({whole_file("a.las"), input});
            }),
            "a.las: has labels of semantickitti, files before it of asprs");
  EXPECT_EQ(io_error_of([&] {
              build_map_from_files({whole_file("a.las"), ply_input, input});
            }),
            "a.las: has labels of semantickitti, files before it of asprs");
}

TEST_F(MapFromFilesTest, AnEpsgCodeOfTheOptionsComesFirst) {
  write_las(folder_ / "a.las", line(10, {0, 0, 0}), {.epsg = 25832});
  MapFromFilesOptions options;
  options.build.epsg = 32632;
  const MapFromFiles built = build_map_from_files({whole_file("a.las")}, options);
  EXPECT_EQ(built.notes.epsg_of_files, 25832);
  EXPECT_EQ(built.map.frame.epsg, 32632);
}

TEST_F(MapFromFilesTest, ScansWithAPoseSayNothingOfTheMapsSystem) {
  write_las(folder_ / "a.las", line(10, {0, 0, 0}), {.epsg = 25832});
  const MapFromFiles built = build_map_from_files({{{folder_ / "a.las", {}}, Eigen::Isometry3d::Identity()}});
  EXPECT_EQ(built.map.frame.epsg, std::nullopt);
}

TEST_F(MapFromFilesTest, PointsBeyondTheRangeAreAFinding) {
  PointCloud street = line(9, {389'012.45, 5'812'345.12, 55.3});
  const VoxelMap expected = build_map(street);
  for (const bool is_first : {true, false}) {
    PointCloud cloud = street;
    cloud.positions.insert(is_first ? cloud.positions.begin() : cloud.positions.end(), Eigen::Vector3d(0, 7, 0.25));
    const MapInput input = ply("stray.ply", cloud);
    const MapFromFiles built = build_map_from_files({input});
    EXPECT_EQ(built.map.frame, expected.frame);
    EXPECT_EQ(built.notes.num_points, 9U);
    ASSERT_EQ(built.notes.findings.size(), 1U);
    EXPECT_EQ(built.notes.findings[0].file, input.scan.file);
    EXPECT_EQ(built.notes.findings[0].finding.text(),
              "1 points left out that are more than 104857.6 m from the map's anchor (0, 7, 0.25)");

    MapFromFilesOptions strict;
    strict.inputs.read.strict = true;
    EXPECT_EQ(io_error_of([&] { build_map_from_files({input}, strict); }).substr(0, 11), "stray.ply: ");
  }
}

TEST_F(MapFromFilesTest, CoordinatesInMillimetresAreRefusedWithTheReason) {
  const MapInput input = ply("mm.ply", line(3, {389'012'450, 5'812'345'120, 55'300}));
  EXPECT_EQ(io_error_of([&] { build_map_from_files({input}); }),
            "mm.ply: point 389012450, 5812345120, 55300 is not within 1e9 m of the origin, where maps lie; are the "
            "coordinates in metres?");
}

TEST_F(MapFromFilesTest, ErrorsNameTheFile) {
  const MapInput near = ply("near.ply", line(1, {0, 0, 0}));
  const MapInput far = ply("far.ply", line(1, {2e5, 0, 0}));
  EXPECT_EQ(io_error_of([&] { build_map_from_files({near, far}); }).substr(0, 9), "far.ply: ");
  EXPECT_EQ(io_error_of([&] {
              build_map_from_files({near, whole_file("missing.ply")});
            }).substr(0, 13),
            "missing.ply: ");
  EXPECT_THROW(build_map_from_files({}), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap

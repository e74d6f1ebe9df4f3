// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/map_export.h"

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "tests/support/sample_maps.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/srgb.h"
#include "vdbmap/io/las/las.h"
#include "vdbmap/io/ply/ply.h"
#include "vdbmap/io/table/xyz.h"

namespace vdbmap {
namespace {

class MapExport : public testing::Test {
 protected:
  PointCloud exported(const std::string& name, const VoxelMap& map, const VoxelLevel& level) const {
    export_points(folder_ / name, map, level);
    if (name.ends_with(".ply")) return read_ply(folder_ / name).cloud;
    if (name.ends_with(".las")) return read_las(folder_ / name).cloud;
    return read_xyz(folder_ / name).cloud;
  }

  test::TemporaryFolder folder_;
};

const std::vector<std::string> kNames = {"points.ply", "points.las", "points.xyz"};

TEST_F(MapExport, WritesOnePointAVoxelAtItsMean) {
  const VoxelMap map = test::sample_map();
  for (const std::string& name : kNames) {
    for (const VoxelLevel& level : map.levels) {
      const PointCloud cloud = exported(name, map, level);
      ASSERT_EQ(cloud.size(), level.size()) << name;
      for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t i) {
        const Eigen::Vector3d mean = map.frame.anchor + mean_of(level.records()[i], voxel, level.voxel_size());
        // LAS rounds to 0.1 mm.
        EXPECT_LE((cloud.positions[i] - mean).cwiseAbs().maxCoeff(), 0.5e-4 + 1e-9) << name;
      });
    }
  }
}

TEST_F(MapExport, TheMeanOfOnePointIsRightToATenthOfAMillimetreAtUtmCoordinates) {
  PointCloud point;
  point.positions.emplace_back(551234.56789, 5803456.78912, 61.23456);
  const VoxelMap map = build_map(point);
  for (const std::string& name : kNames) {
    const PointCloud cloud = exported(name, map, map.finest());
    ASSERT_EQ(cloud.size(), 1u);
    EXPECT_LE((cloud.positions[0] - point.positions[0]).cwiseAbs().maxCoeff(), 1e-4) << name;
  }
}

TEST_F(MapExport, ColorsComeOutAsTheyWentIn) {
  PointCloud point;
  point.positions.emplace_back(1, 2, 3);
  point.colors.push_back({255 * 257, 128 * 257, 7 * 257});
  const VoxelMap map = build_map(point);
  for (const std::string& name : kNames) {
    const Rgb16 color = exported(name, map, map.finest()).colors.at(0);
    // Linear 16-bit codes are coarser than sRGB where it is dark: 13 codes of 65535.
    EXPECT_NEAR(color.r, point.colors[0].r, 13) << name;
    EXPECT_NEAR(color.g, point.colors[0].g, 13) << name;
    EXPECT_NEAR(color.b, point.colors[0].b, 13) << name;
  }
}

TEST_F(MapExport, WritesIntensitiesWhereTheMapHasThem) {
  const VoxelMap map = test::sample_map();
  EXPECT_EQ(exported("points.ply", map, map.finest()).intensities, map.finest().channels().intensities);
  const VoxelMap bare = test::sample_map_without_attributes();
  for (const std::string& name : kNames) {
    const PointCloud cloud = exported(name, bare, bare.finest());
    EXPECT_TRUE(cloud.intensities.empty()) << name;
    EXPECT_TRUE(cloud.colors.empty()) << name;
  }
}

TEST_F(MapExport, LasFilesNameTheReferenceSystem) {
  const VoxelMap map = test::sample_map();
  export_points(folder_ / "points.las", map, map.finest());
  EXPECT_EQ(read_las(folder_ / "points.las").epsg, 25832);
}

TEST_F(MapExport, ChoosesTheFormatByTheExtensionInAnyCase) {
  EXPECT_EQ(export_format("a/b.PLY"), PointFormat::kPly);
  EXPECT_EQ(export_format("a.b.Las"), PointFormat::kLas);
  EXPECT_EQ(export_format("a.xyz"), PointFormat::kXyz);
  for (const char* name : {"a", "a.vdb", "a.laz", "a.ply.gz", ".ply", "ply"}) {
    EXPECT_THROW(export_format(name), std::invalid_argument) << name;
  }
  EXPECT_THROW(export_points(folder_ / "a.laz", test::sample_map(), test::sample_map().finest()),
               std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.laz"));
}

TEST_F(MapExport, LabelsAreWrittenAsFarAsAFormatHasRoomForThem) {
  PointCloud cloud;
  cloud.positions = {{0.05, 0, 0}, {1.05, 0, 0}, {2.05, 0, 0}, {3.05, 0, 0}};
  cloud.labels = {0, 31, 40, 50};
  VoxelMap map = build_map(cloud, test::anchored({0, 0, 0}));
  using Labels = std::vector<std::uint16_t>;
  EXPECT_EQ(exported("points.ply", map, map.finest()).labels, (Labels{0, 31, 40, 50}));
  EXPECT_EQ(exported("points.las", map, map.finest()).labels, (Labels{0, 31, 1, 1}));
  map.label_scheme = LabelScheme::kSemanticKitti;
  EXPECT_EQ(exported("points.las", map, map.finest()).labels, (Labels{0, 1, 11, 6}));
  EXPECT_EQ(exported("points.xyz", map, map.finest()).labels, (Labels{0, 31, 40, 50}));
}

}  // namespace
}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/site.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/city_folders.h"
#include "tests/support/folders.h"
#include "tests/support/glb_points.h"
#include "tests/support/raw_files.h"
#include "tests/support/run_command.h"
#include "tests/support/sample_maps.h"
#include "tests/support/threads.h"
#include "tests/support/tileset_tiles.h"
#include "vdbmap/core/error.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/map_merge.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/io/geodesy/geodetic_transform.h"
#include "vdbmap/io/vdb/diff_file.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/io/vdb/vdb_file.h"
#include "vdbmap/store/city_of_map.h"
#include "vdbmap/web/label_code.h"

namespace vdbmap {
namespace {

constexpr double kGeoidOffset = 43.5;  // [m]
constexpr double kEdge = 0.1;          // [m] of a voxel

void add_point(PointCloud& cloud, const VoxelIndex& voxel, std::uint16_t shade, std::uint16_t label) {
  cloud.positions.push_back(test::kUtm + center_of_voxel(voxel, kEdge));
  cloud.colors.push_back({shade, static_cast<std::uint16_t>(65535 - shade), static_cast<std::uint16_t>(shade / 2)});
  cloud.labels.push_back(label);
}

// A strip of ground across the origin, from one block of tiles into the next, a solid cube at their border, inside of
// which nothing can be seen, and a mast that bytes do not reach the top of.
PointCloud strip_and_cube() {
  PointCloud cloud;
  for (int x = -1400; x < 1400; ++x) {
    for (int y = -4; y < 4; ++y)
      add_point(cloud, {x, y, (x * x + y) % 3}, static_cast<std::uint16_t>(20 * (x + 1400)), 40);
  }
  for (int x = -10; x < 10; ++x) {
    for (int y = 10; y < 30; ++y) {
      for (int z = 0; z < 20; ++z) {
        add_point(cloud, {x, y, z}, 9000, 50);
        if (y == 10) add_point(cloud, {x, y, z}, 30'000, 252);  // the second vote
        if (y == 10) add_point(cloud, {x, y, z}, 30'000, 252);
      }
    }
  }
  for (int z = 0; z < 700; ++z) add_point(cloud, {200, 100, z}, 60'000, 80);
  return cloud;
}

VoxelMap street(std::int32_t epoch = 1) {
  BuildOptions options = test::anchored(test::kUtm);
  options.voxel_sizes = {kEdge, 1};
  options.epsg = 25832;
  options.epoch = epoch;
  VoxelMap map = build_map(strip_and_cube(), options);
  map.label_scheme = LabelScheme::kSemanticKitti;
  return map;
}

using Points = std::map<VoxelIndex, test::GlbPoint>;

// The points of each level by their voxels; no voxel is there twice.
std::map<double, Points> points_of_levels(const std::filesystem::path& tileset) {
  std::map<double, Points> levels;
  for (const test::TilesetTile& tile : test::tiles_of_tileset(tileset)) {
    for (const test::GlbPoint& point : test::points_of_glb(test::read_raw(tile.content))) {
      EXPECT_TRUE(levels[point.voxel_size].emplace(point.voxel, point).second) << point.voxel;
    }
  }
  return levels;
}

int open_faces(const std::set<VoxelIndex>& voxels, const VoxelIndex& voxel) {
  int faces = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, 1}) {
      VoxelIndex beside = voxel;
      beside[axis] += side == 0 ? -1 : 1;
      if (!voxels.contains(beside)) faces |= 1 << (2 * axis + side);
    }
  }
  return faces;
}

std::set<VoxelIndex> voxels_of(const VoxelLevel& level) {
  std::set<VoxelIndex> voxels;
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t) { voxels.insert(voxel); });
  return voxels;
}

int byte_of(double linear) { return static_cast<int>(std::lround(255 * linear)); }

class SiteTest : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::vector<std::filesystem::path>& maps) {
    std::vector<SiteEpoch> epochs;
    for (const std::filesystem::path& map : maps) epochs.push_back({map, ""});
    SiteOptions options;
    options.name = "a street";
    options.geoid_offset = kGeoidOffset;
    written_ = write_site(folder_ / name, epochs, options);
    return folder_ / name;
  }

  std::filesystem::path saved(const std::string& name, const VoxelMap& map) const {
    save_map(folder_ / name, map);
    return folder_ / name;
  }

  // The tiles and details of a site, by name.
  static std::map<std::string, std::string> files_of(const std::filesystem::path& site) {
    return test::files_of_city(site);
  }

  test::TemporaryFolder folder_;
  SiteWritten written_;
};

TEST_F(SiteTest, HasEveryVoxelThatCanBeSeenOnceWithItsAttributes) {
  const VoxelMap map = street(3);
  const std::filesystem::path site = write("site", {saved("map.vdb", map)});
  const Points points = points_of_levels(site / "tileset_1.json")[kEdge];
  const std::set<VoxelIndex> voxels = voxels_of(map.finest());

  std::size_t num_hidden = 0;
  for_each_voxel(map.finest(), [&](const VoxelIndex& voxel, std::size_t number) {
    const int faces = open_faces(voxels, voxel);
    const auto found = points.find(voxel);
    num_hidden += faces == 0 ? 1 : 0;
    ASSERT_EQ(found != points.end(), faces != 0) << voxel;
    if (faces == 0) return;
    const Eigen::Vector3d color = color_of(map.finest().records()[number]);
    const std::array<int, 3> expected_color = {byte_of(color.x()), byte_of(color.y()), byte_of(color.z())};
    EXPECT_EQ(found->second.color, expected_color) << voxel;
    const int code = code_of_label(map.label_scheme, map.finest().channels().labels[number]);
    const std::array<int, 4> expected = {code, 0, faces, 0};
    EXPECT_EQ(found->second.attributes, expected) << voxel;
  });
  EXPECT_EQ(points.size() + num_hidden, map.finest().size());
  EXPECT_EQ(num_hidden, 18U * 18 * 18);
  EXPECT_EQ(written_.num_drawn, points.size());
  EXPECT_EQ(written_.num_voxels, map.finest().size());
}

TEST_F(SiteTest, PutsEveryVoxelToAMillimetreWhereProjPutsIt) {
  const std::filesystem::path site = write("site", {saved("map.vdb", street())});
  const GeodeticTransform transform(25832, kGeoidOffset);
  std::size_t num_checked = 0;
  for (const test::TilesetTile& tile : test::tiles_of_tileset(site / "tileset_1.json")) {
    const auto points = test::points_of_glb(test::read_raw(tile.content));
    if (points.front().voxel_size > 0.8 + 1e-9) continue;  // above, tiles are larger than the Earth is flat
    for (std::size_t i = 0; i < points.size(); i += 97) {
      const Eigen::Vector3d local = center_of_voxel(points[i].voxel, points[i].voxel_size);
      const Eigen::Vector3d expected = transform.to_ecef(test::kUtm + local);
      ASSERT_LT((tile.world_from_tile * points[i].position - expected).norm(), 1e-3) << tile.content;
      ++num_checked;
    }
  }
  EXPECT_GT(num_checked, 200U);
}

TEST_F(SiteTest, CoarseLevelsHaveWhatTheirChildrenHave) {
  const VoxelMap map = street();
  const auto levels = points_of_levels(write("site", {saved("map.vdb", map)}) / "tileset_1.json");
  for (const int factor : {2, 4, 8}) {
    struct Sum {
      double count = 0;
      Eigen::Vector3d color = Eigen::Vector3d::Zero();
    };
    std::map<VoxelIndex, Sum> sums;
    for_each_voxel(map.finest(), [&](const VoxelIndex& voxel, std::size_t number) {
      const VoxelRecord& record = map.finest().records()[number];
      Sum& sum = sums[parent_of_voxel(voxel, factor)];
      sum.count += record.count;
      sum.color += record.count * color_of(record);
    });
    std::set<VoxelIndex> voxels;
    for (const auto& [voxel, sum] : sums) voxels.insert(voxel);
    const auto level =
        std::ranges::find_if(levels, [&](const auto& l) { return std::abs(l.first - factor * kEdge) < 1e-9; });
    ASSERT_NE(level, levels.end());
    for (const auto& [voxel, sum] : sums) {
      const int faces = open_faces(voxels, voxel);
      const auto found = level->second.find(voxel);
      ASSERT_EQ(found != level->second.end(), faces != 0) << factor << voxel;
      if (faces == 0) continue;
      EXPECT_EQ(found->second.attributes[2], faces) << factor << voxel;
      for (int i = 0; i < 3; ++i) {
        // Colours are stored with 8 bits on every level: 0.2 % a level, and half a step of the byte.
        const double expected = 255 * sum.color[i] / sum.count;
        EXPECT_NEAR(found->second.color[static_cast<std::size_t>(i)], expected, 0.006 * expected + 0.51)
            << factor << voxel;
      }
    }
  }
}

TEST_F(SiteTest, ACoarseVoxelHasTheLabelOfMostOfItsPoints) {
  const auto levels = points_of_levels(write("site", {saved("map.vdb", street())}) / "tileset_1.json");
  // Of the cube's lower side y two of three points are moving cars (252): 0.8 m deep that is 1200 against 800 + 6 *
  // 400.
  EXPECT_EQ(levels.at(0.1).at({0, 10, 5}).attributes[0], 240);
  EXPECT_EQ(levels.at(0.1).at({0, 11, 19}).attributes[0], 50);
  EXPECT_EQ(levels.at(0.2).at({0, 5, 5}).attributes[0], 240);  // 2 x 2 x 2 voxels: 12 points of 16 are in the side
  EXPECT_EQ(levels.at(0.4).at({0, 2, 4}).attributes[0], 240);  // y from 8 to 11: the side has 3 of 4
  EXPECT_EQ(levels.at(0.8).at({0, 1, 2}).attributes[0], 50);   // y from 8 to 15: 3 against 5
}

TEST_F(SiteTest, DetailsAreTheRecordsOfTheVoxels) {
  const VoxelMap map = street();
  const std::filesystem::path site = write("site", {saved("map.vdb", map)});
  const VoxelFinder finder(map.finest());
  std::size_t num_points = 0;
  for (const test::TilesetTile& tile : test::tiles_of_tileset(site / "tileset_1.json")) {
    const std::string glb = test::read_raw(tile.content);
    const nlohmann::json node = test::json_of_glb(glb)["nodes"][1];
    EXPECT_EQ(node["extras"].contains("details"), tile.is_leaf);
    if (!tile.is_leaf) continue;
    const std::string details =
        test::read_raw(tile.content.parent_path() / node["extras"]["details"].get<std::string>());
    const auto points = test::points_of_glb(glb);
    ASSERT_EQ(details.size(), 44 * points.size());
    for (const test::GlbPoint& point : points) {
      const char* const bytes = details.data() + 44 * point.detail;
      const VoxelRecord& record = *finder.find(point.voxel);
      EXPECT_EQ(load<std::uint32_t>(bytes), record.count);
      const Eigen::Vector3d mean = mean_of(record, point.voxel, kEdge) - corner_of_voxel(point.voxel, kEdge);
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(load<float>(bytes + 4 + 4 * i), mean[i], 1e-7);
        EXPECT_NEAR(static_cast<signed char>(bytes[41 + i]) / 127.0, normal_of(record)[i], 0.5 / 127 + 1e-9);
      }
      for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(load<float>(bytes + 16 + 4 * i), record.covariance[i]);
      EXPECT_EQ(static_cast<unsigned char>(bytes[40]), point.attributes[0]);
      ++num_points;
    }
  }
  EXPECT_EQ(num_points, written_.num_drawn);
}

TEST_F(SiteTest, BoundingVolumesHoldTheirTilesAndTheTilesBelow) {
  const auto tiles = test::tiles_of_tileset(write("site", {saved("map.vdb", street())}) / "tileset_1.json");
  std::size_t num_roots = 0;
  for (const test::TilesetTile& tile : tiles) {
    const auto points = test::points_of_glb(test::read_raw(tile.content));
    for (const test::GlbPoint& point : points) {
      const Eigen::Vector3d half = Eigen::Vector3d::Constant(point.voxel_size / 2);
      EXPECT_TRUE(tile.box.contains(point.position - half) && tile.box.contains(point.position + half));
    }
    EXPECT_EQ(tile.error, tile.is_leaf ? 0 : points.front().voxel_size);
    if (!tile.parent) {
      ++num_roots;
      continue;
    }
    const test::TilesetTile& parent = tiles[*tile.parent];
    EXPECT_GT(parent.error, tile.error);
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d world =
          tile.world_from_tile * tile.box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
      EXPECT_LT(parent.box.exteriorDistance(parent.world_from_tile.inverse() * world), 1e-6) << tile.content;
    }
  }
  EXPECT_LE(num_roots, 4U);
}

TEST_F(SiteTest, OfACityIsThatOfTheMapInOnePiece) {
  const VoxelMap map = street();
  save_city(folder_ / "city", map);
  const auto of_map = files_of(write("a", {saved("map.vdb", map)}));
  auto of_city = files_of(write("b", {folder_ / "city"}));
  EXPECT_TRUE(of_map == of_city);
  EXPECT_GT(of_map.size(), 100U);
}

TEST_F(SiteTest, HasTheSameBytesForAnyNumberOfThreads) {
  const std::filesystem::path map = saved("map.vdb", street());
  const auto one = test::on_threads(1, [&] { return files_of(write("one", {map})); });
  const auto four = test::on_threads(4, [&] { return files_of(write("four", {map})); });
  EXPECT_TRUE(one == four);
}

TEST_F(SiteTest, FilesThatStayAreNotWrittenAgain) {
  const std::filesystem::path before = saved("before.vdb", street());
  BuildOptions options = test::anchored(test::kUtm);
  options.voxel_sizes = {kEdge, 1};
  options.epsg = 25832;
  options.epoch = 1;
  PointCloud more;
  add_point(more, {1300, 20, 7}, 5000, 10);
  VoxelMap added = build_map(more, options);
  added.label_scheme = LabelScheme::kSemanticKitti;
  const std::filesystem::path after = saved("after.vdb", merge_maps(street(), added));

  const std::filesystem::path site = write("site", {before});
  const auto names_before = files_of(site);
  const std::size_t all = written_.num_files_written;
  EXPECT_EQ(written_.num_files_kept, 0U);
  write("site", {before});
  EXPECT_EQ(written_.num_files_written, 0U);
  EXPECT_EQ(written_.num_files_kept, all);
  EXPECT_TRUE(files_of(site) == names_before);
  // One voxel more: its tile of every level, and the details of the finest. Nothing of what was is left.
  write("site", {after});
  EXPECT_EQ(written_.num_files_written, nlohmann::json::parse(test::read_raw(site / "site.json"))["levels"].size() + 1);
  EXPECT_TRUE(files_of(site) == files_of(write("new", {after})));
}

TEST_F(SiteTest, EpochsOfACityAreOneSite) {
  save_city(folder_ / "city", street(1));
  const std::filesystem::path site = write("site", {folder_ / "city", folder_ / "city"});
  const nlohmann::json json = nlohmann::json::parse(test::read_raw(site / "site.json"));
  ASSERT_EQ(json["epochs"].size(), 2U);
  EXPECT_EQ(json["epochs"][1]["tileset"], "tileset_2.json");
  EXPECT_EQ(written_.num_files_kept, written_.num_files_written) << "equal tiles are one file";
}

TEST_F(SiteTest, SaysWhereItIsAndWhatItHas) {
  const VoxelMap map = street();
  const std::filesystem::path site = write("site", {saved("map.vdb", map)});
  const nlohmann::json json = nlohmann::json::parse(test::read_raw(site / "site.json"));
  EXPECT_EQ(json["format"], "vdbmap-site");
  EXPECT_EQ(json["epsg"], 25832);
  EXPECT_EQ(json["anchor"][1], test::kUtm.y());
  EXPECT_EQ(json["bounds"]["min"][0], -140);
  EXPECT_NEAR(json["bounds"]["max"][2].get<double>(), 70, 1e-9);
  EXPECT_EQ(json["epochs"][0]["voxels"], map.finest().size());
  EXPECT_EQ(json["epochs"][0]["points"], num_points(map.finest()));
  EXPECT_EQ(json["attributes"], nlohmann::json({{"color", true}, {"label", true}, {"change", false}, {"epoch", true}}));
  std::map<int, std::string> labels;
  for (const nlohmann::json& label : json["labels"]) labels[label["code"]] = label["name"];
  EXPECT_EQ(labels, (std::map<int, std::string>{{40, "road"}, {50, "building"}, {80, "pole"}, {240, "moving-car"}}));
  Eigen::Affine3d local_from_ecef;
  for (Eigen::Index i = 0; i < 16; ++i)
    local_from_ecef.matrix().data()[i] = json["local_from_ecef"][static_cast<std::size_t>(i)];
  const Eigen::Vector3d local(1, 2, 3);
  const Eigen::Vector3d ecef = GeodeticTransform(25832, kGeoidOffset).to_ecef(test::kUtm + local);
  EXPECT_LT((local_from_ecef * ecef - local).norm(), 0.005) << "280 m long: 1.5 mm of curvature";
}

TEST_F(SiteTest, OfAMapWithoutAttributesIsLocal) {
  VoxelMap map = test::sample_map_without_attributes();
  const std::filesystem::path site = write("site", {saved("map.vdb", map)});
  const nlohmann::json json = nlohmann::json::parse(test::read_raw(site / "site.json"));
  EXPECT_TRUE(json["epsg"].is_null());
  EXPECT_FALSE(written_.is_on_globe);
  EXPECT_EQ(json["attributes"]["color"], false);
  EXPECT_TRUE(json["labels"].empty());
  for (const test::TilesetTile& tile : test::tiles_of_tileset(site / "tileset_1.json")) {
    for (const test::GlbPoint& point : test::points_of_glb(test::read_raw(tile.content))) {
      EXPECT_EQ(point.color[0], -1);
      const Eigen::Vector3d local = center_of_voxel(point.voxel, point.voxel_size);
      EXPECT_LT((tile.world_from_tile * point.position - local).norm(), 1e-6);
    }
  }
}

TEST_F(SiteTest, RefusesFoldersOfOthersAndLeavesThem) {
  const std::filesystem::path map = saved("map.vdb", test::sample_map());
  std::filesystem::create_directory(folder_ / "mine");
  std::ofstream(folder_ / "mine" / "letter.txt") << "dear";
  EXPECT_EQ(test::io_error_of([&] { write("mine", {map}); }),
            "mine: holds something else, expected a new folder or a site that vdbmap made");
  std::ofstream(folder_ / "mine" / "site.json") << R"({"format": "another"})";
  EXPECT_THROW(write("mine", {map}), IoError);
  EXPECT_EQ(test::read_raw(folder_ / "mine" / "letter.txt"), "dear");
}

TEST_F(SiteTest, OfWhatCannotBeShownIsRefusedAndTheFormerSiteStays) {
  const std::filesystem::path map = saved("map.vdb", test::sample_map());
  const auto before = files_of(write("site", {map}));
  const std::filesystem::path empty = saved("empty.vdb", empty_map(test::sample_map().frame, {kEdge, 1}));
  EXPECT_EQ(test::io_error_of([&] { write("site", {empty}); }), "empty.vdb: holds no voxels to show");
  EXPECT_THROW(write("site", {}), std::invalid_argument);
  EXPECT_THROW(write("site", {map, saved("other.vdb", test::sample_map_without_attributes())}), std::invalid_argument);
  VoxelMap nowhere = test::sample_map();
  nowhere.frame.epsg = 4326;
  EXPECT_THROW(write("site", {saved("nowhere.vdb", nowhere)}), std::invalid_argument);
  EXPECT_TRUE(files_of(folder_ / "site") == before);
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    EXPECT_TRUE(entry.path().filename() == "site" || entry.path().extension() == ".vdb") << entry.path();
  }
}

TEST_F(SiteTest, FarFromTheOriginLevelsGoOnUntilOneTileIsLeft) {
  PointCloud cloud;
  for (int i = 0; i < 40; ++i) add_point(cloud, {3000 + 400 * i, 5000, i}, 9000, 50);  // 300 m to 1860 m
  BuildOptions options = test::anchored(test::kUtm);
  options.voxel_sizes = {kEdge, 1};
  options.epsg = 25832;
  const std::filesystem::path site = write("site", {saved("map.vdb", build_map(cloud, options))});
  const nlohmann::json json = nlohmann::json::parse(test::read_raw(site / "site.json"));
  EXPECT_EQ(json["levels"].size(), 8U) << "2048 m are 160 voxels of 12.8 m";
  EXPECT_EQ(json["levels"].back(), 12.8);
  const auto levels = points_of_levels(site / "tileset_1.json");
  for (const auto& [voxel_size, points] : levels) {
    std::set<VoxelIndex> parents;
    const int factor = static_cast<int>(std::lround(voxel_size / kEdge));
    for (int i = 0; i < 40; ++i) parents.insert({(3000 + 400 * i) / factor, 5000 / factor, i / factor});
    EXPECT_EQ(points.size(), parents.size()) << voxel_size;
    for (const VoxelIndex& voxel : parents) EXPECT_TRUE(points.contains(voxel)) << voxel_size << voxel;
  }
  std::size_t num_roots = 0;
  for (const test::TilesetTile& tile : test::tiles_of_tileset(site / "tileset_1.json"))
    num_roots += tile.parent ? 0 : 1;
  EXPECT_EQ(num_roots, 1U);
}

TEST_F(SiteTest, ADiffMarksTheLastEpochAndShowsWhatVanished) {
  const VoxelMap before = test::map_of_voxels({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  const VoxelMap after = test::map_of_voxels({{0, 0, 0}, {1, 0, 0}, {900, 0, 0}});
  SiteOptions options;
  options.diff = saved("diff.vdb", before);
  const std::vector<SiteEpoch> epochs = {{saved("a.vdb", before), ""}, {saved("b.vdb", after), ""}};
  EXPECT_EQ(test::io_error_of([&] { write_site(folder_ / "site", epochs, options); }),
            "diff.vdb: is no diff: it lacks the grids that `vdbmap diff -o` writes");
  save_diff(folder_ / "diff.vdb", {.frame = after.frame,
                                   .label_scheme = LabelScheme::kUnknown,
                                   .counts = {},
                                   .appeared = {test::map_of_voxels({{900, 0, 0}}).finest(), {1.0f}},
                                   .vanished = {test::map_of_voxels({{2, 0, 0}}).finest(), {1.0f}},
                                   .changed = {VoxelLevel(0.1, {}, {}), {}},
                                   .unobserved = VoxelTree({})});
  const SiteWritten written = write_site(folder_ / "site", epochs, options);
  EXPECT_EQ(written.num_voxels, 6U) << "what vanished is no voxel of the later epoch";
  std::map<VoxelIndex, int> changes;
  const Points later = points_of_levels(folder_ / "site" / "tileset_2.json")[kEdge];
  for (const auto& [voxel, point] : later) {
    changes[voxel] = point.attributes[1];
  }
  EXPECT_EQ(changes, (std::map<VoxelIndex, int>{{{0, 0, 0}, 0}, {{1, 0, 0}, 0}, {{2, 0, 0}, 2}, {{900, 0, 0}, 1}}));
  const Points earlier = points_of_levels(folder_ / "site" / "tileset_1.json")[kEdge];
  for (const auto& [voxel, point] : earlier) {
    EXPECT_EQ(point.attributes[1], 0);
  }
  EXPECT_EQ(nlohmann::json::parse(test::read_raw(folder_ / "site" / "site.json"))["attributes"]["change"], true);
}

TEST_F(SiteTest, SpacesMayHaveMoreEpochsThanMaps) {
  const std::filesystem::path map = saved("map.vdb", street());
  const auto file = [&](const std::string& name, const std::string& state, const std::string& date) {
    std::ofstream(folder_ / name)
        << R"({"type": "FeatureCollection", "crs": {"properties": {"name": "EPSG:25832"}}, "features": [{"type": "Feature",
               "geometry": {"type": "Polygon", "coordinates": [[[548864, 5804032], [548869, 5804032], [548869, 5804034]]]},
               "properties": {"id": "1", "state": ")"
        << state << R"(", "date": ")" << date << "\"}}]}";
    return folder_ / name;
  };
  SiteOptions options;
  options.spaces = {file("a.geojson", "occupied", "2023-03-01"), file("b.geojson", "vacant", "2023-09-01")};
  EXPECT_EQ(write_site(folder_ / "site", {{map, "map"}}, options).num_spaces, 1U);
  nlohmann::json json = nlohmann::json::parse(test::read_raw(folder_ / "site" / "site.json"));
  ASSERT_EQ(json["epochs"].size(), 2U);
  EXPECT_EQ(json["epochs"][0]["tileset"], json["epochs"][1]["tileset"]);
  EXPECT_EQ(json["epochs"][1]["date"], "2023-09-01");
  EXPECT_EQ(json["spaces"], "spaces.json");
  const nlohmann::json bounds = json["bounds"];
  json = nlohmann::json::parse(test::read_raw(folder_ / "site" / "spaces.json"));
  EXPECT_EQ(json["spaces"][0]["states"][1]["state"], "vacant");
  EXPECT_EQ(json["spaces"][0]["polygon"][0][2], bounds["min"][2]) << "the lowest of the map";
  options.epoch_names = {"one"};
  EXPECT_THROW(write_site(folder_ / "site", {{map, "map"}}, options), std::invalid_argument);
}

// --- programs of others that read 3D Tiles: npm ci in tests/exchange installs them

class TilesetTools : public SiteTest {
 protected:
  void SetUp() override {
    const bool is_installed = std::filesystem::exists(kExchange + "node_modules/3d-tiles-tools") &&
                              test::run_command("/usr/bin/env", {"node", "--version"}).exit_code == 0;
    if (!is_installed) GTEST_SKIP() << "3d-tiles-tools is not installed (npm ci in tests/exchange)";
  }

  void expect_read(const std::filesystem::path& site) const {
    const test::CommandResult result = test::run_command(
        "/usr/bin/env",
        {"node", kExchange + "tileset_check.mjs", kExchange + "node_modules", site.string(), "tileset_1.json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const nlohmann::json read = nlohmann::json::parse(result.out);
    EXPECT_EQ(read["tiles"], written_.num_tiles);
    std::size_t num_points = 0;
    for (const auto& [voxel_size, points] : points_of_levels(site / "tileset_1.json")) num_points += points.size();
    EXPECT_EQ(read["points"], num_points);
  }

  const std::string kExchange = VDBMAP_SOURCE_DIR "/tests/exchange/";
};

TEST_F(TilesetTools, FindNothingWrongInASite) { expect_read(write("site", {saved("map.vdb", street())})); }

TEST_F(TilesetTools, FindNothingWrongInOneOfManyTilesWithoutColours) {
  PointCloud cloud;  // a point in each of 28 x 28 tiles: tilesets in tilesets
  for (int i = 0; i < 28 * 28; ++i) cloud.positions.emplace_back(16.0 * (i % 28) + 1, 16.0 * (i / 28) + 1, i % 7);
  const std::filesystem::path site = write("site", {saved("map.vdb", test::fine_map_of(cloud))});
  EXPECT_TRUE(std::filesystem::exists(site / "subtrees"));
  expect_read(site);
}

}  // namespace
}  // namespace vdbmap

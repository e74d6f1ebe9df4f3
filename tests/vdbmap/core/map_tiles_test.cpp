// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/map_tiles.h"

#include <algorithm>
#include <set>
#include <span>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/city_folders.h"
#include "tests/support/sample_maps.h"
#include "tests/support/threads.h"
#include "vdbmap/core/hierarchy.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/normals.h"

namespace vdbmap {
namespace {

std::vector<VoxelMap> cut_all(const VoxelMap& map) {
  std::vector<VoxelMap> tiles;
  for (const TileId& tile : tiles_of(map)) tiles.push_back(cut_tile(map, tile));
  return tiles;
}

TEST(TileId, BordersBelongToTheTileAbove) {
  EXPECT_EQ(tile_of_point({0, 0, 0}), (TileId{0, 0}));
  EXPECT_EQ(tile_of_point({-0.001, 63.999, 99}), (TileId{-1, 0}));
  EXPECT_EQ(tile_of_point({64, -64, 0}), (TileId{1, -1}));
  for (const double size : {0.05, 0.1, 0.5, 1.0, 8.0}) {
    const std::int32_t per_tile = voxels_per_tile(size);
    EXPECT_EQ(per_tile * size, kTileSize);
    EXPECT_EQ(tile_of_voxel({per_tile - 1, -1, 5}, per_tile), (TileId{0, -1}));
    EXPECT_EQ(tile_of_voxel({per_tile, -per_tile, 5}, per_tile), (TileId{1, -1}));
  }
}

TEST(MapTiles, AreThoseInWhichVoxelsLie) {
  std::set<TileId> expected;
  const VoxelLevel& finest = test::street_of_tiles().finest();
  for_each_voxel(finest, [&](const VoxelIndex& voxel, std::size_t) {
    expected.insert(tile_of_point(center_of_voxel(voxel, finest.voxel_size())));
  });
  const std::vector<TileId> tiles = tiles_of(test::street_of_tiles());
  EXPECT_EQ(tiles, std::vector<TileId>(expected.begin(), expected.end()));
  EXPECT_EQ(tiles.size(), 6U * 4U);
}

TEST(MapTiles, HoldTheVoxelsOfTheirColumnAsTheyAre) {
  const VoxelMap& map = test::street_of_tiles();
  const TileId tile{-1, 0};
  const VoxelMap part = cut_tile(map, tile);
  ASSERT_EQ(part.levels.size(), map.levels.size());
  for (std::size_t i = 0; i < map.levels.size(); ++i) {
    const VoxelLevel& level = map.levels[i];
    const VoxelFinder finder(part.levels[i]);
    std::size_t count = 0;
    for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
      if (tile_of_point(center_of_voxel(voxel, level.voxel_size())) != tile) return;
      ++count;
      const VoxelRecord* record = finder.find(voxel);
      ASSERT_NE(record, nullptr);
      EXPECT_EQ(*record, level.records()[number]);
      const auto in_part = static_cast<std::size_t>(record - part.levels[i].records().data());
      EXPECT_EQ(part.levels[i].channels().intensities[in_part], level.channels().intensities[number]);
    });
    EXPECT_GT(count, 0U);
    EXPECT_EQ(part.levels[i].size(), count);
  }
}

TEST(MapTiles, AreCutOneByOneAsAllAtOnce) {
  const VoxelMap& map = test::street_of_tiles();
  std::vector<TileId> tiles;
  for_each_tile(map, [&](const TileId& tile, const VoxelMap& part) {
    tiles.push_back(tile);
    EXPECT_EQ(test::difference(part, cut_tile(map, tile)), "");
  });
  EXPECT_EQ(tiles, tiles_of(map));
}

TEST(MapTiles, AMarginTakesTheLeavesThatReachIntoIt) {
  const VoxelMap& map = test::street_of_tiles();
  const TileId tile{-1, 0};
  const VoxelMap part = cut_tile(map, tile, 1.0);
  std::size_t count = 0;  // of 10 cm: 1 m are begun in the second leaf of 0.8 m, which is taken whole
  for_each_voxel(map.finest(), [&](const VoxelIndex& voxel, std::size_t) {
    count += voxel.x() >= -640 - 16 && voxel.x() < 16 && voxel.y() >= -16 && voxel.y() < 640 + 16 ? 1 : 0;
  });
  EXPECT_GT(count, cut_tile(map, tile).finest().size());
  EXPECT_EQ(part.finest().size(), count);
}

// What the margin is for: a tile is made of its own voxels and those of the margin alone.
TEST(MapTiles, ATileWithItsMarginHasTheNormalsAndLevelsOfTheWholeMap) {
  const VoxelMap& map = test::street_of_tiles();
  const std::vector<double> voxel_sizes = {0.1, 1, 8};
  for (const TileId& tile : tiles_of(map)) {
    VoxelMap part = cut_tile(map, tile, neighbor_margin(voxel_sizes));
    for (VoxelRecord& record : part.levels.front().records()) {
      record.normal_code = 0;
      record.planarity_code = 0;
    }
    part.levels.erase(part.levels.begin() + 1, part.levels.end());
    compute_normals(part.levels.front());
    add_coarser_levels(part, voxel_sizes);
    EXPECT_EQ(test::difference(cut_tile(part, tile), cut_tile(map, tile)), "");
  }
}

TEST(MapTiles, GiveTheMapAgainInWhateverOrderTheyCome) {
  const VoxelMap& map = test::street_of_tiles();
  std::vector<VoxelMap> tiles = cut_all(map);
  EXPECT_EQ(test::difference(splice(tiles), map), "");
  std::ranges::reverse(tiles);
  std::rotate(tiles.begin(), tiles.begin() + 5, tiles.end());
  for (const int threads : {1, 4}) {
    EXPECT_EQ(test::difference(test::on_threads(threads, [&] { return splice(tiles); }), map), "") << threads;
  }
}

TEST(MapTiles, ATileWithoutVoxelsChangesNothing) {
  const VoxelMap& map = test::street_of_tiles();
  const std::vector<VoxelMap> maps{cut_tile(map, {99, 99}), map};
  EXPECT_EQ(maps.front().finest().size(), 0U);
  EXPECT_EQ(test::difference(splice(maps), map), "");
}

TEST(MapTiles, WhatDoesNotBelongTogetherIsNotSpliced) {
  const VoxelMap& map = test::street_of_tiles();
  const VoxelMap tile = cut_tile(map, {0, 0});
  const auto with_tile = [&](const auto& change) {
    std::vector<VoxelMap> maps{tile, cut_tile(map, {1, 0})};
    change(maps.back());
    return maps;
  };
  EXPECT_NO_THROW(splice(with_tile([](VoxelMap&) {})));
  EXPECT_THROW(splice({}), std::invalid_argument);
  EXPECT_THROW(splice(std::vector{tile, tile}), std::invalid_argument);
  EXPECT_THROW(splice(with_tile([](VoxelMap& other) { other.frame.epsg = 25832; })), std::invalid_argument);
  EXPECT_THROW(splice(with_tile([](VoxelMap& other) { other.frame.anchor.x() += 64; })), std::invalid_argument);
  EXPECT_THROW(splice(with_tile([](VoxelMap& other) { other.levels.pop_back(); })), std::invalid_argument);
  EXPECT_THROW(splice(with_tile([](VoxelMap& other) { other.has_color = true; })), std::invalid_argument);
  // Also behind a map that has no voxels, and so no attributes of its own.
  for (const TileId& first : {TileId{99, 99}, TileId{2, 0}}) {
    std::vector<VoxelMap> maps{cut_tile(map, first), tile, cut_tile(map, {1, 0})};
    for (VoxelLevel& level : maps.back().levels) {
      VoxelChannels channels = level.channels();
      channels.intensities.clear();
      const std::span<const VoxelLeaf> leaves = level.leaves();
      const std::span<const VoxelRecord> records = std::as_const(level).records();
      level =
          VoxelLevel(level.voxel_size(), {leaves.begin(), leaves.end()}, {records.begin(), records.end()}, channels);
    }
    EXPECT_THROW(splice(maps), std::invalid_argument);
  }
}

}  // namespace
}  // namespace vdbmap

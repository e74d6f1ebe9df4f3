// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/tileset.h"

#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/sample_maps.h"
#include "tests/support/tileset_tiles.h"

namespace vdbmap {
namespace {

const SiteGrid kGrid = site_grid(0.1);

// Full tiles, `side` by `side` of the finest level from (x, y) on, and those above them up to `num_levels`.
TileFiles tiles_from(std::int32_t x, std::int32_t y, std::int32_t side, std::int32_t num_levels) {
  TileFiles files;
  for (std::int32_t i = 0; i < side * side; ++i) {
    QuadTile tile{0, x + i % side, y + i / side};
    for (; tile.level < num_levels; tile = parent_of_tile(tile)) {
      const VoxelIndex low(tile.x * kGrid.side, tile.y * kGrid.side, 500 >> tile.level);
      files[tile] = {
          tile, {low, low.offsetBy(kGrid.side - 1, kGrid.side - 1, 100 >> tile.level)}, name_of(tile) + ".glb"};
    }
  }
  return files;
}

class Tileset : public testing::Test {
 protected:
  std::vector<test::TilesetTile> tiles_of(const TileFiles& files) {
    const SitePlacement placement({test::kUtm, 25832}, 43);
    json_files_ = tileset_of(files, kGrid, placement, "7");
    for (const TilesetFile& file : json_files_) {
      std::filesystem::create_directories((folder_ / file.name).parent_path());
      std::ofstream(folder_ / file.name) << file.json;
    }
    return test::tiles_of_tileset(folder_ / json_files_.front().name);
  }

  test::TemporaryFolder folder_;
  std::vector<TilesetFile> json_files_;
};

void expect_tiles(const std::vector<test::TilesetTile>& tiles, const TileFiles& files,
                  const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const test::TilesetTile& tile : tiles) {
    EXPECT_EQ(std::filesystem::relative(std::filesystem::weakly_canonical(tile.content).parent_path(),
                                        std::filesystem::weakly_canonical(folder)),
              "tiles");
    names.insert(tile.content.filename());
  }
  EXPECT_EQ(names.size(), tiles.size());
  std::set<std::string> expected;
  for (const auto& [tile, file] : files) expected.insert(file.name);
  EXPECT_EQ(names, expected);
}

void expect_nested(const std::vector<test::TilesetTile>& tiles) {
  for (const test::TilesetTile& tile : tiles) {
    if (!tile.parent) continue;
    const test::TilesetTile& parent = tiles[*tile.parent];
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d world =
          tile.world_from_tile * tile.box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
      EXPECT_LT(parent.box.exteriorDistance(parent.world_from_tile.inverse() * world), 1e-6) << tile.content;
    }
  }
}

TEST_F(Tileset, OfFewTilesIsOneFile) {
  const TileFiles files = tiles_from(3, -9, 9, 6);
  const auto tiles = tiles_of(files);
  ASSERT_EQ(json_files_.size(), 1U);
  EXPECT_EQ(json_files_.front().name, "tileset_7.json");
  expect_tiles(tiles, files, folder_.path());
  expect_nested(tiles);
}

TEST_F(Tileset, OfManyTilesHasAFileForEach64Metres) {
  const TileFiles files = tiles_from(-64, 0, 64, 8);
  const auto tiles = tiles_of(files);
  EXPECT_EQ(json_files_.size(), 1U + 16 * 16);
  EXPECT_EQ(json_files_.back().name.substr(0, 13), "subtrees/7/2_");
  std::size_t all = 0;
  for (const TilesetFile& file : json_files_) all += file.json.size();
  EXPECT_LT(json_files_.front().json.size(), all / 10) << "what is read first is the smaller part";
  expect_tiles(tiles, files, folder_.path());
  expect_nested(tiles);
}

TEST_F(Tileset, TilesOnAllSidesOfTheOriginHaveARootWithoutAFile) {
  const TileFiles files = tiles_from(-1, -1, 2, 3);
  const auto tiles = tiles_of(files);
  std::size_t num_without_parent = 0;
  for (const test::TilesetTile& tile : tiles) num_without_parent += tile.parent ? 0 : 1;
  EXPECT_EQ(num_without_parent, 4U);
  expect_tiles(tiles, files, folder_.path());
}

TEST(SiteGrid, TilesAreWholeLeavesThatBytesCanAddress) {
  for (const double size : {0.02, 0.04, 0.05, 0.1, 0.2, 0.25, 0.5, 1.0, 2.0, 8.0}) {
    const SiteGrid grid = site_grid(size);
    EXPECT_EQ(grid.side % 8, 0) << size;
    EXPECT_LE(grid.side, 256) << size;
    const double per_tile = 64 / grid.edge(0);
    EXPECT_NEAR(per_tile, std::round(per_tile), 1e-9) << size;
    EXPECT_GE(grid.edge(grid.block_level), 256 - 1e-6) << size;
  }
  EXPECT_EQ(kGrid.side, 160);
  EXPECT_EQ(kGrid.block_level, 4);
}

}  // namespace
}  // namespace vdbmap

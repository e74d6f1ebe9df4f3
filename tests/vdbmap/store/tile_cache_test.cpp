// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/tile_cache.h"

#include <filesystem>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/city_folders.h"
#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "vdbmap/store/city_of_map.h"
#include "vdbmap/store/city_writer.h"

namespace vdbmap {
namespace {

class TileCacheTest : public testing::Test {
 protected:
  TileCacheTest() : manifest_(save_city(path(), test::street_of_tiles())) {}

  std::filesystem::path path() const { return folder_ / "city"; }
  TileCache cache() const { return {path(), "result"}; }
  const CityTile& tile(std::size_t number) const { return manifest_.tiles.at(number); }
  std::filesystem::path file(const CityTile& tile) const {
    return path() / "cache" / (tile_name(tile.id) + "." + tile.hash + ".result");
  }

  test::TemporaryFolder folder_;
  CityManifest manifest_;
};

using TileCacheOfCity = TileCacheTest;

TEST_F(TileCacheOfCity, GivesBackWhatWasKeptUnderTheSameKey) {
  EXPECT_EQ(cache().read(tile(0), 7), std::nullopt);
  const std::string bytes("a\0b", 3);
  cache().write(tile(0), 7, bytes);
  EXPECT_EQ(cache().read(tile(0), 7), bytes);
  EXPECT_EQ(cache().read(tile(0), 8), std::nullopt);
  EXPECT_EQ(cache().read(tile(1), 7), std::nullopt);
  EXPECT_EQ((TileCache{path(), "other"}.read(tile(0), 7)), std::nullopt);
  cache().write(tile(0), 8, "");
  EXPECT_EQ(cache().read(tile(0), 7), std::nullopt);
  EXPECT_EQ(cache().read(tile(0), 8), "");
}

TEST_F(TileCacheOfCity, DamageIsAsIfNothingWereKept) {
  cache().write(tile(0), 7, "what was computed");
  const std::string whole = test::read_raw(file(tile(0)));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    test::write_raw(file(tile(0)), whole.substr(0, size));
    EXPECT_EQ(cache().read(tile(0), 7), std::nullopt) << size;
    std::string changed = whole;
    changed[size] = static_cast<char>(changed[size] ^ 4);
    test::write_raw(file(tile(0)), changed);
    EXPECT_EQ(cache().read(tile(0), 7), std::nullopt) << size;
  }
}

TEST_F(TileCacheOfCity, WhereNothingCanBeWrittenNothingIsKept) {
  test::write_raw(path() / "cache", "no folder");
  EXPECT_NO_THROW(cache().write(tile(0), 7, "x"));
  EXPECT_EQ(cache().read(tile(0), 7), std::nullopt);
}

TEST_F(TileCacheOfCity, WritersRemoveWhatIsOfTilesThatAreGone) {
  cache().write(tile(0), 7, "x");
  cache().write(tile(1), 7, "y");
  {
    CityWriter writer(path());
    CityManifest manifest = writer.current()->manifest;
    manifest.tiles.erase(manifest.tiles.begin());
    writer.publish(manifest, 1);
  }
  EXPECT_FALSE(std::filesystem::exists(file(tile(0))));
  EXPECT_EQ(cache().read(tile(1), 7), "y");
}

TEST_F(TileCacheOfCity, NeighborhoodsAreOtherOnesWhereOneOfNineTilesIs) {
  const CityTile& middle = tile(manifest_.tiles.size() / 2);
  const auto hash = neighborhood_hash(manifest_, manifest_.tiles, middle);
  ASSERT_TRUE(hash);
  for (std::size_t i = 0; i < manifest_.tiles.size(); ++i) {
    CityManifest other = manifest_;
    other.tiles[i].hash = "0123456789abcdef0123";
    const TileId& id = tile(i).id;
    const bool is_near = std::abs(id.x - middle.id.x) <= 1 && std::abs(id.y - middle.id.y) <= 1;
    EXPECT_EQ(neighborhood_hash(other, other.tiles, middle) != hash, is_near);
    other.tiles.erase(other.tiles.begin() + static_cast<std::ptrdiff_t>(i));
    if (tile(i).id == middle.id) continue;
    EXPECT_EQ(neighborhood_hash(other, other.tiles, middle) != hash, is_near);
    // In the city, but not among those that are looked at.
    EXPECT_EQ(neighborhood_hash(manifest_, other.tiles, middle).has_value(), !is_near);
  }
}

}  // namespace
}  // namespace vdbmap

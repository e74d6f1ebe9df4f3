// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/coarse/map_parts.h"

#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "tests/support/threads.h"

namespace vdbmap::registration {
namespace {

constexpr int kSide = 7;      // tiles
constexpr int kPerTile = 20;  // features
constexpr int kLow = -3;      // number of the first tile on either axis
constexpr int kNearest = 3;   // features matched with each of the scan
constexpr int kScan = 90;     // features of the scan

FpfhMatrix features_at_random(Eigen::Index count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> number(0, 1);
  return FpfhMatrix::NullaryExpr(kFpfhBins, count, [&] { return number(random); });
}

// A square of tiles of random features; some tiles of the middle have none, some fewer than are matched.
struct Square {
  SurfacePoints points;
  FpfhMatrix features = features_at_random(kSide * kSide * kPerTile, 5);
  FpfhMatrix scan = features_at_random(kScan, 6);
  std::vector<std::uint32_t> chosen;       // all but a few
  std::vector<std::uint32_t> scan_chosen;  // every other, in falling order

  Square() {
    for (int i = 0; i < kSide * kSide * kPerTile; ++i) {
      const int tile = i / kPerTile;
      const Eigen::Vector3d corner(kLow + tile % kSide, kLow + tile / kSide, 0);
      points.positions.emplace_back(kTileSize * (corner + Eigen::Vector3d(0.5, 0.01 * (i % kPerTile), 0)));
      if (tile % 10 != 3 && (tile % 10 != 5 || i % kPerTile < 2)) chosen.push_back(static_cast<std::uint32_t>(i));
    }
    for (int i = kScan; i > 0; i -= 2) scan_chosen.push_back(static_cast<std::uint32_t>(i - 1));
  }
};

const Square& square() {
  static const Square square;
  return square;
}

std::vector<std::uint32_t> features_of(const MapPart& part, const std::vector<TileFeatures>& tiles) {
  std::vector<std::uint32_t> numbers;
  for (const std::size_t tile : part)
    numbers.insert(numbers.end(), tiles[tile].numbers.begin(), tiles[tile].numbers.end());
  return numbers;
}

TEST(MapParts, GroupsFeaturesByTheTilesOfTheirPoints) {
  std::vector<std::uint32_t> shuffled = square().chosen;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(1));
  std::set<std::uint32_t> grouped;
  for (const TileFeatures& tile : group_by_tile(square().points, shuffled)) {
    EXPECT_TRUE(std::ranges::is_sorted(tile.numbers));
    for (const std::uint32_t number : tile.numbers) {
      const int expected = static_cast<int>(number) / kPerTile;
      EXPECT_EQ(tile.tile, (TileId{kLow + expected % kSide, kLow + expected / kSide}));
      grouped.insert(number);
    }
  }
  EXPECT_EQ(grouped, std::set(shuffled.begin(), shuffled.end()));
}

// Whatever its tile: with all of the eight around it that there are.
TEST(MapParts, EachTileHasItsNeighboursInOneOfThem) {
  const std::vector<TileFeatures> tiles = group_by_tile(square().points, square().chosen);
  const std::vector<MapPart> parts = overlapping_parts(tiles);
  for (const TileFeatures& tile : tiles) {
    MapPart around;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      const bool is_near = std::abs(tiles[i].tile.x - tile.tile.x) <= 1 && std::abs(tiles[i].tile.y - tile.tile.y) <= 1;
      if (is_near) around.push_back(i);
    }
    EXPECT_TRUE(std::ranges::any_of(parts, [&](const MapPart& part) { return std::ranges::includes(part, around); }))
        << tile.tile.x << " " << tile.tile.y;
  }
}

TEST(MapParts, NoneIsMoreThan256MetresLongNorWithinAnother) {
  const std::vector<TileFeatures> tiles = group_by_tile(square().points, square().chosen);
  const std::vector<MapPart> parts = overlapping_parts(tiles);
  for (const MapPart& part : parts) {
    for (const std::size_t tile : part) EXPECT_LT(tiles[tile].tile.x - tiles[part.front()].tile.x, 4);
    const auto holds_it = [&](const MapPart& other) { return std::ranges::includes(other, part); };
    EXPECT_EQ(std::ranges::count_if(parts, holds_it), 1);
  }
}

TEST(MapParts, HaveTheMatchesOfTheirFeaturesAsOne) {
  const std::vector<TileFeatures> tiles = group_by_tile(square().points, square().chosen);
  const Square& map = square();
  const auto match = [&] { return TileMatches(map.scan, map.scan_chosen, map.features, tiles, kNearest); };
  const TileMatches one = test::on_threads(1, match), four = test::on_threads(4, match);
  for (const MapPart& part : overlapping_parts(tiles)) {
    const std::vector<FeatureMatch> expected =
        match_features(map.scan, map.scan_chosen, map.features, features_of(part, tiles), kNearest);
    for (const TileMatches* matches : {&one, &four}) {
      const std::vector<FeatureMatch> found = matches->of_part(part);
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].source, expected[i].source);
        EXPECT_EQ(found[i].target, expected[i].target);
        EXPECT_NEAR(found[i].distance, expected[i].distance, 1e-5);  // products are added up in other orders
        EXPECT_EQ(found[i].mutual, expected[i].mutual);
      }
    }
  }
}

}  // namespace
}  // namespace vdbmap::registration

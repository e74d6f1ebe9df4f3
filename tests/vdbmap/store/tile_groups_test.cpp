// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/tile_groups.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/sample_maps.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/core/voxel_groups.h"

namespace vdbmap {
namespace {

// Voxels around the corner of four tiles, a part of those that are there with a grade.
struct GradedPlace {
  explicit GradedPlace(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0, 1);
    std::vector<VoxelIndex> voxels;
    const openvdb::CoordBBox box({-12, -12, 0}, {11, 11, 2});
    for (auto voxel = box.begin(); voxel; ++voxel) {
      if (share(random) < 0.5) voxels.push_back(*voxel);
    }
    map = test::map_of_voxels(voxels);
    for (std::size_t i = 0; i < map.finest().size(); ++i) {
      const double dice = share(random);
      grades.push_back(dice < 0.7 ? SeenGrade::kNot : dice < 0.85 ? SeenGrade::kLikely : SeenGrade::kSure);
    }
  }

  VoxelMap map;
  std::vector<SeenGrade> grades;
};

// By the groups of the level in one piece.
std::vector<std::uint8_t> seen_through_in_one_piece(const GradedPlace& place, const SeenThroughOptions& options) {
  std::vector<std::uint8_t> result(place.grades.size());
  for (const VoxelGroup& group : find_groups(place.map.finest(), are_graded(place.grades), 1)) {
    std::size_t num_sure = 0;
    for (const std::size_t i : group) num_sure += place.grades[i] == SeenGrade::kSure;
    const bool is_whole = static_cast<double>(num_sure) >= options.sure_part * static_cast<double>(group.size());
    for (const std::size_t i : group) result[i] = is_whole || place.grades[i] == SeenGrade::kSure;
  }
  return result;
}

// The values of a level's records that lie in a part of it.
template <typename Value>
std::vector<Value> in_part(const VoxelLevel& level, const VoxelLevel& part, const std::vector<Value>& values) {
  std::vector<Value> result;
  const VoxelFinder finder(level);
  for_each_voxel(part, [&](const VoxelIndex& voxel, std::size_t) {
    result.push_back(values[static_cast<std::size_t>(finder.find(voxel) - level.records().data())]);
  });
  return result;
}

TEST(TileGroups, AreThoseOfTheLevelInOnePieceInWhateverOrderTilesCome) {
  const SeenThroughOptions options;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const GradedPlace place(seed);
    const VoxelLevel& level = place.map.finest();
    std::vector<TileId> tiles = tiles_of(place.map);
    ASSERT_EQ(tiles.size(), 4U);
    if (seed % 2 == 1) std::ranges::reverse(tiles);
    TileGroups groups(options);
    for (const TileId& id : tiles) {
      const VoxelMap part = cut_tile(place.map, id);
      groups.add(id, part.finest(), in_part(level, part.finest(), place.grades));
    }
    const std::vector<std::uint8_t> expected = seen_through_in_one_piece(place, options);
    for (const TileId& id : tiles) {
      const VoxelMap part = cut_tile(place.map, id);
      EXPECT_EQ(groups.seen_through(id, part.finest().size()), in_part(level, part.finest(), expected)) << seed;
    }
  }
}

TEST(TileGroups, OfATileThatWasNotAddedNothingIsSeenThrough) {
  EXPECT_EQ(TileGroups({}).seen_through({3, 4}, 2), std::vector<std::uint8_t>(2));
}

}  // namespace
}  // namespace vdbmap

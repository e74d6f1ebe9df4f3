// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_level.h"

#include <algorithm>
#include <atomic>
#include <map>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"
#include "tests/support/synthetic_scene.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/voxel_assembly.h"

namespace vdbmap {
namespace {

// Voxels with numbers of their own, in the count, and the same in a map.
struct NumberedLevel {
  std::map<VoxelIndex, std::uint32_t> numbers;
  VoxelLevel level;
};

NumberedLevel numbered_level(std::vector<VoxelIndex> voxels) {
  std::sort(voxels.begin(), voxels.end(),
            [](const VoxelIndex& a, const VoxelIndex& b) { return key_of_voxel(a) < key_of_voxel(b); });
  std::map<VoxelIndex, std::uint32_t> numbers;
  VoxelAssembly assembly(0.1, voxels.size());
  for (const VoxelIndex& voxel : voxels) {
    VoxelRecord record;
    record.count = numbers[voxel] = static_cast<std::uint32_t>(numbers.size());
    EXPECT_TRUE(assembly.add(voxel, record));
  }
  return {std::move(numbers), assembly.finish()};
}

// A tenth of the cells of a few leaves on both sides of the axes: gaps, full rows and borders.
NumberedLevel dense_level() { return numbered_level(test::random_voxels(3000, -16, 15, 1)); }

// Voxels far from each other, over many root children.
NumberedLevel sparse_level() { return numbered_level(test::random_voxels(2000, -kIndexLimit, kIndexLimit - 1, 2)); }

TEST(VoxelFinder, FindsEveryVoxelAndNothingElse) {
  const NumberedLevel dense = dense_level();
  const VoxelFinder finder(dense.level);
  for (std::int32_t x = -18; x < 18; ++x) {
    for (std::int32_t y = -18; y < 18; ++y) {
      for (std::int32_t z = -18; z < 18; ++z) {
        const auto expected = dense.numbers.find({x, y, z});
        const VoxelRecord* record = finder.find({x, y, z});
        ASSERT_EQ(record != nullptr, expected != dense.numbers.end()) << VoxelIndex(x, y, z);
        if (record) {
          EXPECT_EQ(record->count, expected->second);
        }
      }
    }
  }
}

TEST(VoxelFinder, FindsVoxelsAllOverTheRange) {
  const NumberedLevel sparse = sparse_level();
  const VoxelFinder finder(sparse.level);
  for (const auto& [voxel, number] : sparse.numbers) {
    ASSERT_NE(finder.find(voxel), nullptr) << voxel;
    EXPECT_EQ(finder.find(voxel)->count, number);
    EXPECT_EQ(finder.find(voxel.offsetBy(1)) != nullptr, sparse.numbers.contains(voxel.offsetBy(1)));
  }
}

TEST(VoxelFinder, FindsNothingInAnEmptyLevel) {
  const NumberedLevel empty = numbered_level({});
  const VoxelFinder finder(empty.level);
  EXPECT_EQ(finder.find({0, 0, 0}), nullptr);
  finder.for_each_around({0, 0, 0}, 3, [](const VoxelIndex&, const VoxelRecord&) { FAIL(); });
}

class VoxelFinderReach : public testing::TestWithParam<std::int32_t> {};

TEST_P(VoxelFinderReach, MeetsEveryVoxelAroundOnceAndNoOthers) {
  const std::int32_t reach = GetParam();
  const NumberedLevel dense = dense_level();
  const VoxelFinder finder(dense.level);
  std::mt19937 random(3);
  std::uniform_int_distribution<std::int32_t> index(-19, 18);
  const int num_centers = reach > 8 ? 20 : 2000;
  for (int i = 0; i < num_centers; ++i) {
    const std::int32_t cx = index(random);
    const std::int32_t cy = index(random);
    const VoxelIndex center(cx, cy, index(random));
    std::map<VoxelIndex, std::uint32_t> expected;
    for (std::int32_t x = -reach; x <= reach; ++x) {
      for (std::int32_t y = -reach; y <= reach; ++y) {
        for (std::int32_t z = -reach; z <= reach; ++z) {
          const auto found = dense.numbers.find(center.offsetBy(x, y, z));
          if (found != dense.numbers.end()) expected.insert(*found);
        }
      }
    }
    std::map<VoxelIndex, std::uint32_t> met;
    finder.for_each_around(center, reach, [&](const VoxelIndex& voxel, const VoxelRecord& record) {
      EXPECT_TRUE(met.emplace(voxel, record.count).second) << "met twice: " << voxel;
    });
    ASSERT_EQ(met, expected) << center;
  }
}

INSTANTIATE_TEST_SUITE_P(Reaches, VoxelFinderReach, testing::Values(0, 1, 2, 3, 8, 21));

TEST(VoxelLevel, RanksAreTheNumberOfVoxelsBefore) {
  const NumberedLevel dense = dense_level();
  for (const VoxelLeaf& leaf : dense.level.leaves()) {
    std::uint32_t before = 0;
    for (openvdb::Index offset = 0; offset < VoxelLeaf::SIZE; ++offset) {
      EXPECT_EQ(rank_in_leaf(leaf, offset), before);
      before += leaf.isValueOn(offset) ? 1 : 0;
    }
  }
}

TEST(VoxelLevel, VoxelsAreWalkedInTheOrderOfTheRecords) {
  for (const NumberedLevel& numbered : {dense_level(), sparse_level()}) {
    std::size_t next = 0;
    for_each_voxel(numbered.level, [&](const VoxelIndex& voxel, std::size_t record) {
      EXPECT_EQ(record, next++);
      EXPECT_EQ(numbered.level.records()[record].count, numbered.numbers.at(voxel));
    });
    EXPECT_EQ(next, numbered.level.size());
  }
}

TEST(VoxelLevel, EveryVoxelIsWalkedOnceInParallel) {
  const NumberedLevel sparse = sparse_level();
  std::vector<std::atomic<int>> visits(sparse.level.size());
  parallel_for_each_voxel(sparse.level, [&](const VoxelIndex& voxel, std::size_t record) {
    if (sparse.level.records()[record].count == sparse.numbers.at(voxel)) ++visits[record];
  });
  EXPECT_TRUE(std::all_of(visits.begin(), visits.end(), [](const auto& count) { return count == 1; }));
}

TEST(VoxelLevel, VoxelsOutOfOrderAreNotAdded) {
  VoxelAssembly assembly(0.1, 3);
  EXPECT_TRUE(assembly.add({0, 0, 5}, {}));
  EXPECT_FALSE(assembly.add({0, 0, 5}, {}));
  EXPECT_FALSE(assembly.add({0, 0, 4}, {}));
  EXPECT_TRUE(assembly.add({0, 0, 6}, {}));
  EXPECT_EQ(assembly.finish().size(), 2U);
}

TEST(VoxelLevel, AStreetTakesLessThanAHundredBytesAVoxel) {
  const VoxelMap map = build_map(test::sample_scene(test::street(), 150, 4));
  ASSERT_GT(map.finest().size(), 100'000U);
  const double bytes = static_cast<double>(memory_bytes(map));
  EXPECT_LT(bytes / static_cast<double>(map.finest().size()), 100);  // both levels, everything included
  EXPECT_GT(map.finest().memory_bytes(), map.finest().size() * sizeof(VoxelRecord));
}

// As from the air: 4 m apart, each with a leaf of its own, and mostly with a block of 128 voxels of its own.
TEST(VoxelLevel, ScatteredPointsTakeLessThanThreeHundredBytesEach) {
  PointCloud cloud;
  std::mt19937 random(6);
  std::uniform_real_distribution<double> height(0, 80);
  for (int x = 0; x < 100; ++x) {
    for (int y = 0; y < 100; ++y) cloud.positions.emplace_back(4.0 * x, 4.0 * y, height(random));
  }
  const VoxelMap map = build_map(cloud);
  ASSERT_GT(map.finest().leaves().size(), 9'990U);
  ASSERT_EQ(map.levels.size(), 2U);
  EXPECT_LT(memory_bytes(map) / cloud.size(), 300U);  // both levels, everything included
}

TEST(VoxelLevel, MemoryCountsChannels) {
  PointCloud cloud = test::random_cloud(10'000, {Eigen::Vector3d::Zero(), Eigen::Vector3d(3, 3, 3)}, 5);
  BuildOptions options;
  options.voxel_sizes = {0.1};
  options.epoch = 1;
  const VoxelMap with_channels = build_map(cloud, options);
  cloud.intensities.clear();
  options.epoch.reset();
  const VoxelMap without = build_map(cloud, options);
  EXPECT_EQ(memory_bytes(with_channels) - memory_bytes(without), 12 * without.finest().size());
}

}  // namespace
}  // namespace vdbmap

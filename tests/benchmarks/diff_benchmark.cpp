// SPDX-License-Identifier: GPL-3.0-or-later
// How long two maps of ten million voxels take to be compared, from memory: two surveys of wavy ground with blocks on
// it, noise of 1 cm, of which a part of the blocks is gone in the second.
#include <cmath>
#include <random>

#include <benchmark/benchmark.h>

#include "vdbmap/change/change_regions.h"
#include "vdbmap/change/map_diff.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap {
namespace {

constexpr double kVoxelSize = 0.1;  // [m]
constexpr int kSide = 2750;         // [voxels] of the ground
constexpr int kBlock = 20;          // [voxels] blocks stand so long and so high
constexpr int kBetweenBlocks = 55;  // [voxels]
constexpr int kPointsAVoxel = 4;
constexpr int kGoneOf = 7;  // every seventh block is gone on the second day

struct Day {
  VoxelMap map;
  Visibility visibility;
};

bool is_block(int x, int y) { return x % kBetweenBlocks < kBlock && y % kBetweenBlocks < kBlock; }

bool is_gone(int x, int y, bool is_second) {
  return is_second && (x / kBetweenBlocks + 3 * (y / kBetweenBlocks)) % kGoneOf == 0;
}

double ground_height(double x, double y) { return 0.4 * std::sin(0.05 * x) + 0.3 * std::cos(0.07 * y); }

// Points of a column of the scene: the ground, or the top and the sides of a block.
void add_column(PointCloud& cloud, int x, int y, bool is_second, std::mt19937& random) {
  std::normal_distribution<double> noise(0, 0.01);
  std::uniform_real_distribution<double> share(0, 1);
  const bool has_block = is_block(x, y) && !is_gone(x, y, is_second);
  const auto add = [&](double height) {
    for (int i = 0; i < kPointsAVoxel; ++i) {
      const double px = (x + share(random)) * kVoxelSize, py = (y + share(random)) * kVoxelSize;
      cloud.positions.emplace_back(px, py, ground_height(px, py) + height + noise(random));
    }
  };
  add(has_block ? kBlock * kVoxelSize : 0);
  const int in_x = x % kBetweenBlocks, in_y = y % kBetweenBlocks;
  const bool is_side = has_block && (in_x == 0 || in_y == 0 || in_x == kBlock - 1 || in_y == kBlock - 1);
  for (int z = 0; is_side && z < kBlock; ++z) add((z + 0.5) * kVoxelSize);
}

// The air above the ground is seen as empty, and what stands under no block.
Visibility sky_over(const VoxelMap& map) {
  const VoxelLevel& level = map.finest();
  Visibility visibility;
  visibility.voxel_size = level.voxel_size();
  visibility.hits.resize(level.size(), kPointsAVoxel);
  visibility.passes.resize(level.size(), 0);
  LargeVector<VoxelLeaf> leaves;
  for (const VoxelLeaf& leaf : level.leaves()) {
    leaves.emplace_back(leaf.origin(), true);
    leaves.back().setValueMask(!leaf.getValueMask());
  }
  visibility.seen_empty = VoxelTree(std::move(leaves));
  return visibility;
}

Day make_day(bool is_second) {
  std::mt19937 random(is_second ? 2 : 1);
  BuildOptions options;
  options.voxel_sizes = {kVoxelSize};
  options.anchor = Eigen::Vector3d::Zero();
  MapBuilder builder(options);
  for (int x = 0; x < kSide; ++x) {
    PointCloud row;
    for (int y = 0; y < kSide; ++y) add_column(row, x, y, is_second, random);
    builder.add(row);
  }
  Day day{builder.finish(), {}};
  day.visibility = sky_over(day.map);
  return day;
}

const Day& day(bool is_second) {
  static const Day first = make_day(false), second = make_day(true);
  return is_second ? second : first;
}

void BM_MapDiff(benchmark::State& state) {
  const Day &first = day(false), &second = day(true);
  const ThreadLimit limit(static_cast<std::size_t>(state.range(0)));
  ChangeCounts counts;
  for ([[maybe_unused]] auto _ : state) {
    const MapDiff diff = map_diff({first.map, &first.visibility}, {second.map, &second.visibility});
    counts = diff.counts;
  }
  state.counters["voxels_earlier"] = static_cast<double>(first.map.finest().size());
  state.counters["voxels_later"] = static_cast<double>(second.map.finest().size());
  state.counters["vanished"] = static_cast<double>(counts.vanished);
  state.counters["changed"] = static_cast<double>(counts.changed);
  state.counters["unobserved"] = static_cast<double>(counts.unobserved);
}
BENCHMARK(BM_MapDiff)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

// The same map moved by 3 cm: no voxel is evidently the same.
void BM_MapDiffOfAShiftedMap(benchmark::State& state) {
  const Day& first = day(false);
  DiffOptions options;
  options.earlier_from_later = Eigen::Translation3d(0.02, 0.01, 0.02);
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(map_diff({first.map, &first.visibility}, {first.map, &first.visibility}, options));
  }
}
BENCHMARK(BM_MapDiffOfAShiftedMap)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace vdbmap

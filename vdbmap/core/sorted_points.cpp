// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/sorted_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>

#include "vdbmap/core/parallel.h"
#include "vdbmap/core/point_cell.h"
#include "vdbmap/core/srgb.h"

namespace vdbmap {
namespace {

constexpr std::size_t kRangeSize = 1 << 14;  // points that one task numbers and scatters

// Number of a block within a range, which has no more blocks than points.
using BlockInRange = std::uint16_t;
constexpr BlockInRange kNowhere = 0xffff;  // of a point that is not addressable
static_assert(kRangeSize < kNowhere);

// Where the points of one range go: its blocks in order of appearance, and how many points each gets.
struct RangeBlocks {
  std::vector<BlockKey> blocks;
  std::vector<std::uint32_t> counts;
  std::vector<std::uint32_t> targets;      // place of each block's first point in the sorted array
  std::vector<std::uint32_t> unreachable;  // points of the range that are not addressable
};

KeyedPoint keyed_point(const PointCell& cell, std::uint32_t source) {
  KeyedPoint point{key_in_block(cell.voxel), source, {}};
  for (int axis = 0; axis < 3; ++axis) {
    const auto quantum = std::min(static_cast<std::int32_t>(cell.share[axis] * kQuantaPerVoxel), 65535);
    point.quantum[axis] = static_cast<std::int16_t>(quantum - 32768);
  }
  return point;
}

// Numbers the blocks of one range; `block_in_range` receives the number of each point's block, or kNowhere.
RangeBlocks number_blocks(std::span<const Eigen::Vector3d> points, const CellFinder& cells,
                          BlockInRange* block_in_range) {
  RangeBlocks range;
  std::unordered_map<std::uint64_t, std::uint32_t> numbers;
  auto last_block = BlockKey{~std::uint64_t{0}};
  std::uint32_t last_number = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::optional<PointCell> cell = cells.find(points[i]);
    if (!cell) {
      block_in_range[i] = kNowhere;
      range.unreachable.push_back(static_cast<std::uint32_t>(i));
      continue;
    }
    const BlockKey block = block_of_voxel(cell->voxel);
    if (block != last_block) {
      last_block = block;
      const auto next = static_cast<std::uint32_t>(range.blocks.size());
      const auto [entry, is_new] = numbers.try_emplace(static_cast<std::uint64_t>(block), next);
      last_number = entry->second;
      if (is_new) {
        range.blocks.push_back(block);
        range.counts.push_back(0);
      }
    }
    ++range.counts[last_number];
    block_in_range[i] = static_cast<BlockInRange>(last_number);
  }
  return range;
}

// Blocks of all ranges, sorted, with the places of their points.
struct BlockLayout {
  std::vector<BlockKey> blocks;
  std::vector<std::size_t> first_point;  // one more than blocks
};

BlockLayout lay_out_blocks(std::vector<RangeBlocks>& ranges) {
  BlockLayout layout;
  for (const RangeBlocks& range : ranges) {
    layout.blocks.insert(layout.blocks.end(), range.blocks.begin(), range.blocks.end());
  }
  std::sort(layout.blocks.begin(), layout.blocks.end());
  layout.blocks.erase(std::unique(layout.blocks.begin(), layout.blocks.end()), layout.blocks.end());

  std::vector<std::size_t> counts(layout.blocks.size() + 1, 0);
  for (RangeBlocks& range : ranges) {
    range.targets.resize(range.blocks.size());
    for (std::size_t i = 0; i < range.blocks.size(); ++i) {
      const auto place = std::lower_bound(layout.blocks.begin(), layout.blocks.end(), range.blocks[i]);
      const auto number = static_cast<std::size_t>(place - layout.blocks.begin());
      range.targets[i] = static_cast<std::uint32_t>(counts[number]);  // within the block, for now
      counts[number] += range.counts[i];
    }
  }

  layout.first_point.assign(1, 0);
  for (std::size_t i = 0; i < layout.blocks.size(); ++i) {
    layout.first_point.push_back(layout.first_point.back() + counts[i]);
  }
  for (RangeBlocks& range : ranges) {
    for (std::size_t i = 0; i < range.blocks.size(); ++i) {
      const auto place = std::lower_bound(layout.blocks.begin(), layout.blocks.end(), range.blocks[i]);
      range.targets[i] += static_cast<std::uint32_t>(layout.first_point[place - layout.blocks.begin()]);
    }
  }
  return layout;
}

// Stable counting sort by `bits` bits of the key from `shift`.
void sort_by_digit(std::span<const KeyedPoint> from, KeyedPoint* to, int shift, int bits) {
  std::array<std::uint32_t, 1 << 11> place{};
  const std::uint32_t mask = (1u << bits) - 1;
  for (const KeyedPoint& point : from) ++place[point.key >> shift & mask];
  std::uint32_t sum = 0;
  for (std::uint32_t& entry : place) sum += std::exchange(entry, sum);
  for (const KeyedPoint& point : from) to[place[point.key >> shift & mask]++] = point;
}

// `scratch` grows where it has less room.
void sort_by_key(std::span<KeyedPoint> points, LargeVector<KeyedPoint>& scratch) {
  constexpr std::size_t kFewPoints = 512;
  if (points.size() < kFewPoints) {
    std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
    return;
  }
  if (scratch.size() < points.size()) scratch.resize(points.size());
  sort_by_digit(points, scratch.data(), 0, 11);
  sort_by_digit({scratch.data(), points.size()}, points.data(), 11, 10);
}

std::size_t count_voxels(std::span<const KeyedPoint> points) {
  std::size_t count = points.empty() ? 0 : 1;
  for (std::size_t i = 1; i < points.size(); ++i) count += points[i].key != points[i - 1].key ? 1 : 0;
  return count;
}

void add_point(VoxelSums& sums, const KeyedPoint& point) {
  const std::int64_t x = point.quantum[0];
  const std::int64_t y = point.quantum[1];
  const std::int64_t z = point.quantum[2];
  sums.position[0] += x;
  sums.position[1] += y;
  sums.position[2] += z;
  sums.product[0] += x * x;
  sums.product[1] += y * y;
  sums.product[2] += z * z;
  sums.product[3] += x * y;
  sums.product[4] += x * z;
  sums.product[5] += y * z;
}

void add_color(VoxelSums& sums, const Rgb16& color, std::span<const std::uint16_t> linear) {
  sums.color[0] += linear[color.r];
  sums.color[1] += linear[color.g];
  sums.color[2] += linear[color.b];
}

}  // namespace

SortedPoints::SortedPoints(const PointCloud& cloud, std::size_t begin, std::size_t end,
                           const Eigen::Isometry3d& local_from_cloud, double voxels_per_metre)
    : cloud_(cloud), begin_(begin) {
  const std::span points = std::span(cloud.positions).subspan(begin, end - begin);
  const CellFinder cells(local_from_cloud, voxels_per_metre);
  const auto range_of = [&](std::size_t i) {
    return points.subspan(i * kRangeSize, std::min(kRangeSize, points.size() - i * kRangeSize));
  };

  std::vector<RangeBlocks> ranges((points.size() + kRangeSize - 1) / kRangeSize);
  LargeVector<BlockInRange> block_in_range(points.size());
  parallel_for(ranges.size(), [&](std::size_t i) {
    ranges[i] = number_blocks(range_of(i), cells, block_in_range.data() + i * kRangeSize);
  });
  for (std::size_t i = ranges.size(); i-- > 0;) {
    if (ranges[i].unreachable.empty()) continue;
    num_unreachable_ += ranges[i].unreachable.size();
    first_unreachable_ = begin + i * kRangeSize + ranges[i].unreachable.front();
  }
  BlockLayout layout = lay_out_blocks(ranges);
  blocks_ = std::move(layout.blocks);
  first_point_ = std::move(layout.first_point);

  points_.resize(first_point_.back());
  parallel_for(ranges.size(), [&](std::size_t i) {
    const std::span<const Eigen::Vector3d> range = range_of(i);
    for (std::size_t j = 0; j < range.size(); ++j) {
      const std::size_t source = i * kRangeSize + j;
      if (block_in_range[source] == kNowhere) continue;
      points_[ranges[i].targets[block_in_range[source]]++] =
          keyed_point(cells.of_reached(range[j]), static_cast<std::uint32_t>(source));
    }
  });
  sort_voxels();
}

void SortedPoints::sort_voxels() {
  num_voxels_.resize(num_blocks());
  PerThread<LargeVector<KeyedPoint>> scratch;
  parallel_for(num_blocks(), [&](std::size_t i) {
    const std::span points = std::span(points_).subspan(first_point_[i], first_point_[i + 1] - first_point_[i]);
    sort_by_key(points, scratch.mine());
    num_voxels_[i] = count_voxels(points);
  });
}

VoxelSums SortedPoints::sums_of(std::span<const KeyedPoint> points) const {
  VoxelSums sums;
  sums.count = static_cast<std::int64_t>(points.size());
  for (const KeyedPoint& point : points) add_point(sums, point);
  if (!cloud_.colors.empty()) {
    const std::span<const std::uint16_t> linear = linear_from_srgb_table();
    sums.num_colored = sums.count;
    for (const KeyedPoint& point : points) add_color(sums, cloud_.colors[begin_ + point.source], linear);
  }
  if (!cloud_.intensities.empty()) {
    for (const KeyedPoint& point : points) add_intensity(sums, cloud_.intensities[begin_ + point.source]);
  }
  return sums;
}

BlockSums SortedPoints::fold(std::size_t block) const {
  BlockSums voxels;
  voxels.reserve(num_voxels(block));
  for_each_voxel(block, [&](KeyInBlock key, std::span<const KeyedPoint> points) {
    voxels.push_back({key, sums_of(points)});
  });
  return voxels;
}

std::vector<LabelVotes> SortedPoints::votes(std::size_t block) const {
  std::vector<LabelVotes> votes;
  if (cloud_.labels.empty()) return votes;
  for (const KeyedPoint& point : points_of(block)) {
    add_vote(votes, key_of_voxel(blocks_[block], point.key), cloud_.labels[begin_ + point.source]);
  }
  sort_votes(votes);
  return votes;
}

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "vdbmap/core/label_votes.h"
#include "vdbmap/core/large_allocator.h"
#include "vdbmap/core/point_cloud.h"
#include "vdbmap/core/voxel_block.h"

namespace vdbmap {

/// A point on its way into its voxel.
struct KeyedPoint {
  KeyInBlock key;
  std::uint32_t source;                 ///< index in the cloud, from the first point taken
  std::array<std::int16_t, 3> quantum;  ///< position from the voxel's centre
};

/// Points of a cloud sorted by voxel, block by block in the order of their keys. Keeps a reference to the cloud.
///
/// Two counting sorts, no hash map over voxels: points go to their block first (a cached table of the few blocks a
/// scan touches), then every block is sorted by voxel on its own, in cache, blocks in parallel.
class SortedPoints {
 public:
  /// Of the points [begin, end) that are addressable; the others are counted.
  SortedPoints(const PointCloud& cloud, std::size_t begin, std::size_t end, const Eigen::Isometry3d& local_from_cloud,
               double voxels_per_metre);

  /// How many points were left out, and the number of the first one in the cloud.
  std::size_t num_unreachable() const { return num_unreachable_; }
  std::size_t first_unreachable() const { return first_unreachable_; }

  std::size_t num_blocks() const { return blocks_.size(); }
  BlockKey block(std::size_t number) const { return blocks_[number]; }
  std::size_t num_voxels(std::size_t block) const { return num_voxels_[block]; }

  /// Calls body(key, points) for every voxel of a block in the order of their keys.
  template <typename Body>
  void for_each_voxel(std::size_t block, const Body& body) const {
    std::span<const KeyedPoint> rest = points_of(block);
    while (!rest.empty()) {
      std::size_t count = 1;
      while (count < rest.size() && rest[count].key == rest[0].key) ++count;
      body(rest[0].key, rest.first(count));
      rest = rest.subspan(count);
    }
  }

  /// The sums of the points of one voxel.
  VoxelSums sums_of(std::span<const KeyedPoint> points) const;

  /// The sums of all voxels of a block.
  BlockSums fold(std::size_t block) const;

  /// The votes of the points of a block for the labels of its voxels, sorted.
  std::vector<LabelVotes> votes(std::size_t block) const;

 private:
  std::span<const KeyedPoint> points_of(std::size_t block) const {
    return std::span(points_).subspan(first_point_[block], first_point_[block + 1] - first_point_[block]);
  }
  void sort_voxels();

  const PointCloud& cloud_;
  std::size_t begin_;
  std::vector<BlockKey> blocks_;
  std::vector<std::size_t> first_point_;  ///< of each block, and the end
  std::vector<std::size_t> num_voxels_;
  LargeVector<KeyedPoint> points_;
  std::size_t num_unreachable_ = 0;
  std::size_t first_unreachable_ = 0;
};

}  // namespace vdbmap

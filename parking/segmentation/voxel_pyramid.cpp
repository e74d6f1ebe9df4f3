// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/segmentation/voxel_pyramid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "vdbmap/core/hierarchy.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap::parking {
namespace {

constexpr double kFinestSize = 0.1;  // [m]
constexpr int kReach = 2;            // [voxels] on an axis
constexpr int kReachSquared = 6;     // [voxels^2]
constexpr std::size_t kMostNeighbours = 28;
constexpr std::uint32_t kNoVoxel = ~std::uint32_t{0};
constexpr int kSide = 8 + 2 * kReach;  // [voxels] of a leaf and what is near it

std::vector<VoxelIndex> make_steps() {
  std::vector<VoxelIndex> steps;
  for (int x = -kReach; x <= kReach; ++x) {
    for (int y = -kReach; y <= kReach; ++y) {
      for (int z = -kReach; z <= kReach; ++z) {
        if (x * x + y * y + z * z <= kReachSquared) steps.emplace_back(x, y, z);
      }
    }
  }
  std::ranges::stable_sort(steps, {},
                           [](const VoxelIndex& s) { return s.x() * s.x() + s.y() * s.y() + s.z() * s.z(); });
  return steps;
}

// Numbers of the voxels in and around a leaf, in a cube of 12 x 12 x 12.
class LeafSurroundings {
 public:
  void load(const VoxelTree& tree, const VoxelLeaf& leaf) {
    numbers_.fill(kNoVoxel);
    const VoxelIndex origin = leaf.origin();
    const VoxelIndex low = origin.offsetBy(-kReach), high = origin.offsetBy(7 + kReach);
    for (std::int32_t x = low.x(); x <= high.x(); x = (x | 7) + 1) {
      for (std::int32_t y = low.y(); y <= high.y(); y = (y | 7) + 1) {
        for (std::int32_t z = low.z(); z <= high.z(); z = (z | 7) + 1) {
          const VoxelIndex first(x, y, z);
          const VoxelLeaf* near = tree.find_leaf(first);
          if (near == nullptr) continue;
          for_each_voxel_in(*near, first, VoxelIndex::minComponent(high, {x | 7, y | 7, z | 7}),
                            [&](const VoxelIndex& voxel, std::size_t number) {
                              numbers_[place(voxel - low)] = static_cast<std::uint32_t>(number);
                            });
        }
      }
    }
  }

  static int place(const VoxelIndex& from_low) { return (from_low.x() * kSide + from_low.y()) * kSide + from_low.z(); }

  std::uint32_t at(int place) const { return numbers_[static_cast<std::size_t>(place)]; }

 private:
  std::array<std::uint32_t, kSide * kSide * kSide> numbers_{};
};

std::vector<int> places_of_steps() {
  std::vector<int> places;
  for (const VoxelIndex& step : neighbour_steps()) places.push_back(LeafSurroundings::place(step));
  return places;
}

// Calls body(voxel_number, step_number, neighbour) for the neighbours of all voxels of a leaf, nearest first.
template <typename Body>
void for_each_neighbour(const LeafSurroundings& around, const VoxelLeaf& leaf, const Body& body) {
  static const std::vector<int> kPlaces = places_of_steps();
  const VoxelIndex low = leaf.origin().offsetBy(-kReach);
  for_each_voxel(leaf, [&](const VoxelIndex& voxel, std::size_t number) {
    const int middle = LeafSurroundings::place(voxel - low);
    std::size_t found = 0;
    for (std::size_t i = 0; i < kPlaces.size() && found < kMostNeighbours; ++i) {
      const std::uint32_t near = around.at(middle + kPlaces[i]);
      if (near == kNoVoxel) continue;
      body(number, static_cast<std::uint32_t>(i), near);
      ++found;
    }
  });
}

void find_neighbours(const VoxelLevel& level, PyramidLevel& result) {
  const std::span<const VoxelLeaf> leaves = level.leaves();
  PerThread<LeafSurroundings> working;
  result.first.assign(level.size() + 1, 0);
  parallel_for(
      leaves.size(),
      [&](std::size_t i) {
        LeafSurroundings& around = working.mine();
        around.load(level.tree(), leaves[i]);
        for_each_neighbour(around, leaves[i],
                           [&](std::size_t voxel, std::uint32_t, std::uint32_t) { ++result.first[voxel + 1]; });
      },
      16);
  for (std::size_t i = 0; i < level.size(); ++i) result.first[i + 1] += result.first[i];

  result.neighbours.resize(result.first.back());
  parallel_for(
      leaves.size(),
      [&](std::size_t i) {
        LeafSurroundings& around = working.mine();
        around.load(level.tree(), leaves[i]);
        PyramidLevel::Neighbour* out = result.neighbours.data() + result.first[leaves[i].transientData()];
        for_each_neighbour(around, leaves[i], [&](std::size_t, std::uint32_t step, std::uint32_t near) {
          *out++ = {near, step};
        });
      },
      16);
}

void find_places(const VoxelLevel& level, PyramidLevel& result) {
  result.places.resize(level.size());
  const std::span<const VoxelRecord> records = level.records();
  parallel_for(
      level.size(),
      [&](std::size_t i) {
        for (int axis = 0; axis < 3; ++axis) {
          const auto code = records[i].mean_code[static_cast<std::size_t>(axis)];
          result.places[i][axis] = (static_cast<float>(code) + 0.5F) / kMeanSteps;
        }
      },
      1024);
}

// All parents of a leaf's voxels lie in one leaf.
void find_parents(const VoxelLevel& level, const VoxelLevel& above, PyramidLevel& result) {
  result.parents.resize(level.size());
  const std::span<const VoxelLeaf> leaves = level.leaves();
  parallel_for(
      leaves.size(),
      [&](std::size_t i) {
        const VoxelLeaf* parent_leaf = above.tree().find_leaf(parent_of_voxel(leaves[i].origin(), 2));
        for_each_voxel(leaves[i], [&](const VoxelIndex& voxel, std::size_t number) {
          const openvdb::Index offset = VoxelLeaf::coordToOffset(parent_of_voxel(voxel, 2));
          result.parents[number] =
              static_cast<std::uint32_t>(parent_leaf->transientData()) + rank_in_leaf(*parent_leaf, offset);
        });
      },
      16);
}

PyramidLevel make_level(const VoxelLevel& level) {
  PyramidLevel result;
  find_places(level, result);
  find_neighbours(level, result);
  return result;
}

}  // namespace

std::span<const VoxelIndex> neighbour_steps() {
  static const std::vector<VoxelIndex> kSteps = make_steps();
  return kSteps;
}

VoxelPyramid make_pyramid(const VoxelLevel& finest) {
  if (std::abs(finest.voxel_size() - kFinestSize) > 1e-9) {
    throw std::invalid_argument("a pyramid stands on voxels of 0.1 m");
  }
  if (finest.size() >= kNoVoxel) throw std::length_error("a pyramid has at most 4e9 voxels");
  VoxelPyramid pyramid;
  pyramid[0] = make_level(finest);
  VoxelLevel below = finest;
  for (std::size_t i = 1; i < kNumLevels; ++i) {
    VoxelLevel level = coarsen(below, 2);
    find_parents(below, level, pyramid[i - 1]);
    pyramid[i] = make_level(level);
    below = std::move(level);
  }
  return pyramid;
}

}  // namespace vdbmap::parking

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/leaf_neighborhood.h"

#include <bit>

namespace vdbmap {
namespace {

constexpr std::size_t kNumNeighbors = 27;

// Steps to the leaves around a leaf, itself among them.
std::array<VoxelIndex, kNumNeighbors> neighbor_steps() {
  std::array<VoxelIndex, kNumNeighbors> steps;
  std::size_t i = 0;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) steps[i++] = VoxelIndex(x, y, z);
    }
  }
  return steps;
}

std::uint64_t layer_of(const VoxelLeaf& leaf, int x) {
  return leaf.getValueMask().getWord<openvdb::Index64>(static_cast<openvdb::Index>(x));
}

std::uint64_t bits_below(int bit) { return (std::uint64_t{1} << bit) - 1; }

// Moves the eight cells of a leaf's row to their place in a row of ten.
std::uint16_t placed_in_row(std::uint64_t cells, int step) {
  const std::uint64_t from_below = cells << 1;
  return static_cast<std::uint16_t>(step < 0 ? from_below >> 8 : step > 0 ? from_below << 8 : from_below);
}

}  // namespace

void LeafNeighborhood::load(const VoxelLeaf& leaf) {
  static const std::array<VoxelIndex, kNumNeighbors> steps = neighbor_steps();
  std::array<const VoxelLeaf*, kNumNeighbors> neighbors;
  rows_.fill(0);
  for (std::size_t i = 0; i < kNumNeighbors; ++i) {
    neighbors[i] = level_.tree().find_leaf(leaf.origin() + first_child_of_voxel(steps[i], VoxelLeaf::DIM));
    if (neighbors[i]) mark_cells(*neighbors[i], steps[i]);
  }
  number_rows();
  for (std::size_t i = 0; i < kNumNeighbors; ++i) {
    if (neighbors[i]) sum_cells(*neighbors[i], steps[i]);
  }
}

void LeafNeighborhood::mark_cells(const VoxelLeaf& neighbor, const VoxelIndex& step) {
  for (int x = first_of(step.x()); x <= last_of(step.x()); ++x) {
    const std::uint64_t layer = layer_of(neighbor, x);
    if (layer == 0) continue;
    for (int y = first_of(step.y()); y <= last_of(step.y()); ++y) {
      const std::uint64_t cells = layer >> (8 * y) & cells_of(step.z());
      rows_[row_of(x + 8 * step.x(), y + 8 * step.y())] |= placed_in_row(cells, step.z());
    }
  }
}

void LeafNeighborhood::number_rows() {
  std::uint16_t count = 0;
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    first_in_row_[row] = count;
    count = static_cast<std::uint16_t>(count + std::popcount(rows_[row]));
  }
  first_in_row_.back() = count;
  if (sums_.size() < count) sums_.resize(count);
}

void LeafNeighborhood::sum_cells(const VoxelLeaf& neighbor, const VoxelIndex& step) {
  std::size_t first_of_layer = neighbor.transientData();
  for (int x = 0; x < first_of(step.x()); ++x) first_of_layer += std::popcount(layer_of(neighbor, x));
  for (int x = first_of(step.x()); x <= last_of(step.x()); ++x) {
    const std::uint64_t layer = layer_of(neighbor, x);
    for (int y = first_of(step.y()); y <= last_of(step.y()) && layer != 0; ++y) {
      const std::size_t row = row_of(x + 8 * step.x(), y + 8 * step.y());
      std::uint64_t cells = layer >> (8 * y) & cells_of(step.z());
      std::size_t number =
          first_in_row_[row] + std::popcount(rows_[row] & bits_below(8 * step.z() + first_of(step.z()) + 1));
      for (; cells != 0; cells &= cells - 1) {
        const int z = std::countr_zero(cells);
        const std::size_t record = first_of_layer + std::popcount(layer & bits_below(8 * y + z));
        const VoxelIndex from_origin(x + 8 * step.x(), y + 8 * step.y(), z + 8 * step.z());
        sums_[number++] = sums_about_center(level_.records()[record], from_origin);
      }
    }
    first_of_layer += std::popcount(layer);
  }
}

PointSums LeafNeighborhood::sums_about_center(const VoxelRecord& record, const VoxelIndex& from_origin) const {
  const double size = level_.voxel_size();
  return sums_of(record, mean_of(record, from_origin, size) - corner_of_voxel(VoxelIndex(4, 4, 4), size));
}

PointSums LeafNeighborhood::around(openvdb::Index offset) const {
  const auto x = static_cast<int>(offset >> 6);
  const auto y = static_cast<int>(offset >> 3 & 7);
  const auto z = static_cast<int>(offset & 7);
  PointSums total;
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      const std::size_t row = row_of(x + dx, y + dy);
      // Bits z, z + 1 and z + 2 of a row are the cells z - 1, z and z + 1.
      const std::size_t first = first_in_row_[row] + std::popcount(rows_[row] & bits_below(z));
      const std::size_t end = first + std::popcount(rows_[row] >> z & 7u);
      for (std::size_t i = first; i < end; ++i) total.add(sums_[i]);
    }
  }
  return total;
}

}  // namespace vdbmap

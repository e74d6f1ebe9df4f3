// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vdbmap/core/voxel_level.h"

namespace vdbmap {

/// Count, sum of positions [m] and of their products [m^2] about one origin, padded to whole vector registers.
struct alignas(32) NeighborhoodSums {
  std::array<double, 12> values{};  ///< n, x y z, xx yy zz xy xz yz

  void add(const NeighborhoodSums& other) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += other.values[i];
  }
};

/// The voxels of one leaf and those that touch it: 10 x 10 rows of 10 cells. A row is a bit mask, and the sums of
/// occupied cells lie one after the other in the order of rows and cells: three neighbours in a row are one short run.
class LeafNeighborhood {
 public:
  explicit LeafNeighborhood(const VoxelLevel& level) : level_(level) {}

  /// Collects the leaf's voxels and their neighbours.
  void load(const VoxelLeaf& leaf);

  /// Sums over the 27 cells around the leaf's voxel at `offset`, about the leaf's centre.
  NeighborhoodSums around(openvdb::Index offset) const;

 private:
  // A layer, row or cell of a neighbouring leaf that touches this one; `step` is -1, 0 or 1.
  static int first_of(int step) { return step < 0 ? 7 : 0; }
  static int last_of(int step) { return step > 0 ? 0 : 7; }
  static std::uint64_t cells_of(int step) { return step < 0 ? 0x80 : step > 0 ? 0x01 : 0xff; }
  static std::size_t row_of(int x, int y) { return static_cast<std::size_t>((x + 1) * 10 + y + 1); }

  void mark_cells(const VoxelLeaf& neighbor, const VoxelIndex& step);
  void number_rows();
  void sum_cells(const VoxelLeaf& neighbor, const VoxelIndex& step);
  NeighborhoodSums sums_of(const VoxelRecord& record, const VoxelIndex& from_origin) const;

  const VoxelLevel& level_;
  std::array<std::uint16_t, 100> rows_{};          // bit z + 1 of row (x, y): the cell is occupied
  std::array<std::uint16_t, 101> first_in_row_{};  // number of the sums of a row's first occupied cell
  std::vector<NeighborhoodSums> sums_;
};

}  // namespace vdbmap

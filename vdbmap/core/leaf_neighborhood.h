// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vdbmap/core/point_sums.h"
#include "vdbmap/core/voxel_level.h"

namespace vdbmap {

/// The voxels of one leaf and those that touch it: 10 x 10 rows of 10 cells. A row is a bit mask, and the sums of
/// occupied cells lie one after the other in the order of rows and cells: three neighbours in a row are one short run.
class LeafNeighborhood {
 public:
  explicit LeafNeighborhood(const VoxelLevel& level) : level_(level) {}

  /// Collects the leaf's voxels and their neighbours.
  void load(const VoxelLeaf& leaf);

  /// Sums over the 27 cells around the leaf's voxel at `offset`, about the leaf's centre.
  PointSums around(openvdb::Index offset) const;

 private:
  // A layer, row or cell of a neighbouring leaf that touches this one; `step` is -1, 0 or 1.
  static int first_of(int step) { return step < 0 ? 7 : 0; }
  static int last_of(int step) { return step > 0 ? 0 : 7; }
  static std::uint64_t cells_of(int step) { return step < 0 ? 0x80 : step > 0 ? 0x01 : 0xff; }
  static std::size_t row_of(int x, int y) { return static_cast<std::size_t>((x + 1) * 10 + y + 1); }

  void mark_cells(const VoxelLeaf& neighbor, const VoxelIndex& step);
  void number_rows();
  void sum_cells(const VoxelLeaf& neighbor, const VoxelIndex& step);
  PointSums sums_about_center(const VoxelRecord& record, const VoxelIndex& from_origin) const;

  const VoxelLevel& level_;
  std::array<std::uint16_t, 100> rows_{};          // bit z + 1 of row (x, y): the cell is occupied
  std::array<std::uint16_t, 101> first_in_row_{};  // number of the sums of a row's first occupied cell
  std::vector<PointSums> sums_;
};

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "vdbmap/core/voxel.h"

namespace vdbmap::registration {

/// An addressable voxel in one number. Neighbours differ by cell_step().
using Cell = std::uint64_t;

inline Cell cell_of(const VoxelIndex& voxel) {
  const auto bits = [](std::int32_t i) { return static_cast<Cell>(i + kIndexLimit) & 0x1fffff; };
  return bits(voxel.x()) << 42 | bits(voxel.y()) << 21 | bits(voxel.z());
}

inline VoxelIndex voxel_of_cell(Cell cell) {
  const auto index = [](Cell bits) { return static_cast<std::int32_t>(bits & 0x1fffff) - kIndexLimit; };
  return {index(cell >> 42), index(cell >> 21), index(cell)};
}

/// What to add to a cell for its neighbour `x`, `y`, `z` voxels away; wraps around as unsigned numbers do.
constexpr Cell cell_step(int x, int y, int z) {
  return (static_cast<Cell>(x) << 42) + (static_cast<Cell>(y) << 21) + static_cast<Cell>(z);
}

/// A number for each of some cells, in a hash table with open addressing that grows.
class CellTable {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  explicit CellTable(std::size_t expected_cells = 0) : slots_(std::bit_ceil(2 * expected_cells + 16)) {}

  std::size_t size() const { return size_; }

  /// The number of the cell, or kNone.
  std::uint32_t find(Cell cell) const { return slots_[slot_of(cell)].number; }

  /// The number of the cell; a new cell gets `number`.
  std::uint32_t find_or_insert(Cell cell, std::uint32_t number) {
    Slot& slot = slots_[slot_of(cell)];
    if (slot.number != kNone) return slot.number;
    slot = {cell, number};
    if (++size_ * 2 > slots_.size()) grow();
    return number;
  }

  /// Forgets all cells.
  void clear() {
    std::fill(slots_.begin(), slots_.end(), Slot{});
    size_ = 0;
  }

 private:
  struct Slot {
    Cell cell = 0;
    std::uint32_t number = kNone;
  };

  std::size_t slot_of(Cell cell) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = (cell * 0x9E3779B97F4A7C15u) >> 32 & mask;
    while (slots_[slot].number != kNone && slots_[slot].cell != cell) slot = (slot + 1) & mask;
    return slot;
  }

  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old) {
      if (slot.number != kNone) slots_[slot_of(slot.cell)] = slot;
    }
  }

  std::vector<Slot> slots_;
  std::size_t size_ = 0;
};

}  // namespace vdbmap::registration

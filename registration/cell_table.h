// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "vdbmap/core/voxel_id.h"

namespace vdbmap::registration {

/// A number for each of some voxels, in a hash table with open addressing that grows.
class CellTable {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  explicit CellTable(std::size_t expected_voxels = 0) : slots_(std::bit_ceil(2 * expected_voxels + 16)) {}

  std::size_t size() const { return size_; }

  /// The number of the voxel, or kNone.
  std::uint32_t find(VoxelId id) const { return slots_[slot_of(id)].number; }

  /// The number of the voxel; a new one gets `number`.
  std::uint32_t find_or_insert(VoxelId id, std::uint32_t number) {
    Slot& slot = slots_[slot_of(id)];
    if (slot.number != kNone) return slot.number;
    slot = {id, number};
    if (++size_ * 2 > slots_.size()) grow();
    return number;
  }

  /// Forgets all voxels.
  void clear() {
    std::fill(slots_.begin(), slots_.end(), Slot{});
    size_ = 0;
  }

 private:
  struct Slot {
    VoxelId id{};
    std::uint32_t number = kNone;
  };

  std::size_t slot_of(VoxelId id) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = (static_cast<std::uint64_t>(id) * 0x9E3779B97F4A7C15u) >> 32 & mask;
    while (slots_[slot].number != kNone && slots_[slot].id != id) slot = (slot + 1) & mask;
    return slot;
  }

  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old) {
      if (slot.number != kNone) slots_[slot_of(slot.id)] = slot;
    }
  }

  std::vector<Slot> slots_;
  std::size_t size_ = 0;
};

}  // namespace vdbmap::registration

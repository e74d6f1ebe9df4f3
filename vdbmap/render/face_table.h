// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "vdbmap/core/ray_caster.h"

namespace vdbmap {

/// A face of a voxel as one number: six times its record's number and the face.
using FaceCode = std::uint32_t;
inline constexpr FaceCode kNoFace = 0xffffffff;

inline FaceCode face_code(const RayHit& hit) { return static_cast<FaceCode>(6 * hit.record + hit.face); }

/// Which faces of a level are seen, and a number for each of them from 0 on in the order of their codes.
class FaceTable {
 public:
  explicit FaceTable(std::size_t num_records) : seen_(num_records, 0) {}

  /// From any number of threads.
  void mark(FaceCode code) {
    std::atomic_ref<std::uint8_t> seen(seen_[code / 6]);
    const auto bit = static_cast<std::uint8_t>(1 << code % 6);
    if ((seen.load(std::memory_order_relaxed) & bit) == 0) seen.fetch_or(bit, std::memory_order_relaxed);
  }

  /// After the last mark(), before the first number(). Returns how many faces are seen.
  std::size_t count() {
    first_.resize(seen_.size());
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      first_[i] = sum;
      sum += static_cast<std::uint32_t>(std::popcount(seen_[i]));
    }
    return sum;
  }

  /// The faces that are seen of a voxel, as bits.
  std::uint8_t seen(std::size_t record) const { return seen_[record]; }

  /// The number of a face that is seen.
  std::size_t number(FaceCode code) const {
    const int before = seen_[code / 6] & ((1 << code % 6) - 1);
    return first_[code / 6] + static_cast<std::size_t>(std::popcount(static_cast<unsigned>(before)));
  }

 private:
  std::vector<std::uint8_t> seen_;
  std::vector<std::uint32_t> first_;
};

}  // namespace vdbmap

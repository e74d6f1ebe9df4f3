// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "vdbmap/core/posed_cloud.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap {

/// Times at which something was so: a bit each 0.25 s. After 16 s the bits begin anew: that is longer than a place is
/// in sight from a vehicle that drives, and where it stands, what moved is told apart less sharply, never what stayed.
class TimeBins {
 public:
  TimeBins() = default;
  explicit TimeBins(std::uint64_t bits) : bits_(bits) {}

  /// The bin of a time [s] of the drive's clock.
  static TimeBins at(double time) {
    constexpr double kBinsPerSecond = 4;
    const auto bin = static_cast<std::int64_t>(std::floor(time * kBinsPerSecond));
    return TimeBins(std::uint64_t{1} << (static_cast<std::uint64_t>(bin) & 63));
  }

  std::uint64_t bits() const { return bits_; }
  int count() const { return std::popcount(bits_); }
  bool overlaps(TimeBins other) const { return (bits_ & other.bits_) != 0; }

  /// These and the bins before and after each.
  TimeBins widened() const { return TimeBins(bits_ | std::rotl(bits_, 1) | std::rotr(bits_, 1)); }

  TimeBins& operator|=(TimeBins other) {
    bits_ |= other.bits_;
    return *this;
  }

  /// These without the others.
  TimeBins without(TimeBins other) const { return TimeBins(bits_ & ~other.bits_); }

 private:
  std::uint64_t bits_ = 0;
};

/// Adds bins that several threads may add to at a time.
void add_shared(TimeBins& to, TimeBins bins);

/// When points fell into the voxels of a drive's finest level: one a record. `drive` is the map of the clouds.
std::vector<TimeBins> presence_of(const VoxelMap& drive, const CloudSource& clouds);

}  // namespace vdbmap

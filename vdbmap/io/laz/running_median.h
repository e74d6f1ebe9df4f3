// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace vdbmap::laz {

/// About the median of the last numbers: of five in rising order, whose highest makes room for the next one until that
/// is no lower than the middle, then the lowest until it is no higher, and so on.
class RunningMedian {
 public:
  std::int32_t value() const { return sorted_[2]; }

  void add(std::int32_t number) {
    const bool is_lower = number < sorted_[2];
    const bool is_higher = number > sorted_[2];
    if (drops_highest_) {
      sorted_[4] = number;
      for (std::size_t i = 4; i > 0; --i) order(i - 1);
      drops_highest_ = is_lower;
    } else {
      sorted_[0] = number;
      for (std::size_t i = 0; i < 4; ++i) order(i);
      drops_highest_ = !is_higher;
    }
  }

 private:
  void order(std::size_t i) {
    const std::int32_t low = std::min(sorted_[i], sorted_[i + 1]);
    sorted_[i + 1] = std::max(sorted_[i], sorted_[i + 1]);
    sorted_[i] = low;
  }

  std::array<std::int32_t, 5> sorted_{};
  bool drops_highest_ = true;
};

}  // namespace vdbmap::laz

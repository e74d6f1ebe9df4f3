// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vdbmap::registration {

/// How many values lie in each bin [first + i * width, first + (i + 1) * width).
struct ErrorHistogram {
  double first = 0;  ///< lower edge of the first bin, a multiple of the width
  double width = 0;  ///< 1, 2 or 5 times a power of ten
  std::vector<std::size_t> counts;
  std::size_t num_below = 0;  ///< values below the first bin
  std::size_t num_above = 0;  ///< values above the last bin

  double last() const { return first + width * static_cast<double>(counts.size()); }
};

/// At most some twenty bins that show where the values are: a few that are far beyond the others are only counted.
/// There is at least one bin; values must be finite.
ErrorHistogram histogram_of(std::span<const double> values);

}  // namespace vdbmap::registration

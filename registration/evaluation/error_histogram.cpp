// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/evaluation/error_histogram.h"

#include <algorithm>
#include <cmath>

#include "vdbmap/render/plot_area.h"

namespace vdbmap::registration {
namespace {

constexpr double kMinBins = 6;
constexpr double kMaxBins = 18;
constexpr double kMinWidth = 1e-6;  // [m] errors of copied poses are zero but for rounding

// Four times what nine tenths of the values stay below; one value a hundred times the others would else be the only
// one to be seen.
double shown_limit(std::span<const double> values) {
  std::vector<double> sizes;
  for (const double value : values) sizes.push_back(std::abs(value));
  std::sort(sizes.begin(), sizes.end());
  const auto most = static_cast<std::size_t>(0.9 * static_cast<double>(sizes.size() - 1));
  return 4 * sizes[most];
}

// Few values in many bins show gaps where there are none.
double num_bins(std::size_t num_values) {
  return std::clamp(2 * std::sqrt(static_cast<double>(num_values)), kMinBins, kMaxBins);
}

}  // namespace

ErrorHistogram histogram_of(std::span<const double> values) {
  if (values.empty()) return {.first = 0, .width = 0.01, .counts = {0}};
  const double limit = shown_limit(values);
  double low = 0;
  double high = 0;
  for (const double value : values) {
    low = std::min(low, std::max(value, -limit));
    high = std::max(high, std::min(value, limit));
  }
  ErrorHistogram histogram;
  histogram.width = round_step(std::max((high - low) / num_bins(values.size()), kMinWidth));
  const double first = std::floor(low / histogram.width);
  histogram.first = first * histogram.width;
  histogram.counts.resize(static_cast<std::size_t>(std::floor(high / histogram.width) - first) + 1);
  for (const double value : values) {
    const double bin = std::floor(value / histogram.width) - first;
    if (bin < 0) {
      ++histogram.num_below;
    } else if (bin < static_cast<double>(histogram.counts.size())) {
      ++histogram.counts[static_cast<std::size_t>(bin)];
    } else {
      ++histogram.num_above;
    }
  }
  return histogram;
}

}  // namespace vdbmap::registration

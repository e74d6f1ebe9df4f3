// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/evaluation/time_association.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

namespace vdbmap::registration {
namespace {

/// Finds the scan whose time is nearest; of equally near ones the earlier time, of equal times the earlier scan.
class NearestTime {
 public:
  explicit NearestTime(const std::vector<double>& times) : times_(times), order_(times.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) { return times[a] < times[b]; });
  }

  /// There must be a time.
  std::size_t find(double time) const {
    const auto after = first_not_before(time);
    if (after == order_.begin()) return *after;
    const double earlier = times_[*(after - 1)];
    if (after != order_.end() && times_[*after] - time < time - earlier) return *after;
    return *first_not_before(earlier);
  }

 private:
  std::vector<std::size_t>::const_iterator first_not_before(double time) const {
    return std::lower_bound(order_.begin(), order_.end(), time, [&](std::size_t i, double t) { return times_[i] < t; });
  }

  const std::vector<double>& times_;
  std::vector<std::size_t> order_;
};

void check_times(const Trajectory& trajectory, const std::string& name) {
  if (trajectory.times.size() == trajectory.size()) return;
  throw std::invalid_argument("the " + name + " trajectory has " + std::to_string(trajectory.times.size()) +
                              " times for " + std::to_string(trajectory.size()) + " poses");
}

}  // namespace

TimeAssociation associate_by_time(const Trajectory& estimate, const Trajectory& truth, double max_difference) {
  check_times(estimate, "estimated");
  check_times(truth, "true");
  if (!(max_difference >= 0)) {
    throw std::invalid_argument("difference of times is " + std::to_string(max_difference) + " s, expected 0 or more");
  }
  TimeAssociation association;
  association.estimate.times = truth.times;
  association.estimate.map_from_scan.resize(truth.size());
  association.num_unmatched = estimate.size();
  if (estimate.size() == 0) return association;

  const NearestTime nearest_estimate(estimate.times);
  const NearestTime nearest_truth(truth.times);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const std::size_t partner = nearest_estimate.find(truth.times[i]);
    const bool is_near = std::abs(estimate.times[partner] - truth.times[i]) <= max_difference;
    if (!is_near || nearest_truth.find(estimate.times[partner]) != i) continue;
    association.estimate.map_from_scan[i] = estimate.map_from_scan[partner];
    --association.num_unmatched;
  }
  return association;
}

}  // namespace vdbmap::registration

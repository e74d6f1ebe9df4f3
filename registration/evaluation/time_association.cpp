// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/evaluation/time_association.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
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

constexpr double kDenser = 1.5;  // intervals

std::vector<double> sorted(std::vector<double> times) {
  std::ranges::sort(times);
  return times;
}

// [s] between poses of different times, rising.
std::vector<double> intervals_of(std::span<const double> sorted_times) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < sorted_times.size(); ++i) {
    if (sorted_times[i] > sorted_times[i - 1]) intervals.push_back(sorted_times[i] - sorted_times[i - 1]);
  }
  return sorted(std::move(intervals));
}

// The median of those that are no holes: no longer than one and a half of what a tenth of them do not reach.
double interval_without_holes(std::span<const double> intervals) {
  const double longest = kDenser * intervals[intervals.size() / 10];
  const auto num_without_holes = std::ranges::upper_bound(intervals, longest) - intervals.begin();
  return intervals[static_cast<std::size_t>(num_without_holes) / 2];
}

// The interval [s] of the estimates where the truth has poses between them.
std::optional<double> interval_in_denser_truth(std::span<const double> sorted_estimates, const Trajectory& truth) {
  const std::vector<double> estimates = intervals_of(sorted_estimates);
  const std::vector<double> truths = intervals_of(sorted(truth.times));
  if (estimates.empty() || truths.empty()) return std::nullopt;
  const double interval = interval_without_holes(estimates);
  return interval > kDenser * truths[truths.size() / 2] ? std::optional(interval) : std::nullopt;
}

// Counted from 1 in a hole between the estimates: the scan that may have been taken at a time; nothing outside of
// holes.
struct MissingScan {
  std::size_t hole = 0;
  std::size_t number = 0;
  double difference = 0;  // [s] of the time from that of the scan

  bool is_same_scan(const MissingScan& other) const { return hole == other.hole && number == other.number; }
};

std::optional<MissingScan> missing_scan_at(double time, std::span<const double> sorted_estimates, double interval) {
  const auto after = std::ranges::upper_bound(sorted_estimates, time);
  if (after == sorted_estimates.begin() || after == sorted_estimates.end()) return std::nullopt;
  const double begin = *(after - 1);
  const double hole = *after - begin;
  if (hole <= kDenser * interval) return std::nullopt;
  const double num_intervals = std::round(hole / interval);
  const double step = hole / num_intervals;
  const double number = std::round((time - begin) / step);
  if (number < 1 || number > num_intervals - 1) return std::nullopt;
  return MissingScan{static_cast<std::size_t>(after - sorted_estimates.begin()), static_cast<std::size_t>(number),
                     std::abs(time - begin - number * step)};
}

// Of the true poses that have no partner those nearest to the times of missing scans.
void add_missing(std::span<const double> sorted_estimates, double interval, const Trajectory& truth,
                 std::vector<char>& is_judged) {
  std::vector<std::size_t> order(truth.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return truth.times[i]; });
  std::optional<MissingScan> last;
  std::size_t best = 0;
  for (const std::size_t i : order) {
    const auto scan = missing_scan_at(truth.times[i], sorted_estimates, interval);
    if (!scan || is_judged[i]) continue;
    const bool is_same = last && last->is_same_scan(*scan);
    if (is_same && scan->difference >= last->difference) continue;
    if (is_same) is_judged[best] = 0;
    is_judged[i] = 1;
    best = i;
    last = scan;
  }
}

// The entries of the true poses that are judged.
TimeAssociation judged(TimeAssociation all, std::span<const char> is_judged) {
  TimeAssociation some;
  some.num_unmatched = all.num_unmatched;
  for (std::size_t i = 0; i < is_judged.size(); ++i) {
    if (!is_judged[i]) {
      ++some.num_not_judged;
      continue;
    }
    some.estimate.map_from_scan.push_back(all.estimate.map_from_scan[i]);
    some.truth.map_from_scan.push_back(all.truth.map_from_scan[i]);
    some.truth.times.push_back(all.truth.times[i]);
  }
  some.estimate.times = some.truth.times;
  return some;
}

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
  association.truth = truth;
  association.estimate.times = truth.times;
  association.estimate.map_from_scan.resize(truth.size());
  association.num_unmatched = estimate.size();
  if (estimate.size() == 0) return association;

  const NearestTime nearest_estimate(estimate.times);
  const NearestTime nearest_truth(truth.times);
  std::vector<char> is_judged(truth.size(), 0);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const std::size_t partner = nearest_estimate.find(truth.times[i]);
    const bool is_near = std::abs(estimate.times[partner] - truth.times[i]) <= max_difference;
    if (!is_near || nearest_truth.find(estimate.times[partner]) != i) continue;
    association.estimate.map_from_scan[i] = estimate.map_from_scan[partner];
    --association.num_unmatched;
    is_judged[i] = 1;
  }
  const std::vector<double> estimates = sorted(estimate.times);
  const std::optional<double> interval = interval_in_denser_truth(estimates, truth);
  if (!interval) return association;
  add_missing(estimates, *interval, truth, is_judged);
  return judged(std::move(association), is_judged);
}

}  // namespace vdbmap::registration

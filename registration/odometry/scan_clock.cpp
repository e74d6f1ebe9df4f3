// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/scan_clock.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace vdbmap::registration {
namespace {

constexpr double kMaxDuration = 1.0;      // [s] scanners turn more than once a second; longer, no motion is constant
constexpr double kMaxUsualInterval = 10;  // durations; a longer one is a gap
constexpr double kSameStart = 0.1;        // of the duration: scans that begin so close have an epoch each

struct TimeSpan {
  double first = 0;
  double last = 0;

  double duration() const { return last - first; }
};

std::string in_seconds(double seconds) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.3g s", seconds);
  return text.data();
}

// Empty where all is well.
std::string problem_of(const PointCloud& scan, TimeSpan& span) {
  if (scan.times.size() != scan.size()) {
    return std::to_string(scan.times.size()) + " times for " + std::to_string(scan.size()) + " points";
  }
  if (!std::all_of(scan.times.begin(), scan.times.end(), [](double time) { return std::isfinite(time); })) {
    return "a time stamp is not finite";
  }
  const auto [first, last] = std::minmax_element(scan.times.begin(), scan.times.end());
  span = {*first, *last};
  if (span.duration() <= 0) return "all its time stamps are the same";
  if (span.duration() > kMaxDuration) {
    return "its time stamps span " + in_seconds(span.duration()) + ", more than the " + in_seconds(kMaxDuration) +
           " of a turn";
  }
  return "";
}

}  // namespace

ScanTiming ScanClock::next(const PointCloud& scan) {
  ScanTiming timing = judge(scan);
  num_turns_ = 1;
  elapsed_ = elapsed_ ? *elapsed_ + timing.interval : 0;
  timing.elapsed = *elapsed_;
  return timing;
}

ScanTiming ScanClock::judge(const PointCloud& scan) {
  ScanTiming timing;
  timing.interval = timing.usual_interval = num_turns_ * usual_turn_;
  TimeSpan span;
  if (!scan.times.empty()) timing.problem = problem_of(scan, span);
  if (scan.times.empty() || !timing.problem.empty()) {
    since_last_first_ += timing.interval;
    return timing;
  }
  const double step = last_first_ ? span.first - *last_first_ : 0;
  const double rest = step - std::exchange(since_last_first_, 0);
  last_first_ = span.first;
  if (step < -kSameStart * span.duration()) {
    timing.problem = "its time stamps go back by " + in_seconds(-step);
    return timing;
  }
  timing.first = span.first;
  // By a common epoch what the time stamps say, else as many turns as there were.
  timing.interval = rest > kSameStart * span.duration() ? rest : num_turns_ * span.duration();
  const double turn = timing.interval / num_turns_;
  if (turn <= kMaxUsualInterval * span.duration()) usual_turn_ = turn;
  return timing;
}

}  // namespace vdbmap::registration

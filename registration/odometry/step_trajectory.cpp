// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/step_trajectory.h"

#include <limits>

namespace vdbmap::registration {
namespace {

// Times that begin anew are no times of the sequence: they stand still where the clock of the odometry goes on. Most
// scans decide, as a wrong time stamp makes a step that is like that too.
bool have_common_epoch(std::span<const OdometryStep> steps) {
  constexpr double kLeastPace = 0.5;  // of the clock's
  const ScanMotion* last = nullptr;
  int excess = 0;  // of steps that go on over those that stand still
  for (const OdometryStep& step : steps) {
    if (!step.has_time) continue;
    const ScanMotion& motion = step.motion;
    if (last) {
      const double elapsed = motion.elapsed - last->elapsed;
      excess += motion.reference_time - last->reference_time >= kLeastPace * elapsed ? 1 : -1;
    }
    last = &motion;
  }
  return last != nullptr && excess >= 0;
}

}  // namespace

Trajectory trajectory_of(std::span<const OdometryStep> steps) {
  Trajectory trajectory;
  const bool has_times = have_common_epoch(steps);
  for (const OdometryStep& step : steps) {
    trajectory.map_from_scan.push_back(step.registered() ? std::optional(step.first_from_scan) : std::nullopt);
    if (!has_times) continue;
    trajectory.times.push_back(step.has_time ? step.motion.reference_time : std::numeric_limits<double>::quiet_NaN());
  }
  return trajectory;
}

}  // namespace vdbmap::registration

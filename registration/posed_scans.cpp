// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/posed_scans.h"

#include <utility>

namespace vdbmap::registration {
namespace {

// The motion between scans that are farther apart says little of that within one [s].
constexpr double kMaxInterval = 1.0;

}  // namespace

void PosedScans::add(PointCloud scan, const Eigen::Isometry3d& map_from_scan) {
  const ScanTiming timing = clock_.next(scan);
  if (waiting_) {
    const double interval = timing.elapsed - waiting_->elapsed;
    const bool is_near = interval > 0 && interval <= kMaxInterval;
    if (is_near) twist_ = twist_of_motion(waiting_->map_from_scan.inverse() * map_from_scan) / interval;
    hand_on();
    if (!is_near) twist_.setZero();
  }
  waiting_ = {std::move(scan), map_from_scan, timing.first, timing.elapsed};
}

void PosedScans::pass_over(std::size_t num_scans) { clock_.pass_over(num_scans); }

void PosedScans::finish() {
  if (waiting_) hand_on();
  waiting_.reset();
}

void PosedScans::hand_on() {
  Waiting& scan = *waiting_;
  if (!scan.first_time || scan.scan.times.empty()) {
    const std::vector<Eigen::Vector3d> origin = {Eigen::Vector3d::Zero()};
    receiver_({scan.scan, scan.map_from_scan, origin});
    return;
  }
  ScanMotion motion;
  motion.reference_time = *scan.first_time;
  motion.twist = twist_;
  // Where the sensor was: what lies at its own origin, deskewed like a point.
  const std::vector<Eigen::Vector3d> sensor(scan.scan.size(), Eigen::Vector3d::Zero());
  const std::vector<Eigen::Vector3d> origins = deskew_points(sensor, scan.scan.times, motion);
  const PointCloud deskewed = deskew(std::move(scan.scan), motion);
  receiver_({deskewed, scan.map_from_scan, origins});
}

}  // namespace vdbmap::registration

// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/deskew_stream.h"

#include <utility>

namespace vdbmap::registration {

void DeskewStream::add(PointCloud scan, const OdometryStep& step) {
  if (!step.registered()) return;
  if (std::exchange(is_first_, false) && step.has_time) {
    waiting_ = {std::move(scan), step};
    return;
  }
  if (waiting_) waiting_->step.motion.twist = step.motion.twist;
  finish();
  hand_on(std::move(scan), step);
}

void DeskewStream::finish() {
  if (waiting_) hand_on(std::move(waiting_->scan), waiting_->step);
  waiting_.reset();
}

void DeskewStream::hand_on(PointCloud scan, const OdometryStep& step) {
  receiver_(deskew(std::move(scan), step.motion), step.first_from_scan, step.motion);
}

}  // namespace vdbmap::registration

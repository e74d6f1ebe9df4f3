// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/sequence.h"

#include <utility>

#include "registration/rigid_motion.h"

namespace vdbmap::registration {

SequenceLocalizer::SequenceLocalizer(const MapWindows& map, const LocalizerOptions& options,
                                     const OdometryOptions& odometry)
    : localizer_(map, options), odometry_options_(odometry), odometry_(odometry), stream_(new_stream()) {}

DeskewStream SequenceLocalizer::new_stream() {
  return DeskewStream([this](const PointCloud& scan, const Eigen::Isometry3d& pose, const ScanMotion& motion) {
    receive(scan, pose, motion);
  });
}

void SequenceLocalizer::receive(const PointCloud& deskewed_scan, const Eigen::Isometry3d& odometry_from_scan,
                                const ScanMotion& motion) {
  const bool follows = !std::exchange(is_first_of_segment_, false);
  localizer_.add({deskewed_scan.positions, odometry_from_scan, follows, motion});
}

// From here on odometry knows nothing of the scans before.
void SequenceLocalizer::begin_segment() {
  stream_.finish();
  stream_ = new_stream();
  is_first_of_segment_ = true;
  last_given_.reset();
}

void SequenceLocalizer::take(PointCloud scan, const OdometryStep& step) {
  added_.push_back({step.reason, step.time_problem});
  stream_.add(std::move(scan), step);
}

void SequenceLocalizer::add(PointCloud scan) {
  OdometryStep step = odometry_.register_scan(scan);
  if (!step.registered()) {
    Odometry anew(odometry_options_);
    const OdometryStep first = anew.register_scan(scan);
    if (first.registered()) {
      begin_segment();
      odometry_ = std::move(anew);
      step = first;
    }
  }
  take(std::move(scan), step);
}

// A given pose as a step, with the motion since the last one for deskewing.
OdometryStep SequenceLocalizer::follow(const PointCloud& scan, const Eigen::Isometry3d& odometry_from_scan) {
  const ScanTiming timing = clock_.next(scan);
  OdometryStep step;
  step.first_from_scan = odometry_from_scan;
  step.has_time = timing.first.has_value();
  step.time_problem = timing.problem;
  step.motion.reference_time = timing.first.value_or(0);
  step.motion.elapsed = timing.elapsed;
  if (step.has_time && last_given_) {
    step.motion.twist = twist_of_motion(last_given_->inverse() * odometry_from_scan) / timing.interval;
    step.motion.lead = mean_lead(scan.times, step.motion.reference_time);
  }
  last_given_ = odometry_from_scan;
  return step;
}

void SequenceLocalizer::add(PointCloud scan, const std::optional<Eigen::Isometry3d>& odometry_from_scan) {
  if (scan.empty()) return skip("it holds no points");
  if (!odometry_from_scan) return skip("odometry has no pose for it");
  const OdometryStep step = follow(scan, *odometry_from_scan);
  take(std::move(scan), step);
}

void SequenceLocalizer::skip(const std::string& reason) {
  added_.push_back({reason, ""});
  pass_over(1);
}

void SequenceLocalizer::pass_over(std::size_t num_scans) {
  odometry_.pass_over(num_scans);
  clock_.pass_over(num_scans);
}

SequenceResult SequenceLocalizer::finish() {
  stream_.finish();
  SequenceResult used = localizer_.finish();

  SequenceResult result;
  std::vector<std::size_t> places;  // of the used scans among all
  for (std::size_t i = 0; i < added_.size(); ++i) {
    SequenceScan& scan = result.scans.emplace_back();
    if (added_[i].reason.empty()) {
      scan = std::move(used.scans[places.size()]);
      places.push_back(i);
    } else {
      scan.reason = added_[i].reason;
    }
    scan.time_problem = added_[i].time_problem;
  }
  for (SequenceBatch& batch : used.batches) {
    const std::size_t last = places[batch.first + batch.count - 1];
    batch.first = places[batch.first];
    batch.count = last - batch.first + 1;
    result.batches.push_back(std::move(batch));
  }
  added_.clear();
  begin_segment();
  odometry_ = Odometry(odometry_options_);
  clock_ = ScanClock();
  return result;
}

}  // namespace vdbmap::registration

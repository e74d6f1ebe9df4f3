// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/guided_localizer.h"

#include <cstdint>
#include <memory>
#include <utility>

#include "registration/fine/scan_sample.h"
#include "registration/map_window.h"
#include "registration/odometry/deskew.h"
#include "vdbmap/core/parallel_tasks.h"

namespace vdbmap::registration {

GuidedLocalizer::GuidedLocalizer(MapWindows map, const FineOptions& options, const FoundCriteria& criteria)
    : map_(std::move(map)), options_(options), criteria_(criteria) {
  options.check();
  criteria.check();
}

void GuidedLocalizer::follow_from(const Eigen::Isometry3d& map_from_scan_guess) {
  motion_.set_pose(map_from_scan_guess);
}

// Thinned before it is deskewed, which is done more than once.
GuidedLocalizer::KeptScan GuidedLocalizer::begin(const PointCloud& scan) {
  const ScanTiming timing = clock_.next(scan);
  KeptScan kept;
  kept.first_time = timing.first.value_or(0);
  kept.elapsed = timing.elapsed;
  kept.result.time_problem = timing.problem;
  if (!timing.first) {
    kept.positions = scan.positions;
  } else {
    for (const std::uint32_t i : sample_indices(scan.positions, options_.fine_spacing, options_.range)) {
      kept.positions.push_back(scan.positions[i]);
      kept.times.push_back(scan.times[i]);
    }
  }
  kept.lead = mean_lead(kept.times, kept.first_time);
  motion_.begin_scan(timing.interval, kept.lead);
  return kept;
}

// Whether it lies on the map: as long as it is skewed, it may not come to rest there.
bool GuidedLocalizer::is_placed(const LocalizedScan& result) const {
  return result.fine.num_points > 0 && result.fine.inlier_share >= criteria_.min_inlier_share;
}

LocalizedScan GuidedLocalizer::localize(const KeptScan& scan, const Vector6d& twist,
                                        const Eigen::Isometry3d& map_from_middle_guess, bool search_headings) const {
  FineOptions options = options_;
  options.search_headings = options.search_headings && search_headings;
  const bool is_deskewed = !scan.times.empty() && !twist.isZero(0);
  const std::vector<Eigen::Vector3d> deskewed =
      is_deskewed ? deskew_points(scan.positions, scan.times, {scan.first_time + scan.lead, twist}) : scan.positions;
  const SampledScan sample = sample_scan(deskewed, options.fine_spacing, options.coarse_spacing, options.range);
  const std::shared_ptr<const VoxelMap> map = window_of(map_, sample.fine, map_from_middle_guess);
  LocalizedScan result = localize_sample(sample, *map, map_from_middle_guess, options, criteria_);
  result.time_problem = scan.result.time_problem;
  return result;
}

void GuidedLocalizer::take(KeptScan scan, LocalizedScan result) {
  scan.result = std::move(result);
  if (scan.times.empty()) scan.positions = {};
  if (is_placed(scan.result)) {
    const Eigen::Isometry3d& map_from_middle = scan.result.fine.map_from_scan;
    if (std::exchange(has_found_, true)) motion_.set_twist(motion_.twist_to(map_from_middle));
    motion_.set_pose(map_from_middle);
  }
  scans_.push_back(std::move(scan));
}

void GuidedLocalizer::add(const PointCloud& scan) {
  if (scan.empty()) return skip("it holds no points");
  KeptScan kept = begin(scan);
  LocalizedScan result = localize(kept, motion_.twist(), motion_.predicted_pose(), true);
  take(std::move(kept), std::move(result));
}

// The motion of the scans before is a help that a wrong one of them can spoil: then the guess goes without it.
void GuidedLocalizer::add(const PointCloud& scan, const std::optional<Eigen::Isometry3d>& map_from_scan_guess) {
  if (scan.empty()) return skip("it holds no points");
  if (!map_from_scan_guess) return skip("no guess");
  KeptScan kept = begin(scan);
  const Vector6d twist = motion_.twist();
  LocalizedScan result = localize(kept, twist, *map_from_scan_guess * motion_of_twist(kept.lead * twist), true);
  if (!is_placed(result) && !kept.times.empty() && !twist.isZero(0)) {
    result = localize(kept, Vector6d::Zero(), *map_from_scan_guess, true);
  }
  take(std::move(kept), std::move(result));
}

void GuidedLocalizer::skip(const std::string& reason) {
  scans_.emplace_back().result.reason = reason;
  pass_over(1);
}

// The nearest scan before or after this one that tells the motion.
std::optional<TimedPose> GuidedLocalizer::neighbour(std::size_t number, bool is_before) const {
  const TimedPose at = scans_[number].middle();
  for (std::size_t i = number; is_before ? i-- > 0 : ++i < scans_.size();) {
    if (!tells_motion(scans_[i])) continue;
    const TimedPose pose = scans_[i].middle();
    if (is_before ? pose.time < at.time : pose.time > at.time) return pose;  // turns may overlap
  }
  return std::nullopt;
}

// The scans were aligned with the motion before them at best: all once more with that around them.
void GuidedLocalizer::deskew_all() {
  std::vector<std::optional<LocalizedScan>> results(scans_.size());
  parallel_tasks(scans_.size(), [&](std::size_t i) {
    if (!tells_motion(scans_[i])) return;
    const std::optional<TimedPose> before = neighbour(i, true);
    const std::optional<TimedPose> after = neighbour(i, false);
    if (!before && !after) return;
    const TimedPose at = scans_[i].middle();
    results[i] = localize(scans_[i], twist_at_pose(before, at, after), at.map_from_sensor, false);
  });
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    if (results[i]) take_deskewed(scans_[i], std::move(*results[i]));
  }
}

// A neighbour that was found at a wrong place tells a motion that takes the points off the map.
void GuidedLocalizer::take_deskewed(KeptScan& scan, LocalizedScan result) const {
  constexpr double kKeptShare = 0.9;  // of the points on the map: deskewing should lay more of them there
  const bool fits = is_placed(result) && result.fine.inlier_share >= kKeptShare * scan.result.fine.inlier_share;
  scan.is_deskewed = scan.is_deskewed || fits;
  if (fits) scan.result = std::move(result);
}

void GuidedLocalizer::move_to_first_points() {
  std::vector<Eigen::Isometry3d> map_from_first(scans_.size());
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    const TimedPose at = scans_[i].middle();
    map_from_first[i] = at.map_from_sensor;
    if (!tells_motion(scans_[i])) continue;
    const std::optional<TimedPose> before = neighbour(i, true);
    const std::optional<TimedPose> after = neighbour(i, false);
    if (scans_[i].is_deskewed) {
      map_from_first[i] = pose_at_time(scans_[i].elapsed, before, at, after);
    } else if (before || after) {
      scans_[i].result.time_problem = "the motion between the scans found beside it takes its points off the map";
    }
  }
  for (std::size_t i = 0; i < scans_.size(); ++i) scans_[i].result.fine.map_from_scan = map_from_first[i];
}

std::vector<LocalizedScan> GuidedLocalizer::finish() {
  constexpr int kRounds = 3;  // each takes away most of the error that the motion had before it
  for (int round = 0; round < kRounds; ++round) deskew_all();
  move_to_first_points();
  std::vector<LocalizedScan> results;
  for (KeptScan& scan : scans_) results.push_back(std::move(scan.result));
  *this = GuidedLocalizer(map_, options_, criteria_);
  return results;
}

}  // namespace vdbmap::registration

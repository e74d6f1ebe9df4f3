// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/odometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "registration/odometry/wide_search.h"
#include "registration/percent.h"
#include "vdbmap/core/option_check.h"

namespace vdbmap::registration {
namespace {

constexpr std::size_t kMinPoints = 20;  // aligned: fewer do not hold a pose

// Share of the aligned points within half a voxel of the map. It depends on the scanner, its speed and how long it has
// been here: on KITTI streets scans where they belong have 0.55 (16 rings, second scan, 14 m/s) to 0.99; scans of
// another street reach 0.31, and scans that a gap made rest a few metres off 0.4 to 0.53 of 0.97 before.
constexpr double kMinInlierShare = 0.4;
constexpr double kMinKeptShare = 0.7;     // of the share that the scan before had
constexpr double kMinRefoundShare = 0.8;  // the same after a wide search, which finds the best of many wrong places too

// Left of the share that is expected after each scan that had less, as the surroundings may have changed for good, from
// fair weather to rain: a drop from 0.97 to 0.6 is believed after five scans. It ends where scans that belong have been
// seen to begin: below, what rests at a wrong place would be let in by waiting.
constexpr double kExpectationDecay = 0.97;
constexpr double kLeastDecayedShare = 0.55;

std::string reason_for_few(const PointCloud& scan, std::size_t num_points, const OdometryOptions& options) {
  if (scan.empty()) return "it holds no points";
  std::ostringstream reason;
  reason << "only " << num_points << " of " << scan.size() << " points are left within " << options.range.min << " to "
         << options.range.max << " m and " << options.registration_spacing * options.voxel_size << " m apart, "
         << kMinPoints << " are needed";
  return reason.str();
}

LocalMapOptions map_options(const OdometryOptions& options) {
  return {options.voxel_size, options.points_per_voxel, options.range.max};
}

const OdometryOptions& checked(const OdometryOptions& options) {
  options.check();
  return options;
}

std::vector<Eigen::Vector3d> moved(std::vector<Eigen::Vector3d> points, const Eigen::Isometry3d& target_from_points) {
  for (Eigen::Vector3d& point : points) point = target_from_points * point;
  return points;
}

// The covariance of a pose by the axes of another frame.
Matrix6d with_axes_of(const Matrix6d& covariance, const Eigen::Matrix3d& axes) {
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = axes.transpose();
  turn.bottomRightCorner<3, 3>() = axes.transpose();
  return turn * covariance * turn.transpose();
}

}  // namespace

void OdometryOptions::check() const {
  require(range.min >= 0, "range.min", range.min, "0 m or more");
  require(range.max > range.min && std::isfinite(range.max), "range.max", range.max, "more than range.min");
  require(map_spacing > 0 && map_spacing <= 10, "map_spacing", map_spacing, "more than 0, at most 10 voxels");
  require(registration_spacing >= map_spacing && registration_spacing <= 10, "registration_spacing",
          registration_spacing, "map_spacing to 10 voxels");
  require(initial_threshold > 0, "initial_threshold", initial_threshold, "more than 0 m");
  require(min_deviation > 0, "min_deviation", min_deviation, "more than 0 m");
  require(max_iterations > 0, "max_iterations", max_iterations, "1 or more");
  require(convergence > 0, "convergence", convergence, "more than 0");
}

std::vector<Eigen::Vector3d> Odometry::Sample::deskewed(const Vector6d& twist, double reference_time) const {
  return times.empty() || twist.isZero(0) ? positions : deskew_points(positions, times, {reference_time, twist});
}

double Odometry::Alignment::overlap_share() const {
  return static_cast<double>(result.matches.num_inliers) / static_cast<double>(aligned_points.size());
}

Odometry::Odometry(const OdometryOptions& options)
    : options_(checked(options)),
      threshold_(options.initial_threshold, options.min_deviation, options.range.max),
      map_(map_options(options)) {}

// Thinned before it is deskewed, which costs a tenth of the reverse and only lets other points stand for their cube.
Odometry::Sample Odometry::sample_of(const PointCloud& scan, const ScanTiming& timing) const {
  const bool has_times = timing.first && options_.deskews;
  Sample sample;
  sample.first_time = timing.first.value_or(0);
  for (const std::uint32_t i :
       sample_indices(scan.positions, options_.map_spacing * options_.voxel_size, options_.range)) {
    sample.positions.push_back(scan.positions[i]);
    if (has_times) sample.times.push_back(scan.times[i]);
  }
  sample.lead = sample.times.empty() ? last_lead_ : mean_lead(sample.times, sample.first_time);
  return sample;
}

PointToPointOptions Odometry::alignment_options(double sigma) const {
  PointToPointOptions options;
  options.limits.max_distance = 3 * sigma;
  options.limits.kernel = sigma / 3;
  options.limits.inlier_distance = options_.voxel_size / 2;
  options.max_iterations = options_.max_iterations;
  options.convergence = options_.convergence;
  return options;
}

Odometry::Alignment Odometry::align(const Sample& sample, const Vector6d& twist, const LocalMap& map,
                                    const Eigen::Isometry3d& guess) const {
  constexpr RangeLimits kAll{0, std::numeric_limits<double>::infinity()};
  Alignment alignment;
  alignment.points = sample.deskewed(twist, sample.first_time + sample.lead);
  alignment.aligned_points = sample_points(alignment.points, options_.registration_spacing * options_.voxel_size, kAll);
  alignment.result = align_points(alignment.aligned_points, map, guess, alignment_options(threshold_.sigma()));
  return alignment;
}

OdometryStep Odometry::register_scan(const PointCloud& scan) {
  const ScanTiming timing = clock_.next(scan);
  const Sample sample = sample_of(scan, timing);
  motion_.begin_scan(timing.interval, sample.lead);
  OdometryStep step;
  step.has_time = timing.first.has_value();
  if (options_.deskews) step.time_problem = timing.problem;
  step.motion.reference_time = sample.first_time;
  step.motion.lead = sample.lead;
  step.motion.elapsed = timing.elapsed;
  step.sigma = threshold_.sigma();
  step.first_from_scan = motion_.at_first_point(motion_.predicted_pose());

  Alignment alignment = align(sample, motion_.twist(), map_, motion_.predicted_pose());
  step.num_points = alignment.aligned_points.size();
  if (step.num_points < kMinPoints) {
    step.reason = reason_for_few(scan, step.num_points, options_);
  } else if (map_.empty()) {
    start(sample);
  } else {
    if (first_sample_) straighten_first_scan(sample, alignment, step);
    search_if_lost(timing.usual_interval, alignment, step);
    accept(alignment, step);
  }
  return step;
}

void Odometry::start(const Sample& sample) {
  map_.insert(sample.positions);
  motion_.set_pose(Eigen::Isometry3d::Identity());
  last_lead_ = sample.lead;
  if (!sample.times.empty()) first_sample_ = sample;
}

// The first scan was taken as if the sensor had stood still. Now that its motion is known the map begins anew, in the
// frame of that scan's first point.
Odometry::Straightened Odometry::straightened_by(const Sample& second, const Alignment& alignment) const {
  constexpr int kRounds = 3;  // each takes away most of the error of the one before
  Straightened straight{LocalMap(map_options(options_)), motion_, alignment};
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::Isometry3d map_from_second = straight.alignment.result.map_from_scan;
    const Vector6d twist = straight.motion.twist_to(map_from_second);
    straight.motion.correct_registered(motion_of_twist(first_sample_->lead * twist));
    straight.map = LocalMap(map_options(options_));
    straight.map.insert(first_sample_->deskewed(twist, first_sample_->first_time));
    straight.alignment = align(second, twist, straight.map, map_from_second);
  }
  return straight;
}

// A scan that does not lie in the straightened map tells no motion: the first one waits for another.
void Odometry::straighten_first_scan(const Sample& second, Alignment& alignment, const OdometryStep& step) {
  Straightened straight = straightened_by(second, alignment);
  if (straight.alignment.overlap_share() < min_overlap_share(step)) return;
  map_ = std::move(straight.map);
  motion_ = straight.motion;
  alignment = std::move(straight.alignment);
}

double Odometry::min_overlap_share(const OdometryStep& step) const {
  const double kept = step.was_refound ? kMinRefoundShare : kMinKeptShare;
  return std::max(kMinInlierShare, kept * expected_share_);
}

// Around where the motion leads to, then, in case a time stamp made that senseless, to where it leads usually.
void Odometry::search_if_lost(double usual_interval, Alignment& alignment, OdometryStep& step) const {
  for (const Eigen::Isometry3d& guess : {motion_.predicted_pose(), motion_.predicted_pose(usual_interval)}) {
    if (alignment.overlap_share() >= min_overlap_share(step)) return;
    const PointToPointResult rough =
        search_widely(alignment.aligned_points, map_, guess, alignment_options(options_.initial_threshold / 2));
    const PointToPointResult found =
        align_points(alignment.aligned_points, map_, rough.map_from_scan, alignment_options(step.sigma));
    if (found.matches.num_inliers <= alignment.result.matches.num_inliers) continue;
    alignment.result = found;
    step.was_refound = true;
  }
}

void Odometry::accept(const Alignment& alignment, OdometryStep& step) {
  const Eigen::Isometry3d& map_from_scan = alignment.result.map_from_scan;
  step.num_iterations = alignment.result.num_iterations;
  step.overlap_share = alignment.overlap_share();
  if (step.overlap_share < min_overlap_share(step)) {
    step.reason = "only " + percent(step.overlap_share) + " of its points lie on those of the scans before, expected " +
                  percent(min_overlap_share(step));
    const double least = std::min(expected_share_, kLeastDecayedShare / kMinKeptShare);
    expected_share_ = std::max(kExpectationDecay * expected_share_, least);
    return;
  }
  const Eigen::Isometry3d predicted_from_found = motion_.predicted_pose().inverse() * map_from_scan;
  step.jump = predicted_from_found.translation().norm();
  // A jump says nothing about the speed and its changes: how long the gap was is mostly unknown.
  if (!step.was_refound) {
    threshold_.add_deviation(predicted_from_found);
    motion_.set_twist(motion_.twist_to(map_from_scan));
  }
  motion_.set_pose(map_from_scan);
  add_to_map(alignment, step);
}

void Odometry::add_to_map(const Alignment& alignment, OdometryStep& step) {
  const Eigen::Isometry3d& map_from_scan = alignment.result.map_from_scan;
  const auto covariance =
      match_covariance(alignment.aligned_points, map_, map_from_scan, alignment_options(step.sigma).limits);
  if (covariance) step.covariance = with_axes_of(*covariance, first_from_registered_.linear());
  step.first_from_scan = motion_.at_first_point(map_from_scan);
  step.previous_from_scan = first_from_registered_.inverse() * step.first_from_scan;
  if (step.has_time && options_.deskews) step.motion.twist = motion_.twist();

  map_.insert(moved(alignment.points, map_from_scan));
  map_.forget_far(map_from_scan.translation());
  first_from_registered_ = step.first_from_scan;
  first_sample_.reset();
  last_lead_ = step.motion.lead;
  expected_share_ = step.overlap_share;
}

}  // namespace vdbmap::registration

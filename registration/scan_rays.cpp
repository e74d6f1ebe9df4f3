// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/scan_rays.h"

#include <utility>

#include "registration/odometry/deskew.h"
#include "registration/pose_at_time.h"

namespace vdbmap::registration {
namespace {

// The pose of a scan of the drive, as if the scans followed each other in even intervals.
std::optional<TimedPose> timed_pose(const Trajectory& poses, std::size_t number, double time) {
  if (number >= poses.size() || !poses.map_from_scan[number]) return std::nullopt;
  return TimedPose{time, *poses.map_from_scan[number]};
}

std::optional<Vector6d> twist_of(const Trajectory& poses, std::size_t number, double interval) {
  const auto before = number > 0 ? timed_pose(poses, number - 1, -interval) : std::nullopt;
  const auto after = timed_pose(poses, number + 1, interval);
  if (!before && !after) return std::nullopt;
  return twist_at_pose(before, *timed_pose(poses, number, 0), after);
}

}  // namespace

ScanRayStream::ScanRayStream(Trajectory poses, std::size_t skipped, bool deskews)
    : poses_(std::move(poses)), skipped_(skipped), deskews_(deskews) {}

std::optional<ScanRays> ScanRayStream::next(PointCloud scan) {
  const std::size_t number = number_++;
  const std::optional<Eigen::Isometry3d> pose = poses_.map_from_scan.at(number);
  const ScanTiming timing = clock_.next(scan);
  clock_.pass_over(skipped_);
  if (!pose) return std::nullopt;

  ScanRays rays;
  rays.time_problem = deskews_ ? timing.problem : "";
  const std::optional<Vector6d> twist =
      deskews_ && timing.first && timing.interval > 0 ? twist_of(poses_, number, timing.interval) : std::nullopt;
  rays.origins.assign(scan.size(), pose->translation());
  if (twist) {
    const Eigen::Vector3d velocity = pose->linear() * twist->tail<3>();
    for (std::size_t i = 0; i < scan.size(); ++i) rays.origins[i] += (scan.times[i] - *timing.first) * velocity;
    scan = deskew(std::move(scan), {.reference_time = *timing.first, .twist = *twist});
  }
  for (Eigen::Vector3d& position : scan.positions) position = *pose * position;
  rays.ends = std::move(scan);
  return rays;
}

}  // namespace vdbmap::registration

// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/joining.h"

#include <optional>

#include "registration/pose_at_time.h"

namespace vdbmap::registration {
namespace {

// Whether a scan was aligned with what is there, not with another place like it.
bool is_in_place(const AlignedScan& scan, double min_inlier_share) {
  constexpr double kMaxShift = 1.0;    // [m] beyond the drift
  constexpr double kMaxTurn = 0.0873;  // [rad] 5 degrees
  const Eigen::Isometry3d shift = scan.place.map_from_scan.inverse() * scan.fine.map_from_scan;
  return scan.fine.inlier_share >= min_inlier_share && shift.translation().norm() < kMaxShift + scan.drift &&
         Eigen::AngleAxisd(shift.linear()).angle() < kMaxTurn;
}

bool is_deskewed(const AlignedScan& scan) { return !scan.motion.twist.isZero(0); }

TimedPose middle_in_time(const AlignedScan& scan, const PoseEstimate& middle) {
  return {scan.motion.elapsed + scan.motion.lead, middle.map_from_scan};
}

}  // namespace

std::vector<PoseEstimate> join_scans(std::span<const AlignedScan> scans, std::span<const PathPose> path,
                                     double min_inlier_share, const JointOptions& options) {
  std::vector<SequencePose> sequence(scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const AlignedScan& scan = scans[i];
    if (!scan.place.is_known()) continue;
    const Eigen::Isometry3d first_from_middle = scan.motion.first_from_middle();
    sequence[i].map_from_scan_guess = scan.place.map_from_scan * first_from_middle;
    if (is_in_place(scan, min_inlier_share)) {
      sequence[i].in_map = carried({scan.fine.map_from_scan, scan.fine.covariance}, first_from_middle);
    }
    if (linked_scan(path, i, true) && scans[i - 1].place.is_known()) {
      sequence[i].previous_from_scan =
          scans[i - 1].motion.first_from_middle().inverse() * step_between(path[i - 1], path[i]) * first_from_middle;
    }
  }
  return refine_jointly(sequence, options);
}

PoseEstimate first_point_of(std::size_t number, std::span<const AlignedScan> scans, std::span<const PathPose> path,
                            std::span<const PoseEstimate> middles) {
  const TimedPose at = middle_in_time(scans[number], middles[number]);
  const auto neighbour = [&](bool is_before) -> std::optional<TimedPose> {
    const std::optional<std::size_t> from = linked_scan(path, number, is_before);
    if (!from || !scans[*from].place.is_known() || !is_deskewed(scans[*from])) return std::nullopt;
    const TimedPose pose = middle_in_time(scans[*from], middles[*from]);
    const bool is_in_order = is_before ? pose.time < at.time : pose.time > at.time;  // turns may overlap
    return is_in_order ? std::optional(pose) : std::nullopt;
  };
  const std::optional<TimedPose> before = neighbour(true);
  const std::optional<TimedPose> after = neighbour(false);
  const ScanMotion& motion = scans[number].motion;
  if (!is_deskewed(scans[number]) || (!before && !after)) {
    return carried(middles[number], motion.first_from_middle().inverse());
  }
  const Eigen::Isometry3d map_from_first = pose_at_time(motion.elapsed, before, at, after);
  return carried(middles[number], at.map_from_sensor.inverse() * map_from_first);
}

}  // namespace vdbmap::registration

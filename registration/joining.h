// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "registration/carrying.h"
#include "registration/fine/joint_refinement.h"
#include "registration/fine/point_to_plane.h"
#include "registration/odometry/deskew.h"
#include "registration/odometry_path.h"

namespace vdbmap::registration {

/// A scan aligned by itself, from the place where it was thought to lie.
struct AlignedScan {
  ScanPlace place;
  ScanMotion motion;  ///< that its points were deskewed with
  FineResult fine;    ///< as new where the place is not known
  double drift = 0;   ///< [m] that odometry may have moved it by within its batch
};

/// Poses of all scans jointly, in the middle of their times: their first points lie where the twist of the deskewing
/// puts them. Alignments of fewer inliers than `min_inlier_share`, and those that moved a scan away from its place, are
/// left to odometry. `path` has one pose a scan.
std::vector<PoseEstimate> join_scans(std::span<const AlignedScan> scans, std::span<const PathPose> path,
                                     double min_inlier_share, const JointOptions& options);

/// Where a scan's sensor stood at its first point, from where the scans before, at and after were in the middle of
/// their times (`middles`, from join_scans()): the twist of the deskewing, from odometry, knows less.
PoseEstimate first_point_of(std::size_t number, std::span<const AlignedScan> scans, std::span<const PathPose> path,
                            std::span<const PoseEstimate> middles);

}  // namespace vdbmap::registration

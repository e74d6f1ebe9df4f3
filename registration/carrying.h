// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "registration/odometry_path.h"

namespace vdbmap::registration {

/// How the place of a scan is known.
enum class PlaceSource : std::uint8_t {
  kNone,     ///< it is not
  kGuess,    ///< odometry alone leads there from a scan that is known better
  kTracked,  ///< aligned with the map from such a guess
  kBatch,    ///< its batch was found in the whole map
};

/// Where a scan is thought to lie.
struct ScanPlace {
  PlaceSource source = PlaceSource::kNone;
  Eigen::Isometry3d map_from_scan = Eigen::Isometry3d::Identity();  ///< the identity where there is none
  double inlier_share = 0;                                          ///< of a scan that was tracked
  std::size_t num_guesses = 0;  ///< of a guess: scans since one that is known better, itself among them

  bool is_known() const { return source != PlaceSource::kNone; }
};

/// Where the map puts a scan.
struct TrackedPose {
  Eigen::Isometry3d map_from_scan = Eigen::Isometry3d::Identity();
  double inlier_share = 0;  ///< 0 to 1
};

/// Aligns a scan, named by its number, from a guess. Called by two threads at a time.
using TrackScan = std::function<TrackedPose(std::size_t scan, const Eigen::Isometry3d& map_from_scan_guess)>;

/// How long scans are carried.
struct CarryOptions {
  double min_inlier_share = 0.3;  ///< of a scan that counts as tracked
  std::size_t max_guesses = 20;   ///< in a row
};

/// Tracks scans of batches that were not found from their neighbours, forward and backward through the sequence, each
/// until it is lost for `max_guesses` scans or odometry has a gap. Of the two places of a scan a tracked one is better
/// than a guess, then the one of more inliers, then the guess from nearer by, then the forward one. Places of batches
/// stay. One place a scan on the path. The same for any number of threads.
std::vector<ScanPlace> carry_places(std::span<const ScanPlace> found, std::span<const PathPose> path,
                                    const TrackScan& track, const CarryOptions& options);

}  // namespace vdbmap::registration

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "registration/coarse/feature_matches.h"
#include "registration/coarse/surface_points.h"

namespace vdbmap::registration {

/// When matches agree with each other and with a pose.
struct ConsensusOptions {
  double inlier_distance = 2;           ///< [m] of a match, moved, from its partner (Mortazavi 2023, section 2.3)
  double max_length_difference = 1;     ///< [m] between the lines from one match to another in source and target
  double min_length = 4;                ///< [m] of such a line: short ones fix no direction
  double max_cosine_difference = 0.25;  ///< between the cosines of normals and line in source and target
  std::size_t max_matches = 1000;       ///< the best are used; time and memory grow with the square
  std::size_t max_hypotheses = 16;
  double max_tilt_deg = 180;  ///< between the third axes of source and target

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
};

/// A pose on which matches agree.
struct PoseHypothesis {
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  std::size_t num_inliers = 0;  ///< matched source points within the inlier distance
};

/// Whether two poses are the same answer: less than 2 m apart at the source's centre and 5 degrees.
bool are_alike(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, const Eigen::Vector3d& source_center);

/// Poses on which many matches agree, most inliers first, no two alike (2 m or 5 degrees apart at least).
///
/// Every pair of matches that keeps its length and its angles with the normals is an edge of a graph. An edge's support
/// is the number of matches that are compatible with both its ends (second-order compatibility: Chen et al. 2022,
/// SC2-PCR); the matches behind the best supported edges give a pose each, which is then fitted to all matches within
/// the inlier distance. Where RANSAC draws samples, this tries all pairs: no luck and no seed.
std::vector<PoseHypothesis> find_consensus(const SurfacePoints& source, const SurfacePoints& target,
                                           std::span<const FeatureMatch> matches, const ConsensusOptions& options = {});

}  // namespace vdbmap::registration

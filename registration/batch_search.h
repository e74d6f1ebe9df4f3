// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "registration/coarse/coarse.h"
#include "registration/evidence.h"
#include "registration/fine/point_to_plane.h"
#include "registration/fine/scan_sample.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap::registration {

/// When a pose found without a guess is believed.
struct VerdictOptions {
  double min_overlap = 0.3;        ///< share of the points that have the map near by
  double min_agreement = 0.52;     ///< surface_agreement(); on KITTI streets true poses reach 0.56, others 0.47
  double max_blocked_share = 0.6;  ///< of the rays: through solid map; what has moved since blocks some
  double min_margin = 1.2;         ///< agreement of the best pose by that of the next best
  double max_deviation = 0.25;     ///< [m] standard deviation of the place in its least certain direction
  std::size_t min_points = 200;    ///< sampled points of a batch, 1.5 m apart

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
};

/// Scans of a batch joined by odometry, ready to be looked for. The frame is that of the batch.
struct CombinedScans {
  VoxelLevel level;    ///< voxels as large as the map's coarsest
  SampledScan sample;  ///< all scans together
  std::vector<SurfacePiece> pieces;
  std::vector<Ray> rays;
};

/// A pose of the batch, aligned as well as may be.
struct BatchCandidate {
  Eigen::Isometry3d map_from_batch = Eigen::Isometry3d::Identity();  ///< original system
  Eigen::Isometry3d coarse_guess = Eigen::Isometry3d::Identity();    ///< the same before it was aligned
  std::size_t num_feature_inliers = 0;                               ///< of the coarse search
  double agreement = 0;                                              ///< surface_agreement()
  Evidence evidence;
  Matrix6d covariance = Matrix6d::Zero();  ///< as FineResult::covariance
};

/// Where a batch lies, or why that is not known.
struct BatchResult {
  std::vector<BatchCandidate> candidates;  ///< the best and its rivals, the better first; no two alike
  std::string reason;                      ///< empty when found

  bool found() const { return reason.empty(); }
};

/// Looks for a batch in the whole map: coarse hypotheses, compared by compare_hypotheses(). `coarse_map` belongs to the
/// map's coarsest level. The same for any number of threads.
BatchResult find_batch(const CombinedScans& combined, const VoxelMap& map, const CoarseMap& coarse_map,
                       const CoarseOptions& coarse = {}, const VerdictOptions& verdict = {},
                       const FineOptions& fine = {});

/// Aligns hypotheses, best supported first and in the map's local frame, and judges the best of them. Those that come
/// to one place count as one, and the next takes their turn: until there is a rival, and up to six places while half as
/// many features speak for them as for the first. The best two are aligned on all levels, and each other that could
/// come near the best by that, so that no place that looks alike is left out of the comparison. Headings are not
/// searched, whatever `fine` says: a hypothesis has one. The same for any number of threads.
BatchResult compare_hypotheses(const CombinedScans& combined, const VoxelMap& map,
                               std::span<const PoseHypothesis> hypotheses, const VerdictOptions& verdict = {},
                               const FineOptions& fine = {});

}  // namespace vdbmap::registration

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "registration/coarse/coarse.h"
#include "registration/evidence.h"
#include "registration/fine/point_to_plane.h"
#include "registration/fine/scan_sample.h"
#include "registration/verdict.h"
#include "vdbmap/store/map_windows.h"

namespace vdbmap::registration {

/// Scans of a batch joined by odometry, ready to be looked for. The frame is that of the batch.
struct CombinedScans {
  VoxelLevel level;    ///< voxels as large as the map's coarsest
  SampledScan sample;  ///< all scans together
  std::vector<SurfacePiece> pieces;
  std::vector<MeasuredRay> rays;
};

/// Where a batch lies, or why that is not known.
struct BatchResult {
  std::vector<BatchCandidate> candidates;  ///< the best and its rivals, the better first; no two alike
  std::string reason;                      ///< empty when found

  bool found() const { return reason.empty(); }
};

/// Looks for a batch in the whole map: coarse hypotheses, compared by compare_hypotheses(). `coarse_map` belongs to the
/// map's coarsest level. The same for any number of threads.
BatchResult find_batch(const CombinedScans& combined, const MapWindows& map, const CoarseMap& coarse_map,
                       const CoarseOptions& coarse = {}, const VerdictOptions& verdict = {},
                       const FineOptions& fine = {});

/// Aligns hypotheses, the better first and in the map's local frame, and judges the best of them. The finest level
/// is looked at around these alone. Those that come
/// to one place count as one, and the next takes their turn: until there is a rival, and up to six places while half as
/// many features speak for them as for the first. The best two are aligned on all levels, and each other that could
/// come near the best by that, so that no place that looks alike is left out of the comparison. Headings are not
/// searched, whatever `fine` says: a hypothesis has one. The same for any number of threads.
BatchResult compare_hypotheses(const CombinedScans& combined, const MapWindows& map,
                               std::span<const PoseHypothesis> hypotheses, const VerdictOptions& verdict = {},
                               const FineOptions& fine = {});

}  // namespace vdbmap::registration

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "registration/batch_search.h"
#include "registration/fine/scan_sample.h"

namespace vdbmap::registration {

/// Combines scans for a search in the whole map; the frame of the batch is that of its first scan.
class BatchBuilder {
 public:
  /// `voxel_size` [m] is that of the map's coarsest level; points beyond the limits are left out.
  BatchBuilder(double voxel_size, const RangeLimits& range) : voxel_size_(voxel_size), range_(range) {}

  /// Adds a scan: all points for the voxels, its sample for alignment.
  void add(std::span<const Eigen::Vector3d> points_in_scan, const SampledScan& sample,
           const Eigen::Isometry3d& batch_from_scan);

  /// All scans added.
  CombinedScans combine() const;

 private:
  double voxel_size_;
  RangeLimits range_;
  PointCloud points_;                       // frame of the batch
  std::vector<Eigen::Vector3d> sample_;     // frame of the batch
  std::vector<Eigen::Isometry3d> sensors_;  // batch_from_scan
  std::vector<std::size_t> ends_;           // of each scan's part of the sample
};

}  // namespace vdbmap::registration

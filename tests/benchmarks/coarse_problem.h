// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "registration/coarse/coarse.h"
#include "registration/fine/scan_sample.h"
#include "tests/benchmarks/drive.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap::benchmarks {

/// A drive split in two: a map of its even scans with true poses, and its odd scans with the poses of our own odometry.
struct CoarseProblem {
  VoxelMap map;
  registration::CoarseMap coarse_map;
  std::vector<const PointCloud*> scans;
  std::vector<registration::SampledScan> samples;
  std::vector<Eigen::Isometry3d> odometry_from_scan;
  std::vector<Eigen::Isometry3d> map_from_scan;  // true
  std::size_t batch_size = 0;
};

/// Of the drive (batches of 20 scans), or of the kitti00 beside it (batches of all 8); nullptr where it is missing.
const CoarseProblem* drive_problem();
const CoarseProblem* residential_problem();

/// A batch of consecutive scans somewhere in the drive, carried up to 100 m off on each axis in the plane and turned by
/// up to 180 degrees about the vertical; the same for the same seed.
struct MovedBatch {
  std::size_t first = 0;
  std::size_t count = 0;
  Eigen::Isometry3d moved_from_odometry = Eigen::Isometry3d::Identity();
};
MovedBatch moved_batch(const CoarseProblem& problem, unsigned seed);

}  // namespace vdbmap::benchmarks

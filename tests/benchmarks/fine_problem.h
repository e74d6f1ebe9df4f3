// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Geometry>
#include <benchmark/benchmark.h>

#include "vdbmap/core/point_cloud.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap::benchmarks {

/// Scans to be found in a map that was not made of them.
struct FineProblem {
  VoxelMap map;                            ///< of the even scans of kitti_drive5
  std::vector<const PointCloud*> scans;    ///< the odd ones, whole
  std::vector<Eigen::Isometry3d> truths;   ///< map_from_scan
  std::vector<Eigen::Isometry3d> guesses;  ///< map_from_scan, 0.5 m and 1 degree off in random directions
};

/// The problem, made at its first use; nullptr where the drive is missing.
const FineProblem* fine_problem();

/// Finds a scan from a guess: map_from_scan of both.
using Aligner = std::function<Eigen::Isometry3d(const PointCloud& scan, const Eigen::Isometry3d& guess)>;

/// Aligns all scans of the problem in each iteration. The row's time is the median over the scans; counters: the
/// mean CPU time of all threads a scan (which other programs disturb less), the slowest scan, errors to the truth, and
/// the share of scans within 0.1 m and 0.3 degrees.
void measure_alignment(benchmark::State& state, const FineProblem& problem, const Aligner& align);

/// Threads 1 and 2, the median of some repetitions.
void set_fine_options(benchmark::internal::Benchmark* row);

}  // namespace vdbmap::benchmarks

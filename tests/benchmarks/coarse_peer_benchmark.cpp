// SPDX-License-Identifier: GPL-3.0-or-later
// The peer of `features`: Open3D's normals and FPFH of the means of the same voxels, within the same radius.
#include <benchmark/benchmark.h>
#include <omp.h>
#include <open3d/geometry/KDTreeSearchParam.h>
#include <open3d/pipelines/registration/Feature.h>

#include "registration/coarse/coarse.h"
#include "tests/benchmarks/coarse_problem.h"
#include "tests/benchmarks/open3d_cloud.h"

namespace vdbmap::benchmarks {
namespace {

void open3d_features(benchmark::State& state) {
  const CoarseProblem* problem = drive_problem();
  if (!problem) return state.SkipWithError(kNoDrive);
  omp_set_num_threads(static_cast<int>(state.range(0)));
  const double radius = registration::CoarseOptions().feature_radius;
  open3d::geometry::PointCloud cloud = open3d_cloud(problem->map.coarsest());
  for (auto _ : state) {
    cloud.normals_.clear();
    cloud.EstimateNormals(open3d::geometry::KDTreeSearchParamRadius(2.0));
    benchmark::DoNotOptimize(
        open3d::pipelines::registration::ComputeFPFHFeature(cloud, open3d::geometry::KDTreeSearchParamRadius(radius)));
  }
}
BENCHMARK(open3d_features)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->MinTime(2)
    ->UseRealTime();

}  // namespace
}  // namespace vdbmap::benchmarks

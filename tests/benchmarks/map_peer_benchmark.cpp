// SPDX-License-Identifier: GPL-3.0-or-later
// The peer of `build_map`: Open3D makes means and colours only, without covariances, normals or a second level. It
// works on one thread.
#include <memory>

#include <benchmark/benchmark.h>

#include "tests/benchmarks/drive.h"
#include "tests/benchmarks/open3d_cloud.h"
#include "tests/benchmarks/sample_clouds.h"

namespace vdbmap::benchmarks {
namespace {

void open3d_voxel_down_sample(benchmark::State& state, CloudSource source) {
  const PointCloud* cloud = source();
  if (!cloud) return state.SkipWithError(kNoDrive);
  const open3d::geometry::PointCloud input = open3d_cloud(*cloud);
  std::shared_ptr<open3d::geometry::PointCloud> sampled;
  for (auto _ : state) sampled = input.VoxelDownSample(0.1);

  state.counters["points"] = static_cast<double>(input.points_.size());
  state.counters["voxels"] = static_cast<double>(sampled->points_.size());
}
BENCHMARK_CAPTURE(open3d_voxel_down_sample, drive, drive_cloud)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(1)
    ->Repetitions(5)
    ->DisplayAggregatesOnly();
BENCHMARK_CAPTURE(open3d_voxel_down_sample, street, street_cloud)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(1)
    ->Repetitions(5)
    ->DisplayAggregatesOnly();

}  // namespace
}  // namespace vdbmap::benchmarks

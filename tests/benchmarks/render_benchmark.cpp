// SPDX-License-Identifier: GPL-3.0-or-later
// How long does a picture of 1920 x 1080 pixels take, without reading the map and writing the file?
#include <benchmark/benchmark.h>

#include "tests/benchmarks/drive.h"
#include "tests/benchmarks/sample_clouds.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/render/render.h"

namespace vdbmap::benchmarks {
namespace {

constexpr int kRepetitions = 5;

void set_options(benchmark::internal::Benchmark* row) {
  row->ArgNames({"view", "threads"})
      ->ArgsProduct(
          {{static_cast<int>(View::kPlan), static_cast<int>(View::kPerspective), static_cast<int>(View::kOrbit)},
           {1, 2}})
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->Iterations(1)
      ->Repetitions(kRepetitions)
      ->DisplayAggregatesOnly();
}

void measure(benchmark::State& state, const VoxelMap& map) {
  const ThreadLimit limit(static_cast<std::size_t>(state.range(1)));
  RenderOptions options;
  options.view = static_cast<View>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(render(map, options));
  state.counters["voxels"] = static_cast<double>(map.finest().size());
}

void render_street(benchmark::State& state) {
  static const VoxelMap map = build_map(*street_cloud());
  measure(state, map);
}
BENCHMARK(render_street)->Apply(set_options);

void render_drive(benchmark::State& state) {
  if (!drive_cloud()) return state.SkipWithError(kNoDrive);
  static const VoxelMap map = build_map(*drive_cloud());
  measure(state, map);
}
BENCHMARK(render_drive)->Apply(set_options);

// Ten streets side by side: eleven million voxels.
VoxelMap make_quarter() {
  MapBuilder builder({});
  for (int i = 0; i < 10; ++i) {
    const Eigen::Isometry3d aside(Eigen::Translation3d(0, 32.0 * i, 0));
    builder.add(*street_cloud(), aside);
  }
  return builder.finish();
}

void render_quarter(benchmark::State& state) {
  static const VoxelMap map = make_quarter();
  measure(state, map);
}
BENCHMARK(render_quarter)->Apply(set_options);

}  // namespace
}  // namespace vdbmap::benchmarks

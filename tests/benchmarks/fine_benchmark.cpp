// SPDX-License-Identifier: GPL-3.0-or-later
// How long does it take to find a whole scan, thinning included, from a guess half a metre off? The peers stand in
// fine_peer_benchmark.cpp.
#include <benchmark/benchmark.h>

#include "registration/fine/point_to_plane.h"
#include "tests/benchmarks/drive.h"
#include "tests/benchmarks/fine_problem.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap::benchmarks {
namespace {

void align_scan(benchmark::State& state) {
  const FineProblem* problem = fine_problem();
  if (!problem) return state.SkipWithError(kNoDrive);
  const ThreadLimit limit(static_cast<std::size_t>(state.range(0)));
  measure_alignment(state, *problem, [&](const PointCloud& scan, const Eigen::Isometry3d& guess) {
    return registration::align_scan(scan, problem->map, guess).map_from_scan;
  });
}
BENCHMARK(align_scan)->Apply(set_fine_options);

}  // namespace
}  // namespace vdbmap::benchmarks

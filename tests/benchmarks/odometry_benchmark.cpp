// SPDX-License-Identifier: GPL-3.0-or-later
// How long does odometry take for a scan of 122,000 points, read already? KISS-ICP 1.2.3 took 18 ms on a machine of two
// cores.
#include <algorithm>
#include <chrono>
#include <ctime>
#include <vector>

#include <benchmark/benchmark.h>

#include "registration/odometry/odometry.h"
#include "tests/benchmarks/drive.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap::benchmarks {
namespace {

double xy_error(const Eigen::Isometry3d& first_from_scan, const Drive& drive, std::size_t scan) {
  const Eigen::Isometry3d true_pose = drive.map_from_scan.front().inverse() * drive.map_from_scan[scan];
  return (first_from_scan.translation() - true_pose.translation()).head<2>().norm();
}

// The row's time is the median over the scans of the drive.
void register_scan(benchmark::State& state) {
  using Clock = std::chrono::steady_clock;
  const Drive* drive = kitti_drive();
  if (!drive) return state.SkipWithError(kNoDrive);
  const ThreadLimit limit(static_cast<std::size_t>(state.range(0)));
  std::vector<double> seconds(drive->scans.size());
  double max_error = 0;
  const std::clock_t cpu_start = std::clock();
  for (auto _ : state) {
    registration::Odometry odometry;
    for (std::size_t i = 0; i < drive->scans.size(); ++i) {
      const auto start = Clock::now();
      const registration::OdometryStep step = odometry.register_scan(drive->scans[i]);
      seconds[i] = std::chrono::duration<double>(Clock::now() - start).count();
      max_error = std::max(max_error, xy_error(step.first_from_scan, *drive, i));
    }
    std::sort(seconds.begin(), seconds.end());
    state.SetIterationTime(seconds[seconds.size() / 2]);
  }
  const double cpu_seconds = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
  state.counters["cpu_ms"] = 1000 * cpu_seconds / static_cast<double>(state.iterations() * seconds.size());
  state.counters["slowest_ms"] = 1000 * seconds.back();
  state.counters["max_xy_m"] = max_error;
}
BENCHMARK(register_scan)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(1)
    ->Repetitions(7)
    ->DisplayAggregatesOnly();

}  // namespace
}  // namespace vdbmap::benchmarks

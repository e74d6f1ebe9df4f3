// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/benchmarks/fine_problem.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <numbers>
#include <optional>

#include "registration/trajectory_error.h"
#include "tests/benchmarks/drive.h"
#include "tests/benchmarks/random.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap::benchmarks {
namespace {

constexpr double kGuessTranslation = 0.5;                  // [m]
constexpr double kGuessRotation = std::numbers::pi / 180;  // [rad]

Eigen::Isometry3d guess_near(const Eigen::Isometry3d& truth, Random& random) {
  Eigen::Isometry3d guess = truth;
  guess.rotate(Eigen::AngleAxisd(kGuessRotation, random_direction(random)));
  guess.translation() += kGuessTranslation * random_direction(random);
  return guess;
}

std::optional<FineProblem> make_problem() {
  const Drive* drive = kitti_drive();
  if (!drive) return std::nullopt;
  FineProblem problem;
  MapBuilder builder({});
  Random random(2024);
  for (std::size_t i = 0; i < drive->scans.size(); ++i) {
    if (i % 2 == 0) {
      builder.add(drive->scans[i], drive->map_from_scan[i]);
    } else {
      problem.scans.push_back(&drive->scans[i]);
      problem.truths.push_back(drive->map_from_scan[i]);
      problem.guesses.push_back(guess_near(drive->map_from_scan[i], random));
    }
  }
  problem.map = builder.finish();
  return problem;
}

Trajectory trajectory_of(const std::vector<Eigen::Isometry3d>& poses) {
  Trajectory trajectory;
  trajectory.map_from_scan.assign(poses.begin(), poses.end());
  return trajectory;
}

void count_errors(benchmark::State& state, const std::vector<Eigen::Isometry3d>& estimates,
                  const std::vector<Eigen::Isometry3d>& truths) {
  const registration::TrajectoryError error =
      registration::evaluate_trajectory(trajectory_of(estimates), trajectory_of(truths));
  state.counters["median_m"] = error.translation.median;
  state.counters["max_m"] = error.translation.max;
  state.counters["median_deg"] = error.rotation_deg.median;
  state.counters["max_deg"] = error.rotation_deg.max;
  state.counters["found_share"] = registration::success_rate(error, {0.1, 0.3});
}

}  // namespace

const FineProblem* fine_problem() {
  static const std::optional<FineProblem> problem = make_problem();
  return problem ? &*problem : nullptr;
}

void measure_alignment(benchmark::State& state, const FineProblem& problem, const Aligner& align) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> seconds(problem.scans.size());
  std::vector<Eigen::Isometry3d> estimates(problem.scans.size());
  const std::clock_t cpu_start = std::clock();
  for (auto _ : state) {
    for (std::size_t i = 0; i < problem.scans.size(); ++i) {
      const auto start = Clock::now();
      estimates[i] = align(*problem.scans[i], problem.guesses[i]);
      seconds[i] = std::chrono::duration<double>(Clock::now() - start).count();
    }
    std::sort(seconds.begin(), seconds.end());
    state.SetIterationTime(seconds[seconds.size() / 2]);
  }
  const double cpu_seconds = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
  state.counters["cpu_ms"] = 1000 * cpu_seconds / static_cast<double>(state.iterations() * seconds.size());
  state.counters["slowest_ms"] = 1000 * seconds.back();
  count_errors(state, estimates, problem.truths);
}

void set_fine_options(benchmark::internal::Benchmark* row) {
  row->ArgName("threads")->Arg(1)->Arg(2);
  row->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(1)->Repetitions(7)->DisplayAggregatesOnly();
}

}  // namespace vdbmap::benchmarks

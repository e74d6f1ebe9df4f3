// SPDX-License-Identifier: GPL-3.0-or-later
// Are batches of a drive's odd scans found in the map of its even ones with no first guess, how fast, and are those of
// another place refused? 50 batches each, turned by up to 180 degrees and carried up to 100 m off. The peer of
// `features` stands in coarse_peer_benchmark.cpp.
#include <algorithm>
#include <chrono>
#include <optional>
#include <vector>

#include <benchmark/benchmark.h>

#include "registration/batch_builder.h"
#include "registration/batch_search.h"
#include "registration/localizer.h"
#include "tests/benchmarks/coarse_problem.h"
#include "tests/support/pose_distance.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap::benchmarks {
namespace {

using Clock = std::chrono::steady_clock;

constexpr unsigned kNumSeeds = 50;

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

void features(benchmark::State& state) {
  const CoarseProblem* problem = drive_problem();
  if (!problem) return state.SkipWithError(kNoDrive);
  const ThreadLimit limit(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(registration::prepare_coarse_map(problem->map.coarsest()));
  state.counters["voxels"] = static_cast<double>(problem->map.coarsest().size());
}
BENCHMARK(features)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->MinTime(2)->UseRealTime();

registration::BatchResult find(const CoarseProblem& place, const CoarseProblem& problem, const MovedBatch& batch) {
  registration::BatchBuilder builder(1.0, {});
  for (std::size_t i = batch.first; i < batch.first + batch.count; ++i) {
    builder.add(problem.scans[i]->positions, problem.samples[i],
                batch.moved_from_odometry * problem.odometry_from_scan[i]);
  }
  return registration::find_batch(builder.combine(), place.map, place.coarse_map);
}

// How far the middle scan of the batch is from the truth.
test::PoseDistance error_of(const Eigen::Isometry3d& map_from_batch, const CoarseProblem& problem,
                            const MovedBatch& batch) {
  const std::size_t middle = batch.first + batch.count / 2;
  return test::distance_between(map_from_batch * batch.moved_from_odometry * problem.odometry_from_scan[middle],
                                problem.map_from_scan[middle]);
}

// The row's time is the median over the batches, combination of the scans included.
void find_batches(benchmark::State& state, const CoarseProblem* (*get_problem)()) {
  const CoarseProblem* problem = get_problem();
  if (!problem) return state.SkipWithError(kNoDrive);
  double num_coarse = 0, num_fine = 0, num_wrong = 0, max_m = 0;
  for (auto _ : state) {
    std::vector<double> seconds;
    num_coarse = num_fine = num_wrong = 0;
    for (unsigned seed = 0; seed < kNumSeeds; ++seed) {
      const MovedBatch batch = moved_batch(*problem, seed);
      const auto start = Clock::now();
      const registration::BatchResult result = find(*problem, *problem, batch);
      seconds.push_back(seconds_since(start));
      if (!result.found()) continue;
      const registration::BatchCandidate& best = result.candidates.front();
      const test::PoseDistance coarse = error_of(best.coarse_guess, *problem, batch);
      const test::PoseDistance fine = error_of(best.map_from_batch, *problem, batch);
      const bool is_right = fine.translation <= 0.1 && fine.rotation_deg <= 0.5;
      num_coarse += coarse.translation <= 2 && coarse.rotation_deg <= 5;
      num_fine += is_right;
      num_wrong += !is_right;
      max_m = std::max(max_m, fine.translation);
    }
    state.SetIterationTime(median_of(seconds));
  }
  state.counters["within_2m_5deg"] = num_coarse / kNumSeeds;
  state.counters["within_10cm_0.5deg"] = num_fine / kNumSeeds;
  state.counters["wrong"] = num_wrong;
  state.counters["max_m"] = max_m;
}

// From scans in memory with their odometry to the pose of each: the row's time is the median over the batches.
void localize_batches(benchmark::State& state, const CoarseProblem* (*get_problem)()) {
  const CoarseProblem* problem = get_problem();
  if (!problem) return state.SkipWithError(kNoDrive);
  registration::Localizer localizer(problem->map);
  double num_scans = 0, num_right = 0, num_wrong = 0;
  for (auto _ : state) {
    std::vector<double> seconds;
    num_scans = num_right = num_wrong = 0;
    for (unsigned seed = 0; seed < kNumSeeds; ++seed) {
      const MovedBatch batch = moved_batch(*problem, seed);
      const auto start = Clock::now();
      for (std::size_t i = batch.first; i < batch.first + batch.count; ++i) {
        localizer.add({problem->scans[i]->positions, batch.moved_from_odometry * problem->odometry_from_scan[i],
                       i > batch.first});
      }
      const registration::SequenceResult result = localizer.finish();
      seconds.push_back(seconds_since(start));
      for (std::size_t i = 0; i < result.scans.size(); ++i) {
        ++num_scans;
        if (!result.scans[i].found()) continue;
        const test::PoseDistance error =
            test::distance_between(result.scans[i].map_from_scan, problem->map_from_scan[batch.first + i]);
        const bool is_right = error.translation <= 0.1 && error.rotation_deg <= 0.5;
        num_right += is_right;
        num_wrong += !is_right;
      }
    }
    state.SetIterationTime(median_of(seconds));
  }
  state.counters["within_10cm_0.5deg"] = num_right / num_scans;
  state.counters["wrong"] = num_wrong;
}

// Batches of one place in the map of another: none may be accepted.
void refuse_batches(benchmark::State& state, const CoarseProblem* (*get_place)(), const CoarseProblem* (*get_scans)()) {
  const CoarseProblem* place = get_place();
  const CoarseProblem* problem = get_scans();
  if (!place || !problem) return state.SkipWithError(kNoDrive);
  double num_accepted = 0, max_agreement = 0;
  for (auto _ : state) {
    num_accepted = 0;
    for (unsigned seed = 0; seed < kNumSeeds; ++seed) {
      const registration::BatchResult result = find(*place, *problem, moved_batch(*problem, seed));
      num_accepted += result.found();
      if (!result.candidates.empty()) max_agreement = std::max(max_agreement, result.candidates.front().agreement);
    }
  }
  state.counters["accepted"] = num_accepted;
  state.counters["max_agreement"] = max_agreement;
}

void set_options(benchmark::internal::Benchmark* row) {
  row->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(1);
}
BENCHMARK_CAPTURE(find_batches, drive, drive_problem)->Apply(set_options);
BENCHMARK_CAPTURE(find_batches, kitti00, residential_problem)->Apply(set_options);
BENCHMARK_CAPTURE(localize_batches, drive, drive_problem)->Apply(set_options);
BENCHMARK_CAPTURE(localize_batches, kitti00, residential_problem)->Apply(set_options);
BENCHMARK_CAPTURE(refuse_batches, kitti00_in_drive, drive_problem, residential_problem)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);
BENCHMARK_CAPTURE(refuse_batches, drive_in_kitti00, residential_problem, drive_problem)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

}  // namespace
}  // namespace vdbmap::benchmarks

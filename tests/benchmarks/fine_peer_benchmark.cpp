// SPDX-License-Identifier: GPL-3.0-or-later
// The peers of `align_scan`: Open3D's point-to-plane ICP against the means and normals of the same map's 10 cm voxels,
// from the same thinned points and guesses; correspondences first within 1 m, then within 0.3 m.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <omp.h>
#include <open3d/geometry/KDTreeFlann.h>
#include <open3d/pipelines/registration/Registration.h>

#include "registration/fine/point_to_plane.h"
#include "tests/benchmarks/drive.h"
#include "tests/benchmarks/fine_problem.h"
#include "tests/benchmarks/open3d_cloud.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap::benchmarks {
namespace {

namespace o3d = open3d::pipelines::registration;
using Cloud = open3d::geometry::PointCloud;

constexpr std::array kMaxDistances = {1.0, 0.3};  // [m]

Cloud thinned(const PointCloud& scan) {
  const registration::FineOptions options;
  return Cloud(registration::sample_points(scan.positions, options.fine_spacing, options.range));
}

// Open3D's own loop, which makes its kd-tree of the whole map anew in each call; so one call, not two.
Eigen::Matrix4d register_icp(const Cloud& scan, const Cloud& target, const Eigen::Matrix4d& guess) {
  return o3d::RegistrationICP(scan, target, kMaxDistances.front(), guess, o3d::TransformationEstimationPointToPlane())
      .transformation_;
}

// As in Open3D's RegistrationResult.
struct Matches {
  o3d::CorrespondenceSet pairs;
  double fitness = 0;  // share of the points that have a match
  double rmse = 0;     // [m]
};

Matches match(const Cloud& scan, const open3d::geometry::KDTreeFlann& tree, double max_distance) {
  std::vector<std::pair<int, double>> nearest(scan.points_.size(), {-1, 0});
  parallel_ranges(nearest.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<int> index(1);
    std::vector<double> squared(1);
    for (std::size_t i = begin; i < end; ++i) {
      if (tree.SearchHybrid(scan.points_[i], max_distance, 1, index, squared) > 0) nearest[i] = {index[0], squared[0]};
    }
  });
  Matches matches;
  double squared_sum = 0;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    if (nearest[i].first < 0) continue;
    matches.pairs.emplace_back(static_cast<int>(i), nearest[i].first);
    squared_sum += nearest[i].second;
  }
  const auto count = static_cast<double>(matches.pairs.size());
  matches.fitness = count / static_cast<double>(nearest.size());
  matches.rmse = std::sqrt(squared_sum / std::max(1.0, count));
  return matches;
}

bool are_alike(const Matches& a, const Matches& b, const o3d::ICPConvergenceCriteria& criteria) {
  return std::abs(a.fitness - b.fitness) < criteria.relative_fitness_ &&
         std::abs(a.rmse - b.rmse) < criteria.relative_rmse_;
}

// The same loop and stopping rule over Open3D's parts with a kd-tree that is kept, as who aligns many scans would.
Eigen::Matrix4d register_with_kept_tree(Cloud scan, const Cloud& target, const open3d::geometry::KDTreeFlann& tree,
                                        const Eigen::Matrix4d& guess) {
  const o3d::TransformationEstimationPointToPlane estimation;
  const o3d::ICPConvergenceCriteria criteria;
  Eigen::Matrix4d pose = guess;
  scan.Transform(guess);
  for (const double max_distance : kMaxDistances) {
    Matches matches = match(scan, tree, max_distance);
    bool rests = matches.pairs.empty();
    for (int i = 0; i < criteria.max_iteration_ && !rests; ++i) {
      const Eigen::Matrix4d step = estimation.ComputeTransformation(scan, target, matches.pairs);
      pose = step * pose;
      scan.Transform(step);
      Matches next = match(scan, tree, max_distance);
      rests = are_alike(matches, next, criteria) || next.pairs.empty();
      matches = std::move(next);
    }
  }
  return pose;
}

// The frame of the peer is the map's local frame.
template <typename Register>
void measure_peer(benchmark::State& state, const FineProblem& problem, const Register& find) {
  const Eigen::Translation3d local_from_map(-problem.map.frame.anchor);
  const ThreadLimit limit(static_cast<std::size_t>(state.range(0)));
  omp_set_num_threads(static_cast<int>(state.range(0)));
  measure_alignment(state, problem, [&](const PointCloud& scan, const Eigen::Isometry3d& guess) {
    const Eigen::Isometry3d local_guess = local_from_map * guess;
    return Eigen::Isometry3d(local_from_map.inverse() * Eigen::Isometry3d(find(thinned(scan), local_guess.matrix())));
  });
}

void open3d_icp(benchmark::State& state) {
  const FineProblem* problem = fine_problem();
  if (!problem) return state.SkipWithError(kNoDrive);
  const Cloud target = open3d_cloud(problem->map.finest());
  measure_peer(state, *problem,
               [&](const Cloud& scan, const Eigen::Matrix4d& guess) { return register_icp(scan, target, guess); });
}
BENCHMARK(open3d_icp)->Apply(set_fine_options)->Repetitions(3);

void open3d_icp_with_kept_tree(benchmark::State& state) {
  const FineProblem* problem = fine_problem();
  if (!problem) return state.SkipWithError(kNoDrive);
  const Cloud target = open3d_cloud(problem->map.finest());
  const open3d::geometry::KDTreeFlann tree(target);
  measure_peer(state, *problem, [&](const Cloud& scan, const Eigen::Matrix4d& guess) {
    return register_with_kept_tree(scan, target, tree, guess);
  });
}
BENCHMARK(open3d_icp_with_kept_tree)->Apply(set_fine_options)->Repetitions(3);

void open3d_kd_tree(benchmark::State& state) {
  const FineProblem* problem = fine_problem();
  if (!problem) return state.SkipWithError(kNoDrive);
  const Cloud target = open3d_cloud(problem->map.finest());
  for (auto _ : state) benchmark::DoNotOptimize(open3d::geometry::KDTreeFlann(target));
  state.counters["points"] = static_cast<double>(target.points_.size());
}
BENCHMARK(open3d_kd_tree)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(1)
    ->Repetitions(5)
    ->DisplayAggregatesOnly();

}  // namespace
}  // namespace vdbmap::benchmarks

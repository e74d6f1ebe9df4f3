// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/odometry_trust.h"

#include <algorithm>
#include <cstddef>
#include <numbers>

#include <Eigen/Cholesky>

namespace vdbmap::registration {
namespace {

// Scans in a row that may have gone astray; more of them that agree are as likely right.
constexpr std::size_t kMaxAstray = 3;

// Squared distance between map and odometry over a way, by what both may err.
struct Disagreement {
  double rotation;
  double translation;
};

// A run of scans that odometry leads through without a gap.
struct Run {
  std::span<const SequencePose> scans;
  std::vector<Eigen::Isometry3d> first_from_scan;
  std::vector<double> ways;        // [m] from the first
  std::vector<std::size_t> known;  // scans that the map says something of
};

Run run_of(std::span<const SequencePose> scans) {
  Run run{scans, {Eigen::Isometry3d::Identity()}, {0}, {}};
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (i > 0) {
      run.first_from_scan.push_back(run.first_from_scan.back() * *scans[i].previous_from_scan);
      run.ways.push_back(run.ways.back() + scans[i].previous_from_scan->translation().norm());
    }
    if (scans[i].in_map) run.known.push_back(i);
  }
  return run;
}

double squared(double x) { return x * x; }

double squared_distance(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance) {
  return error.dot(covariance.ldlt().solve(error));
}

// Errors of steps add up as in a random walk; those of their turns move what comes after, a third of the squared way
// each on average.
Disagreement disagreement(const Run& run, std::size_t from, std::size_t to, const JointOptions& options) {
  const Eigen::Isometry3d step = run.first_from_scan[from].inverse() * run.first_from_scan[to];
  const PoseEstimate predicted = carried(*run.scans[from].in_map, step);
  const PoseEstimate& in_map = *run.scans[to].in_map;
  const auto num_steps = static_cast<double>(to - from);
  const double turn = num_steps * squared(options.odometry_rotation_deg * std::numbers::pi / 180);
  const double lever = squared(run.ways[to] - run.ways[from]) / 3;
  const double shift = num_steps * squared(options.odometry_translation) + turn * lever;

  const Matrix6d covariance = predicted.covariance + in_map.covariance;
  const Eigen::AngleAxisd angle(in_map.map_from_scan.linear() * predicted.map_from_scan.linear().transpose());
  const Eigen::Vector3d moved = in_map.map_from_scan.translation() - predicted.map_from_scan.translation();
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  return {squared_distance(angle.angle() * angle.axis(), covariance.topLeftCorner<3, 3>() + turn * identity),
          squared_distance(moved, covariance.bottomRightCorner<3, 3>() + shift * identity)};
}

// Geman & McClure's kernel, which counts: near 0 what agrees, near 1 a slip, however far.
double cost_of_slip(const Disagreement& way, double scale) {
  const double sum = way.rotation + way.translation;
  return sum / (sum + scale * scale);
}

// Of the scans that the map knows those that did not go astray: the cheapest chain, where each scan left out costs as
// much as a slip. On equal terms the map is believed.
std::vector<std::size_t> scans_in_place(const Run& run, const JointOptions& options) {
  const std::size_t size = run.known.size();
  std::vector<double> costs(size);
  std::vector<std::size_t> previous(size);
  for (std::size_t b = 0; b < size; ++b) {
    costs[b] = static_cast<double>(b);  // the first in place
    previous[b] = b;
    for (std::size_t a = b; a-- > 0 && b - a <= kMaxAstray + 1;) {
      const Disagreement way = disagreement(run, run.known[a], run.known[b], options);
      const double cost = costs[a] + static_cast<double>(b - a - 1) + cost_of_slip(way, options.outlier_scale);
      if (cost >= costs[b]) continue;
      costs[b] = cost;
      previous[b] = a;
    }
  }
  std::size_t last = size - 1;
  for (std::size_t b = size; b-- > 0;) {
    if (costs[b] + static_cast<double>(size - 1 - b) < costs[last] + static_cast<double>(size - 1 - last)) last = b;
  }
  std::vector<std::size_t> in_place = {run.known[last]};
  for (; previous[last] != last; last = previous[last]) in_place.push_back(run.known[previous[last]]);
  std::reverse(in_place.begin(), in_place.end());
  return in_place;
}

// Of an error: 1 up to the scale, falling with its fourth power beyond, faster than its square grows.
double weight_of(double squared_error, double scale) {
  return squared_error > scale * scale ? squared(scale * scale / squared_error) : 1;
}

void weigh_ways(const Run& run, std::span<const std::size_t> in_place, const JointOptions& options,
                std::span<StepWeights> weights) {
  for (std::size_t k = 1; k < in_place.size(); ++k) {
    const Disagreement way = disagreement(run, in_place[k - 1], in_place[k], options);
    const StepWeights weight{weight_of(way.rotation, options.outlier_scale),
                             weight_of(way.translation, options.outlier_scale)};
    for (std::size_t i = in_place[k - 1] + 1; i <= in_place[k]; ++i) weights[i] = weight;
  }
}

// Every scan by odometry from the nearest scan in place.
void place_all(const Run& run, std::span<const std::size_t> in_place, std::span<Eigen::Isometry3d> start) {
  std::size_t k = 0;
  for (std::size_t i = 0; i < run.scans.size(); ++i) {
    while (k + 1 < in_place.size() && in_place[k + 1] + in_place[k] <= 2 * i) ++k;
    const std::size_t nearest = in_place[k];
    const Eigen::Isometry3d& map_from_nearest = run.scans[nearest].in_map->map_from_scan;
    start[i] = i == nearest ? map_from_nearest
                            : map_from_nearest * (run.first_from_scan[nearest].inverse() * run.first_from_scan[i]);
  }
}

}  // namespace

OdometryTrust trust_odometry(std::span<const SequencePose> scans, const JointOptions& options) {
  OdometryTrust trust;
  trust.weights.resize(scans.size());
  for (const SequencePose& scan : scans) trust.start.push_back(scan.map_from_scan_guess);
  for (std::size_t begin = 0; begin < scans.size();) {
    std::size_t end = begin + 1;
    while (end < scans.size() && scans[end].previous_from_scan) ++end;
    const Run run = run_of(scans.subspan(begin, end - begin));
    if (!run.known.empty()) {
      const std::vector<std::size_t> in_place = scans_in_place(run, options);
      weigh_ways(run, in_place, options, std::span(trust.weights).subspan(begin, end - begin));
      place_all(run, in_place, std::span(trust.start).subspan(begin, end - begin));
    }
    begin = end;
  }
  return trust;
}

}  // namespace vdbmap::registration

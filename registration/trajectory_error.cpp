// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/trajectory_error.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

namespace vdbmap::registration {
namespace {

constexpr double kDegPerRad = 180 / std::numbers::pi;

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*std::max_element(values.begin(), middle) + *middle) / 2;
}

ErrorSummary summary_of(const std::vector<std::optional<PoseError>>& poses, double PoseError::*member) {
  std::vector<double> values;
  for (const std::optional<PoseError>& pose : poses) {
    if (pose) values.push_back((*pose).*member);
  }
  return summarize(std::move(values));
}

}  // namespace

PoseError pose_error(const Eigen::Isometry3d& map_from_estimate, const Eigen::Isometry3d& map_from_truth) {
  const Eigen::Vector3d shift = map_from_estimate.translation() - map_from_truth.translation();
  const Eigen::Quaterniond truth(map_from_truth.linear());
  const Eigen::Quaterniond estimate(map_from_estimate.linear());
  // By quaternions: the arc cosine of a trace cannot tell angles below 1e-6 degrees from zero.
  return {shift.head<2>().norm(), shift.z(), shift.norm(), truth.angularDistance(estimate) * kDegPerRad};
}

ErrorSummary summarize(std::vector<double> values) {
  if (values.empty()) return {};
  double sum = 0;
  double sum_of_squares = 0;
  for (double& value : values) {
    value = std::abs(value);
    sum += value;
    sum_of_squares += value * value;
  }
  const auto count = static_cast<double>(values.size());
  ErrorSummary summary;
  summary.mean = sum / count;
  summary.rms = std::sqrt(sum_of_squares / count);
  summary.max = *std::max_element(values.begin(), values.end());
  summary.median = median_of(values);
  return summary;
}

TrajectoryError evaluate_trajectory(const Trajectory& estimate, const Trajectory& truth) {
  if (estimate.size() != truth.size()) {
    throw std::invalid_argument("cannot compare " + std::to_string(estimate.size()) + " estimated poses with " +
                                std::to_string(truth.size()) + " true ones");
  }
  TrajectoryError error;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    std::optional<PoseError>& pose = error.poses.emplace_back();
    if (!truth.map_from_scan[i]) continue;
    ++error.num_judged;
    if (estimate.map_from_scan[i]) {
      pose = pose_error(*estimate.map_from_scan[i], *truth.map_from_scan[i]);
    } else {
      ++error.num_missing;
    }
  }
  error.xy = summary_of(error.poses, &PoseError::xy);
  error.z = summary_of(error.poses, &PoseError::z);
  error.translation = summary_of(error.poses, &PoseError::translation);
  error.rotation_deg = summary_of(error.poses, &PoseError::rotation_deg);
  return error;
}

double success_rate(const TrajectoryError& error, const SuccessThreshold& threshold) {
  if (error.num_judged == 0) return 0;
  const auto is_success = [&](const std::optional<PoseError>& pose) {
    return pose && pose->translation <= threshold.translation && pose->rotation_deg <= threshold.rotation_deg;
  };
  const auto num_successes = std::count_if(error.poses.begin(), error.poses.end(), is_success);
  return static_cast<double>(num_successes) / static_cast<double>(error.num_judged);
}

}  // namespace vdbmap::registration

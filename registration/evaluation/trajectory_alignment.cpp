// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/evaluation/trajectory_alignment.h"

#include <stdexcept>
#include <string>
#include <vector>

#include "vdbmap/core/nearest_rotation.h"

namespace vdbmap::registration {
namespace {

constexpr std::size_t kMinPositions = 3;

Eigen::Vector3d mean_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point - points.front();  // UTM coordinates keep their digits
  return points.front() + sum / static_cast<double>(points.size());
}

// Umeyama 1991, equations 38 to 42 with scale 1.
Eigen::Isometry3d rigid_fit(const std::vector<Eigen::Vector3d>& source, const std::vector<Eigen::Vector3d>& target) {
  const Eigen::Vector3d source_mean = mean_of(source);
  const Eigen::Vector3d target_mean = mean_of(target);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < source.size(); ++i) {
    covariance += (target[i] - target_mean) * (source[i] - source_mean).transpose();
  }
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  target_from_source.linear() = nearest_rotation(covariance);
  target_from_source.translation() = target_mean - target_from_source.linear() * source_mean;
  return target_from_source;
}

}  // namespace

std::optional<Eigen::Isometry3d> align_trajectory(const Trajectory& estimate, const Trajectory& truth) {
  if (estimate.size() != truth.size()) {
    throw std::invalid_argument("cannot align " + std::to_string(estimate.size()) + " estimated poses to " +
                                std::to_string(truth.size()) + " true ones");
  }
  std::vector<Eigen::Vector3d> estimated_positions;
  std::vector<Eigen::Vector3d> true_positions;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (!estimate.map_from_scan[i] || !truth.map_from_scan[i]) continue;
    estimated_positions.emplace_back(estimate.map_from_scan[i]->translation());
    true_positions.emplace_back(truth.map_from_scan[i]->translation());
  }
  if (true_positions.size() < kMinPositions) return std::nullopt;
  return rigid_fit(estimated_positions, true_positions);
}

Trajectory moved(const Trajectory& trajectory, const Eigen::Isometry3d& target_from_map) {
  Trajectory result = trajectory;
  for (std::optional<Eigen::Isometry3d>& pose : result.map_from_scan) {
    if (pose) pose = target_from_map * *pose;
  }
  return result;
}

}  // namespace vdbmap::registration

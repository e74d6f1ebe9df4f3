// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/joint_refinement.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Cholesky>
#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include "registration/fine/odometry_trust.h"
#include "vdbmap/core/option_check.h"

namespace vdbmap::registration {
namespace {

constexpr double kUnknown = 1e6;  // variance of what nothing determines

// A motion of a scan from the pose that the search starts at, as the solver sees it: rotation vector, translation.
using Motion = std::array<double, 6>;

// The square root of the inverse of a covariance: whitens a residual.
Matrix6d whitening(const Matrix6d& covariance) {
  const Matrix6d information = covariance.ldlt().solve(Matrix6d::Identity());
  return Eigen::LLT<Matrix6d>(0.5 * (information + information.transpose())).matrixU();
}

template <typename T>
std::array<T, 4> quaternion_of(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond q(rotation);
  return {T(q.w()), T(q.x()), T(q.y()), T(q.z())};
}

// The rotation of a scan after a motion: exp(w) R.
template <typename T>
std::array<T, 4> moved_rotation(const T* motion, const Eigen::Matrix3d& rotation) {
  std::array<T, 4> step, moved;
  const std::array<T, 4> start = quaternion_of<T>(rotation);
  ceres::AngleAxisToQuaternion(motion, step.data());
  ceres::QuaternionProduct(step.data(), start.data(), moved.data());
  return moved;
}

template <typename T>
std::array<T, 4> inverse_of(const std::array<T, 4>& q) {
  return {q[0], -q[1], -q[2], -q[3]};
}

// The motion from one pose to another, as in moved_by(): log(R_b R_a^-1) and t_b - t_a.
template <typename T>
void difference(const std::array<T, 4>& rotation_a, const T* translation_a, const std::array<T, 4>& rotation_b,
                const T* translation_b, T* motion) {
  std::array<T, 4> turn;
  const std::array<T, 4> back = inverse_of(rotation_a);
  ceres::QuaternionProduct(rotation_b.data(), back.data(), turn.data());
  ceres::QuaternionToAngleAxis(turn.data(), motion);
  for (int i = 0; i < 3; ++i) motion[3 + i] = translation_b[i] - translation_a[i];
}

// How far a scan is from where the map alone puts it.
struct MapFactor {
  Eigen::Isometry3d start;
  Eigen::Isometry3d in_map;
  Matrix6d whiten;

  template <typename T>
  bool operator()(const T* motion, T* residual) const {
    const std::array<T, 4> rotation = moved_rotation(motion, start.linear());
    const std::array<T, 4> rotation_in_map = quaternion_of<T>(in_map.linear());
    std::array<T, 3> translation, translation_in_map;
    for (int i = 0; i < 3; ++i) {
      translation[static_cast<std::size_t>(i)] = motion[3 + i] + start.translation()[i];
      translation_in_map[static_cast<std::size_t>(i)] = T(in_map.translation()[i]);
    }
    Eigen::Matrix<T, 6, 1> error;
    difference(rotation_in_map, translation_in_map.data(), rotation, translation.data(), error.data());
    Eigen::Map<Eigen::Matrix<T, 6, 1>>(residual, 6) = whiten.cast<T>() * error;
    return true;
  }
};

// How far a step is from what odometry says: previous_from_scan against T_previous^-1 T_scan.
struct OdometryFactor {
  Eigen::Isometry3d previous_start;
  Eigen::Isometry3d start;
  Eigen::Isometry3d previous_from_scan;
  double per_radian;
  double per_metre;

  template <typename T>
  bool operator()(const T* previous_motion, const T* motion, T* residual) const {
    const std::array<T, 4> back = inverse_of(moved_rotation(previous_motion, previous_start.linear()));
    const std::array<T, 4> rotation = moved_rotation(motion, start.linear());
    std::array<T, 3> step, step_in_previous;
    for (int i = 0; i < 3; ++i) {
      step[static_cast<std::size_t>(i)] =
          motion[3 + i] - previous_motion[3 + i] + (start.translation()[i] - previous_start.translation()[i]);
    }
    ceres::QuaternionRotatePoint(back.data(), step.data(), step_in_previous.data());
    std::array<T, 4> turn;
    ceres::QuaternionProduct(back.data(), rotation.data(), turn.data());
    const std::array<T, 4> turn_of_odometry = quaternion_of<T>(previous_from_scan.linear());
    std::array<T, 3> translation_of_odometry;
    for (int i = 0; i < 3; ++i) {
      translation_of_odometry[static_cast<std::size_t>(i)] = T(previous_from_scan.translation()[i]);
    }
    difference(turn_of_odometry, translation_of_odometry.data(), turn, step_in_previous.data(), residual);
    for (int i = 0; i < 3; ++i) {
      residual[i] *= per_radian;
      residual[3 + i] *= per_metre;
    }
    return true;
  }
};

// Which scans anything is known of: those in a run of odometry steps with at least one scan that the map knows.
std::vector<bool> held_scans(std::span<const SequencePose> sequence) {
  std::vector<bool> held(sequence.size(), false);
  for (std::size_t begin = 0; begin < sequence.size();) {
    std::size_t end = begin + 1;
    while (end < sequence.size() && sequence[end].previous_from_scan) ++end;
    bool is_held = false;
    for (std::size_t i = begin; i < end; ++i) is_held = is_held || sequence[i].in_map.has_value();
    for (std::size_t i = begin; i < end; ++i) held[i] = is_held;
    begin = end;
  }
  return held;
}

void add_map_factor(ceres::Problem& problem, const PoseEstimate& in_map, const Eigen::Isometry3d& start, Motion& motion,
                    double outlier_scale) {
  auto* factor = new MapFactor{start, in_map.map_from_scan, whitening(in_map.covariance)};
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<MapFactor, 6, 6>(factor),
                           new ceres::CauchyLoss(outlier_scale), motion.data());
}

void add_factors(ceres::Problem& problem, std::span<const SequencePose> sequence, const std::vector<bool>& held,
                 const OdometryTrust& trust, std::vector<Motion>& motions, const JointOptions& options) {
  const double per_radian = 180 / std::numbers::pi / options.odometry_rotation_deg;
  const double per_metre = 1 / options.odometry_translation;
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    if (!held[i]) continue;
    const SequencePose& scan = sequence[i];
    if (scan.in_map) add_map_factor(problem, *scan.in_map, trust.start[i], motions[i], options.outlier_scale);
    if (i == 0 || !scan.previous_from_scan) continue;
    const StepWeights& weights = trust.weights[i];
    auto* factor =
        new OdometryFactor{trust.start[i - 1], trust.start[i], *scan.previous_from_scan,
                           std::sqrt(weights.rotation) * per_radian, std::sqrt(weights.translation) * per_metre};
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<OdometryFactor, 6, 6, 6>(factor), nullptr,
                             motions[i - 1].data(), motions[i].data());
  }
}

void solve(ceres::Problem& problem) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 30;
  options.function_tolerance = 1e-12;
  options.parameter_tolerance = 1e-10;
  options.num_threads = 1;  // one order of sums
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
}

std::vector<Matrix6d> covariances_of(ceres::Problem& problem, const std::vector<bool>& held,
                                     const std::vector<Motion>& motions) {
  std::vector<std::pair<const double*, const double*>> blocks;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    if (held[i]) blocks.emplace_back(motions[i].data(), motions[i].data());
  }
  std::vector<Matrix6d> covariances(motions.size(), kUnknown * Matrix6d::Identity());
  if (blocks.empty()) return covariances;

  ceres::Covariance::Options options;
  options.num_threads = 1;
  ceres::Covariance covariance(options);
  if (!covariance.Compute(blocks, &problem)) return covariances;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    if (held[i]) covariance.GetCovarianceBlock(motions[i].data(), motions[i].data(), covariances[i].data());
  }
  return covariances;
}

}  // namespace

void JointOptions::check() const {
  require(odometry_translation > 0, "odometry_translation", odometry_translation, "more than 0");
  require(odometry_rotation_deg > 0, "odometry_rotation_deg", odometry_rotation_deg, "more than 0");
  require(outlier_scale > 0, "outlier_scale", outlier_scale, "more than 0");
}

std::vector<PoseEstimate> refine_jointly(std::span<const SequencePose> sequence, const JointOptions& options) {
  options.check();
  std::vector<Motion> motions(sequence.size(), Motion{});
  const std::vector<bool> held = held_scans(sequence);
  const OdometryTrust trust = trust_odometry(sequence, options);
  ceres::Problem problem;
  add_factors(problem, sequence, held, trust, motions, options);
  if (problem.NumResidualBlocks() > 0) solve(problem);

  const std::vector<Matrix6d> covariances = covariances_of(problem, held, motions);
  std::vector<PoseEstimate> poses(sequence.size());
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    const Eigen::Map<const Vector6d> motion(motions[i].data());
    poses[i] = {moved_by(trust.start[i], motion), covariances[i]};
  }
  return poses;
}

}  // namespace vdbmap::registration

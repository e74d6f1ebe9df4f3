// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/solver_step.h"

#include <ceres/tiny_solver.h>

#include "registration/fine/plane_residual.h"

namespace vdbmap::registration {
namespace {

// TinySolver counts from 1 to below its limit: 2 is one step.
constexpr int kOneStep = 2;
constexpr int kUntilOneIsTaken = 12;  // damping doubles its own growth: by 2^55 after ten rejections

// PlaneResiduals that remember the first motion tried: the solver itself tells only of steps that it took.
class RecordedResiduals {
 public:
  using Scalar = double;
  static constexpr int NUM_RESIDUALS = PlaneResiduals::NUM_RESIDUALS;
  static constexpr int NUM_PARAMETERS = PlaneResiduals::NUM_PARAMETERS;

  RecordedResiduals(const PlaneResiduals& residuals, Vector6d& first_tried)
      : residuals_(&residuals), first_tried_(&first_tried) {}

  int NumResiduals() const { return residuals_->NumResiduals(); }

  bool operator()(const double* motion, double* residuals, double* jacobian) const {
    const bool is_trial = jacobian == nullptr;
    if (is_trial && first_tried_->isZero(0)) *first_tried_ = Eigen::Map<const Vector6d>(motion);
    return (*residuals_)(motion, residuals, jacobian);
  }

 private:
  const PlaneResiduals* residuals_;
  Vector6d* first_tried_;
};

Vector6d solve(const PlaneResiduals& residuals, int max_num_iterations, Vector6d& first_tried) {
  ceres::TinySolver<RecordedResiduals> solver;
  solver.options.max_num_iterations = max_num_iterations;
  Vector6d motion = Vector6d::Zero();
  solver.Solve(RecordedResiduals(residuals, first_tried), &motion);
  return motion;
}

}  // namespace

SolverStep step_towards_planes(std::span<const PlaneMatch> matches, std::span<const double> weights,
                               const Eigen::Isometry3d& local_from_scan) {
  const PlaneResiduals residuals(matches, weights, local_from_scan);
  SolverStep step;
  step.motion = solve(residuals, kOneStep, step.proposed);
  step.was_rejected = step.motion.isZero(0) && !step.proposed.isZero(0);
  Vector6d first_tried = step.proposed;
  if (step.was_rejected) step.motion = solve(residuals, kUntilOneIsTaken, first_tried);
  return step;
}

}  // namespace vdbmap::registration

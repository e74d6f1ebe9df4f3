// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/change/surface_comparison.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>

#include "vdbmap/core/plane_solver.h"

namespace vdbmap {
namespace {

constexpr double kLeastPlanarity = 0.35;
constexpr double kMostThickness = 0.2;         // of a plane: variance across it, as a share of the smaller one along it
constexpr double kFewestPoints = 8;            // of a plane
constexpr double kParallel = 0.94;             // cosine of 20 degrees
constexpr double kSlope = 0.03;                // tangent of what two parallel normals may be off, 1.7 degrees
constexpr double kFewPoints = 8;               // of which a covariance says little
constexpr double kUniformVariance = 1.0 / 12;  // of a voxel filled evenly, in squares of its edge

// Where a survival function that falls from 1 reaches a share.
template <typename Survival>
double quantile_of(const Survival& survival, double share) {
  double low = 0, high = 2000;
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (survival(middle) > share ? low : high) = middle;
  }
  return low;
}

double two_sided_quantile(double share) {
  return quantile_of([](double x) { return std::erfc(x / std::numbers::sqrt2); }, share);
}

// Of chi squared with 3 degrees of freedom.
double chi_squared_quantile(double share) {
  const auto survival = [](double x) {
    return std::erfc(std::sqrt(x / 2)) + std::sqrt(2 * x / std::numbers::pi) * std::exp(-x / 2);
  };
  return quantile_of(survival, share);
}

double along(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& direction) {
  return std::max(0.0, direction.dot(covariance * direction));
}

// Of two planes: only what all of their points say together.
Distance between_planes(const LocalSurface& around, const LocalSurface& other, const SignificanceLimits& limits) {
  const double sign = around.normal.dot(other.normal) < 0 ? -1 : 1;
  const Eigen::Vector3d normal = (other.normal + sign * around.normal).normalized();
  const Eigen::Vector3d apart = around.mean - other.mean;
  const double distance = normal.dot(apart);
  const double aside = std::max(0.0, apart.squaredNorm() - distance * distance);
  const double variance = other.thickness / other.count + around.thickness / around.count + kSlope * kSlope * aside +
                          limits.common_variance;
  return {std::abs(distance) / std::sqrt(variance), limits.sigmas, true};
}

// The thickness and not its share of one point: whether the voxel may be a part of the surface is asked.
Distance from_plane(const LocalSurface& voxel, const LocalSurface& other, const SignificanceLimits& limits) {
  const double distance = other.normal.dot(voxel.mean - other.mean);
  const double variance =
      other.thickness + along(voxel.covariance, other.normal) / voxel.count + limits.common_variance;
  return {std::abs(distance) / std::sqrt(variance), limits.sigmas, false};
}

Distance from_cloud(const LocalSurface& voxel, const LocalSurface& other, double voxel_size,
                    const SignificanceLimits& limits) {
  Eigen::Matrix3d spread = other.covariance + voxel.covariance;
  const double uniform = kUniformVariance * voxel_size * voxel_size;
  double least = limits.common_variance;
  if (other.count < kFewPoints) least += uniform;
  if (voxel.count < kFewPoints) least += uniform;
  spread.diagonal().array() += least;
  const Eigen::Vector3d apart = voxel.mean - other.mean;
  return {std::sqrt(apart.dot(spread.llt().solve(apart))), limits.radius, false};
}

}  // namespace

bool LocalSurface::is_planar() const {
  if (planarity < kLeastPlanarity || count < kFewestPoints) return false;
  // Of the eigenvalues l1 >= l2 >= l3 the sum, l3 and (l2 - l3) / l1 are known. Two planes that meet have a planarity
  // too.
  const double largest = (covariance.trace() - 2 * thickness) / (1 + planarity);
  return thickness <= kMostThickness * (planarity * largest + thickness);
}

LocalSurface surface_of(const PointSums& sums) {
  const Moments moments = moments_of(sums);
  LocalSurface surface;
  surface.count = static_cast<double>(moments.count);
  surface.mean = moments.mean;
  surface.covariance = moments.covariance();
  const Eigen::Matrix3d& c = surface.covariance;
  const SolvedPlane<double> plane =
      solve_plane(Symmetric3<double>{c(0, 0), c(1, 1), c(2, 2), c(0, 1), c(0, 2), c(1, 2)});
  surface.normal = {plane.x, plane.y, plane.z};
  surface.planarity = plane.planarity;
  surface.thickness = along(c, surface.normal);
  return surface;
}

SignificanceLimits::SignificanceLimits(double pose_sigma, double range_sigma, double significance)
    : common_variance(pose_sigma * pose_sigma + range_sigma * range_sigma),
      sigmas(two_sided_quantile(significance)),
      radius(std::sqrt(chi_squared_quantile(significance))) {}

Distance distance_between(const LocalSurface& voxel, const LocalSurface& around, const LocalSurface& other,
                          double voxel_size, const SignificanceLimits& limits) {
  if (!other.is_planar()) return from_cloud(voxel, other, voxel_size, limits);
  const bool are_parallel = around.is_planar() && std::abs(around.normal.dot(other.normal)) >= kParallel;
  return are_parallel ? between_planes(around, other, limits) : from_plane(voxel, other, limits);
}

Distance distance_of_edges(const VoxelPoints& voxel, const VoxelPoints& beside, double voxel_size,
                           const SignificanceLimits& limits) {
  const double moved = std::max(0.0, 2 * (voxel.mean - beside.mean).norm() - voxel_size);
  const double uniform = kUniformVariance * voxel_size * voxel_size;
  const double variance = uniform * (1 / voxel.count + 1 / beside.count) + limits.common_variance;
  return {moved / std::sqrt(variance), limits.sigmas, false};
}

double confidence_of(const Distance& distance) {
  return 0.5 * std::erfc((distance.limit - distance.sigmas) / std::numbers::sqrt2);
}

}  // namespace vdbmap

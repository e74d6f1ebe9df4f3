// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/change/held_surface.h"

#include <Eigen/LU>

#include "vdbmap/core/eigen_features.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap {
namespace {

constexpr double kMinPlanarity = 0.3;       // below, the direction of a normal says nothing
constexpr std::uint32_t kMinOwnPoints = 6;  // for a normal of the voxel's own points
constexpr double kPriorPoints = 3;
constexpr double kLeastSigma = 0.003;  // [m] what a scanner tells apart at best

// The covariance of points spread evenly over a cube has s^2 / 12 on its diagonal.
Eigen::Matrix3d shrunk_covariance(const VoxelRecord& record, double voxel_size) {
  const double count = record.count;
  const double even = voxel_size * voxel_size / 12;
  const Eigen::Matrix3d sum = count * covariance_of(record) + kPriorPoints * even * Eigen::Matrix3d::Identity();
  return sum / (count + kPriorPoints) + kLeastSigma * kLeastSigma * Eigen::Matrix3d::Identity();
}

Eigen::Vector3d normal_of_surface(const VoxelRecord& record) {
  if (planarity_of(record) >= kMinPlanarity) return normal_of(record);
  if (record.count < kMinOwnPoints) return Eigen::Vector3d::Zero();
  const PlaneFit own = fit_plane(covariance_of(record));
  return own.planarity >= kMinPlanarity ? own.normal : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

}  // namespace

HeldSurface held_surface(const VoxelRecord& record, double voxel_size) {
  const Eigen::Matrix3d covariance = shrunk_covariance(record, voxel_size);
  const Eigen::Vector3d normal = normal_of_surface(record);
  HeldSurface surface;
  surface.mean = mean_of(record, VoxelIndex(0), voxel_size).cast<float>();
  surface.normal = normal.cast<float>();
  surface.variance = static_cast<float>(normal.dot(covariance * normal));
  surface.information = covariance.inverse().cast<float>();
  return surface;
}

std::vector<HeldSurface> held_surfaces(const VoxelLevel& level) {
  std::vector<HeldSurface> surfaces(level.size());
  parallel_for(
      level.size(), [&](std::size_t i) { surfaces[i] = held_surface(level.records()[i], level.voxel_size()); }, 1024);
  return surfaces;
}

}  // namespace vdbmap

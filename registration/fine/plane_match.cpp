// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/plane_match.h"

#include <limits>

#include "vdbmap/core/eigen_features.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap::registration {
namespace {

struct NearestVoxel {
  const VoxelRecord* record = nullptr;
  Eigen::Vector3d mean;
};

NearestVoxel nearest_voxel(const VoxelFinder& finder, const VoxelLevel& level, double per_metre,
                           const Eigen::Vector3d& point, int reach) {
  NearestVoxel nearest;
  double nearest_distance = std::numeric_limits<double>::infinity();
  finder.for_each_around(voxel_of_point(point, per_metre), reach,
                         [&](const VoxelIndex& voxel, const VoxelRecord& record) {
                           const Eigen::Vector3d mean = mean_of(record, voxel, level.voxel_size());
                           const double distance = (mean - point).squaredNorm();
                           if (distance >= nearest_distance) return;
                           nearest_distance = distance;
                           nearest = {&record, mean};
                         });
  return nearest;
}

PlaneMatch match_plane(const NearestVoxel& voxel, const Eigen::Vector3d& point_in_scan, const MatchOptions& options) {
  PlaneMatch match{point_in_scan, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), 0};
  if (!voxel.record) return match;
  match.mean = voxel.mean;
  if (options.plane_from_voxel) {
    if (voxel.record->count < 5) return match;
    const PlaneFit plane = fit_plane(covariance_of(*voxel.record));
    match.normal = plane.normal;
    match.planarity = plane.planarity;
  } else {
    match.normal = normal_of(*voxel.record);
    match.planarity = planarity_of(*voxel.record);
  }
  return match;
}

}  // namespace

std::vector<PlaneMatch> match_planes(std::span<const Eigen::Vector3d> points_in_scan, const VoxelLevel& level,
                                     const Eigen::Isometry3d& local_from_scan, const MatchOptions& options) {
  constexpr std::size_t kGrain = 256;
  const double per_metre = voxels_per_metre(level.voxel_size());
  std::vector<PlaneMatch> matches(points_in_scan.size());
  parallel_ranges(points_in_scan.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    const VoxelFinder finder(level);
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d point = local_from_scan * points_in_scan[i];
      NearestVoxel voxel;
      if (is_addressable(point, per_metre))
        voxel = nearest_voxel(finder, level, per_metre, point, options.search_voxels);
      matches[i] = match_plane(voxel, points_in_scan[i], options);
    }
  });
  std::erase_if(matches, [&](const PlaneMatch& match) {
    return match.planarity < options.min_planarity || match.planarity <= 0;
  });
  return matches;
}

}  // namespace vdbmap::registration

// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/coarse/surface_points.h"

#include "registration/coarse/neighbors.h"
#include "vdbmap/core/eigen_features.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap::registration {
namespace {

// How far the surroundings of each voxel lie on its normal's side: the mean of n . (p_k - p) [m].
std::vector<double> sides_of_surroundings(const VoxelLevel& level, const SurfacePoints& points, double radius) {
  std::vector<double> sides(points.size());
  parallel_for_each_with_finder(level, [&](const VoxelFinder& finder, const VoxelIndex& voxel, std::size_t number) {
    double side = 0;
    for_each_neighbor(finder, level, points.positions, voxel, number, radius, [&](std::size_t other, double) {
      side += points.normals[number].dot(points.positions[other] - points.positions[number]);
    });
    sides[number] = side;
  });
  return sides;
}

}  // namespace

SurfacePoints fitted_points(const VoxelLevel& level) {
  SurfacePoints points;
  points.positions.resize(level.size());
  points.normals.resize(level.size());
  points.planarities.resize(level.size());
  parallel_for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    const VoxelRecord& record = level.records()[number];
    const PlaneFit plane = fit_plane(covariance_of(record));
    points.positions[number] = mean_of(record, voxel, level.voxel_size());
    points.normals[number] = plane.normal;
    points.planarities[number] = plane.planarity;
  });
  return points;
}

SurfacePoints surface_points(const VoxelLevel& level, double radius) {
  SurfacePoints points = fitted_points(level);
  const std::vector<double> sides = sides_of_surroundings(level, points, radius);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (sides[i] < 0) points.normals[i] = -points.normals[i];
  }
  return points;
}

}  // namespace vdbmap::registration

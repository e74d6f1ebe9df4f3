// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/evidence.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <openvdb/math/DDA.h>
#include <openvdb/math/Ray.h>

#include "registration/coarse/balanced_share.h"
#include "registration/fine/plane_match.h"
#include "registration/fine/plane_residual.h"
#include "registration/fine/point_to_plane.h"
#include "vdbmap/core/eigen_features.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap::registration {
namespace {

// Whether a voxel's points are a flat piece of one surface: a voxel in a corner holds several, which another sampling
// weighs otherwise.
bool is_flat(const PlaneFit& plane, const Eigen::Matrix3d& covariance) {
  constexpr double kMinPlanarity = 0.5;
  constexpr double kMaxThickness = 0.1;  // [m] standard deviation along the normal
  return plane.planarity >= kMinPlanarity &&
         plane.normal.dot(covariance * plane.normal) <= kMaxThickness * kMaxThickness;
}

Eigen::Isometry3d local_pose(const Eigen::Isometry3d& map_from_source, const VoxelMap& map) {
  Eigen::Isometry3d local = map_from_source;
  local.translation() -= map.frame.anchor;
  return local;
}

std::vector<Eigen::Vector3d> overlapping_points(std::span<const Eigen::Vector3d> points, const VoxelLevel& level,
                                                const Eigen::Isometry3d& local_from_source) {
  constexpr std::size_t kGrain = 256;
  const double per_metre = voxels_per_metre(level.voxel_size());
  std::vector<std::uint8_t> overlaps(points.size());
  parallel_ranges(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    const VoxelFinder finder(level);
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d point = local_from_source * points[i];
      if (!is_addressable(point, per_metre)) continue;
      finder.for_each_around(voxel_of_point(point, per_metre), 1,
                             [&](const VoxelIndex&, const VoxelRecord&) { overlaps[i] = 1; });
    }
  });
  std::vector<Eigen::Vector3d> overlapping;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (overlaps[i]) overlapping.push_back(points[i]);
  }
  return overlapping;
}

std::size_t count_within(std::span<const double> distances, double limit) {
  return static_cast<std::size_t>(
      std::count_if(distances.begin(), distances.end(), [&](double distance) { return std::abs(distance) < limit; }));
}

enum class PieceFit : std::uint8_t { kOutside, kDiffers, kAgrees };

// How the piece lies to the voxels around it.
PieceFit fit_piece(const VoxelFinder& finder, const VoxelLevel& level, const SurfacePiece& piece) {
  constexpr double kMaxDistance = 0.2;  // [m] from the plane
  constexpr double kMinCosine = 0.94;   // between the normals: 20 degrees
  const double per_metre = voxels_per_metre(level.voxel_size());
  PieceFit fit = PieceFit::kOutside;
  if (!is_addressable(piece.position, per_metre)) return fit;
  finder.for_each_around(voxel_of_point(piece.position, per_metre), 1,
                         [&](const VoxelIndex& voxel, const VoxelRecord& record) {
                           if (fit == PieceFit::kOutside) fit = PieceFit::kDiffers;
                           if (fit == PieceFit::kAgrees) return;
                           const Eigen::Matrix3d covariance = covariance_of(record);
                           const PlaneFit plane = fit_plane(covariance);
                           const Eigen::Vector3d shift = piece.position - mean_of(record, voxel, level.voxel_size());
                           if (is_flat(plane, covariance) && shift.norm() < level.voxel_size() &&
                               std::abs(plane.normal.dot(piece.normal)) >= kMinCosine &&
                               std::abs(plane.normal.dot(shift)) <= kMaxDistance) {
                             fit = PieceFit::kAgrees;
                           }
                         });
  return fit;
}

std::vector<PieceFit> fit_pieces(std::span<const SurfacePiece> pieces, const VoxelLevel& level,
                                 const Eigen::Isometry3d& local_from_source) {
  constexpr std::size_t kGrain = 128;
  std::vector<PieceFit> fits(pieces.size());
  parallel_ranges(pieces.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    const VoxelFinder finder(level);
    for (std::size_t i = begin; i < end; ++i) {
      fits[i] = fit_piece(finder, level,
                          {local_from_source * pieces[i].position, local_from_source.linear() * pieces[i].normal});
    }
  });
  return fits;
}

// A flat piece of surface that the ray meets at more than a grazing angle.
bool is_wall(const VoxelRecord& record, const Eigen::Vector3d& direction) {
  constexpr double kMinPlanarity = 0.5;
  constexpr double kMinCosine = 0.35;  // between ray and normal: rays along the ground touch its voxels
  return planarity_of(record) >= kMinPlanarity && std::abs(normal_of(record).dot(direction)) >= kMinCosine;
}

// Whether the ray runs through a wall well before its end.
bool is_blocked(const VoxelFinder& finder, const VoxelLevel& level, const MeasuredRay& ray) {
  constexpr double kMinDistance = 2.0;  // [m] from the sensor: its own vehicle
  constexpr double kMargin = 1.0;       // [m] before the end: what was measured, and what lies close to it
  const Eigen::Vector3d whole = ray.end - ray.origin;
  const double length = whole.norm() - kMargin;
  if (!(length > kMinDistance)) return false;
  const Eigen::Vector3d direction = whole.normalized();
  const double per_metre = voxels_per_metre(level.voxel_size());
  const Eigen::Vector3d origin = ray.origin * per_metre;

  using VoxelRay = openvdb::math::Ray<double>;
  const VoxelRay in_voxels({origin.x(), origin.y(), origin.z()}, {direction.x(), direction.y(), direction.z()},
                           kMinDistance * per_metre, length * per_metre);
  openvdb::math::DDA<VoxelRay, 0> walk(in_voxels);
  do {
    const VoxelRecord* record = finder.find(walk.voxel());
    if (record && is_wall(*record, direction)) return true;
  } while (walk.step());
  return false;
}

std::size_t count_blocked(std::span<const MeasuredRay> rays, const VoxelLevel& level,
                          const Eigen::Isometry3d& local_from_source) {
  constexpr std::size_t kGrain = 32;
  const double per_metre = voxels_per_metre(level.voxel_size());
  std::vector<std::uint8_t> blocked(rays.size());
  parallel_ranges(rays.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    const VoxelFinder finder(level);
    for (std::size_t i = begin; i < end; ++i) {
      const MeasuredRay ray{local_from_source * rays[i].origin, local_from_source * rays[i].end};
      if (!is_addressable(ray.origin, per_metre) || !is_addressable(ray.end, per_metre)) continue;
      blocked[i] = is_blocked(finder, level, ray);
    }
  });
  return static_cast<std::size_t>(std::count(blocked.begin(), blocked.end(), 1));
}

double share(std::size_t part, std::size_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

}  // namespace

std::vector<SurfacePiece> flat_pieces(const VoxelLevel& level) {
  constexpr std::uint32_t kMinPoints = 5;
  std::vector<SurfacePiece> pieces;
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    const VoxelRecord& record = level.records()[number];
    const Eigen::Matrix3d covariance = covariance_of(record);
    const PlaneFit plane = fit_plane(covariance);
    if (record.count < kMinPoints || !is_flat(plane, covariance)) return;
    pieces.push_back({mean_of(record, voxel, level.voxel_size()), plane.normal});
  });
  return pieces;
}

double surface_agreement(std::span<const SurfacePiece> pieces, const VoxelMap& map,
                         const Eigen::Isometry3d& map_from_source) {
  const Eigen::Isometry3d local_from_source = local_pose(map_from_source, map);
  const std::vector<PieceFit> fits = fit_pieces(pieces, map.coarsest(), local_from_source);
  std::vector<Eigen::Vector3d> normals;
  std::vector<bool> agrees;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (fits[i] == PieceFit::kOutside) continue;
    normals.push_back(pieces[i].normal);
    agrees.push_back(fits[i] == PieceFit::kAgrees);
  }
  return balanced_share(normals, agrees);
}

Evidence weigh(std::span<const Eigen::Vector3d> points, std::span<const MeasuredRay> rays, const VoxelMap& map,
               const Eigen::Isometry3d& map_from_source) {
  const Eigen::Isometry3d local_from_source = local_pose(map_from_source, map);
  const std::vector<Eigen::Vector3d> overlapping = overlapping_points(points, map.coarsest(), local_from_source);
  Evidence evidence;
  evidence.num_points = points.size();
  evidence.overlap = share(overlapping.size(), points.size());
  const std::vector<PlaneMatch> matches = match_planes(overlapping, map.finest(), local_from_source, {});
  const std::vector<double> distances = plane_distances(matches, local_from_source);
  evidence.on_surface_share = share(count_within(distances, kInlierDistance), overlapping.size());
  evidence.num_rays = rays.size();
  evidence.blocked_share = share(count_blocked(rays, map.finest(), local_from_source), rays.size());
  return evidence;
}

}  // namespace vdbmap::registration

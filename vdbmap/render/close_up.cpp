// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/close_up.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "vdbmap/core/ray_caster.h"
#include "vdbmap/render/change_scene.h"
#include "vdbmap/render/region_outlines.h"
#include "vdbmap/render/voxel_colors.h"
#include "vdbmap/render/voxel_view.h"

namespace vdbmap {
namespace {

constexpr double kReach = 30;  // [m] of what is drawn around a region
constexpr double kFieldOfViewDeg = 40;
constexpr double kElevationDeg = -32;
constexpr int kNumHeadings = 16;
constexpr double kLeastRadius = 2.2;  // [m] of what fills the picture

// The half diagonal of a region, not below what makes a picture one can find one's way in.
double radius_of(const ChangeRegion& region) { return std::max(kLeastRadius, 0.5 * region.size().norm()); }

Eigen::Isometry3d eye_at(const ChangeRegion& region, double heading_deg, double elevation_deg) {
  constexpr double kFill = 3.2;  // distance in radii
  Eigen::Isometry3d pose = map_from_camera_at(region.center(), heading_deg, elevation_deg);
  pose.translation() -= kFill * radius_of(region) * pose.linear().col(2);
  return pose;
}

// Places on the upper half of the region's box [m, original system].
std::vector<Eigen::Vector3d> places_of(const ChangeRegion& region) {
  std::vector<Eigen::Vector3d> places;
  for (const double height : {region.top + 0.15, 0.4 * region.bottom + 0.6 * region.top}) {
    for (const Eigen::Vector2d& corner : region.plan.corners()) {
      const Eigen::Vector2d inside = 0.9 * corner + 0.1 * region.plan.center;
      places.emplace_back(inside.x(), inside.y(), height);
    }
    places.emplace_back(region.plan.center.x(), region.plan.center.y(), region.top + 0.15);
  }
  return places;
}

// How many of the places nothing hides, up to the region itself.
int num_free(const ChangeScene& scene, const ChangeRegion& region, const Eigen::Isometry3d& pose) {
  const RayCaster caster(scene.map.finest());
  const Eigen::Vector3d eye = pose.translation() - scene.map.frame.anchor;
  int count = 0;
  for (const Eigen::Vector3d& place : places_of(region)) {
    const Eigen::Vector3d way = place - scene.map.frame.anchor - eye;
    const double stop = std::max(0.0, way.norm() - 0.6 * region.size().head<2>().norm());
    count += caster.is_blocked({eye, way.normalized()}, {0, stop}) ? 0 : 1;
  }
  return count;
}

Eigen::Isometry3d best_eye(const ChangeScene& before, const ChangeScene& after, const ChangeRegion& region) {
  Eigen::Isometry3d best = eye_at(region, 0, -89);
  int most = -1;
  for (const double elevation_deg : {kElevationDeg, -50.0, -70.0}) {
    for (int i = 0; i < kNumHeadings; ++i) {
      const Eigen::Isometry3d pose = eye_at(region, 360.0 * i / kNumHeadings + 20, elevation_deg);
      const int count = num_free(before, region, pose) + num_free(after, region, pose);
      if (count <= most) continue;
      most = count;
      best = pose;
    }
    if (most >= 17) return best;  // of twenty: steeper ones are not needed
  }
  return best;
}

Image draw(ChangeScene scene, const ChangeRegion& region, const Eigen::Isometry3d& pose, const ImageSize& size) {
  Eigen::Isometry3d local = pose;
  local.translation() -= scene.map.frame.anchor;
  const Camera camera = Camera::perspective(local, kFieldOfViewDeg, size);
  const VoxelColors colors(scene.map, scene.map.finest(), std::move(scene.changes), /*keeps_colors=*/true);
  VoxelView view = view_voxels(scene.map.finest(), colors, camera);
  draw_regions(view, camera, {&region, 1}, scene.map.frame.anchor);
  return std::move(view.image);
}

}  // namespace

CloseUps draw_close_ups(const VoxelMap& earlier, const VoxelMap& later, const MapDiff& diff, const ChangeRegion& region,
                        const ImageSize& size) {
  const double reach = kReach + radius_of(region);
  ChangeScene before = scene_around(earlier, MapSide::kEarlier, diff, region.center(), reach);
  ChangeScene after = scene_around(later, MapSide::kLater, diff, region.center(), reach);
  const Eigen::Isometry3d pose = best_eye(before, after, region);
  return {draw(std::move(before), region, pose, size), draw(std::move(after), region, pose, size)};
}

}  // namespace vdbmap

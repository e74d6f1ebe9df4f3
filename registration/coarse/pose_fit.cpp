// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/coarse/pose_fit.h"

#include <algorithm>
#include <cmath>

#include "registration/coarse/balanced_share.h"
#include "vdbmap/core/voxel.h"
#include "vdbmap/core/voxel_id.h"

namespace vdbmap::registration {
namespace {

constexpr std::size_t kPoints = 500;   // of a scan
constexpr double kMinPlanarity = 0.5;  // of these
constexpr double kMaxDistance = 0.7;   // [m] from the plane
constexpr double kMinCosine = 0.866;   // between normals: 30 degrees

std::vector<std::size_t> flat_points(const SurfacePoints& scan) {
  std::vector<std::size_t> flat;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.planarities[i] >= kMinPlanarity) flat.push_back(i);
  }
  return flat;
}

bool lies_by_surface(const SurfacePoints& map, const VoxelNumbers& voxels, const Eigen::Vector3d& position,
                     const Eigen::Vector3d& normal) {
  if (!is_addressable(position, voxels.voxels_per_metre)) return false;
  const VoxelId middle = id_of_voxel(voxel_of_point(position, voxels.voxels_per_metre));
  for (int i = 0; i < 27; ++i) {
    const std::uint32_t number = voxels.numbers.find(id_beside(middle, i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1));
    if (number == CellTable::kNone) continue;
    const Eigen::Vector3d& other = map.normals[number];
    if (other.dot(normal) >= kMinCosine && std::abs(other.dot(position - map.positions[number])) <= kMaxDistance) {
      return true;
    }
  }
  return false;
}

}  // namespace

VoxelNumbers number_voxels(const SurfacePoints& points, double voxel_size) {
  VoxelNumbers voxels{voxels_per_metre(voxel_size), CellTable(points.size())};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const VoxelIndex voxel = voxel_of_point(points.positions[i], voxels.voxels_per_metre);
    voxels.numbers.find_or_insert(id_of_voxel(voxel), static_cast<std::uint32_t>(i));
  }
  return voxels;
}

double pose_fit(const SurfacePoints& scan, const SurfacePoints& map, const VoxelNumbers& voxels,
                const Eigen::Isometry3d& map_from_scan) {
  const std::vector<std::size_t> flat = flat_points(scan);
  const std::size_t step = std::max<std::size_t>(1, flat.size() / kPoints);
  std::vector<Eigen::Vector3d> normals;
  std::vector<bool> holds;
  for (std::size_t i = 0; i < flat.size(); i += step) {
    normals.emplace_back(map_from_scan.linear() * scan.normals[flat[i]]);
    holds.push_back(lies_by_surface(map, voxels, map_from_scan * scan.positions[flat[i]], normals.back()));
  }
  return balanced_share(normals, holds);
}

}  // namespace vdbmap::registration

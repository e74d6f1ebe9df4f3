// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/anchor_choice.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "vdbmap/core/parallel.h"
#include "vdbmap/core/point_cell.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap {
namespace {

// Counts the points reached, up to `enough` of them and then as it comes.
std::size_t count_reached_up_to(std::size_t enough, const Eigen::Vector3d& anchor, const PointCloud& cloud,
                                const Eigen::Isometry3d& map_from_cloud, double voxels_per_metre) {
  constexpr std::size_t kGrain = 1 << 14;
  Eigen::Isometry3d local_from_cloud = map_from_cloud;
  local_from_cloud.translation() -= anchor;
  const CellFinder cells(local_from_cloud, voxels_per_metre);
  std::atomic<std::size_t> num_reached{0};
  parallel_ranges(cloud.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    if (num_reached >= enough) return;
    std::size_t count = 0;
    for (std::size_t i = begin; i < end; ++i) count += cells.reaches(cloud.positions[i]) ? 1 : 0;
    num_reached += count;
  });
  return num_reached;
}

bool reaches_most(const Eigen::Vector3d& anchor, const PointCloud& cloud, const Eigen::Isometry3d& map_from_cloud,
                  double voxels_per_metre) {
  const std::size_t most = cloud.size() / 2 + 1;
  return count_reached_up_to(most, anchor, cloud, map_from_cloud, voxels_per_metre) >= most;
}

// Of the points that are finite, of which there is one at least.
Eigen::Vector3d median_of(const PointCloud& cloud, const Eigen::Isometry3d& map_from_cloud) {
  Eigen::Vector3d median;
  std::vector<double> values;
  for (int axis = 0; axis < 3; ++axis) {
    values.clear();
    for (const Eigen::Vector3d& point : cloud.positions) {
      if (point.allFinite()) values.push_back((map_from_cloud * point)[axis]);
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    median[axis] = *middle;
  }
  return median;
}

[[noreturn]] void throw_too_far(const Eigen::Vector3d& point) {
  std::ostringstream message;
  message.precision(10);
  message << "point " << point.x() << ", " << point.y() << ", " << point.z()
          << " is not within 1e9 m of the origin, where maps lie; are the coordinates in metres?";
  throw std::out_of_range(message.str());
}

}  // namespace

std::size_t count_reached(const Eigen::Vector3d& anchor, const PointCloud& cloud,
                          const Eigen::Isometry3d& map_from_cloud, double voxels_per_metre) {
  return count_reached_up_to(cloud.size() + 1, anchor, cloud, map_from_cloud, voxels_per_metre);
}

Eigen::Vector3d anchor_for(const PointCloud& cloud, const Eigen::Isometry3d& map_from_cloud, double voxels_per_metre) {
  const Eigen::Vector3d near_first = choose_anchor(map_from_cloud * cloud.positions.front());
  if (is_anchor(near_first) && reaches_most(near_first, cloud, map_from_cloud, voxels_per_metre)) return near_first;

  const bool is_any_finite = std::ranges::any_of(cloud.positions, [](const auto& point) { return point.allFinite(); });
  if (!is_any_finite) throw_too_far(cloud.positions.front());
  const Eigen::Vector3d near_middle = choose_anchor(median_of(cloud, map_from_cloud));
  if (is_anchor(near_middle)) return near_middle;
  const auto is_too_far = [&](const Eigen::Vector3d& point) {
    return !is_anchor(choose_anchor(map_from_cloud * point));
  };
  throw_too_far(*std::ranges::find_if(cloud.positions, is_too_far));
}

}  // namespace vdbmap

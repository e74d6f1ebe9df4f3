// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/ray_visibility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "vdbmap/core/voxel_block.h"

namespace vdbmap::test {
namespace {

// Calls body(voxel) for the voxels along a segment (Amanatides & Woo 1987); lengths in voxels.
template <typename Body>
void walk(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Body& body) {
  VoxelIndex voxel = voxel_of_point(from, 1);
  const VoxelIndex last = voxel_of_point(to, 1);
  const Eigen::Vector3d way = to - from;
  std::array<double, 3> next{}, step{};
  std::array<int, 3> sign{};
  for (int axis = 0; axis < 3; ++axis) {
    sign[axis] = way[axis] > 0 ? 1 : -1;
    step[axis] = way[axis] == 0 ? std::numeric_limits<double>::infinity() : std::abs(1 / way[axis]);
    const double border = voxel[axis] + (way[axis] > 0 ? 1 : 0);
    next[axis] = way[axis] == 0 ? std::numeric_limits<double>::infinity() : (border - from[axis]) / way[axis];
  }
  body(voxel);
  while (voxel != last) {
    const auto axis = static_cast<int>(std::ranges::min_element(next) - next.begin());
    if (next[axis] > 1) return;
    voxel[axis] += sign[axis];
    next[axis] += step[axis];
    body(voxel);
  }
}

class Walker {
 public:
  explicit Walker(const VoxelMap& map) : map_(map), level_(map.finest()), finder_(level_) {
    visibility_.voxel_size = level_.voxel_size();
    visibility_.hits.resize(level_.size());
    visibility_.passes.resize(level_.size());
  }

  void follow(const MeasuredRay& ray) {
    const double size = level_.voxel_size();
    const Eigen::Vector3d from = (ray.origin - map_.frame.anchor) / size, to = (ray.end - map_.frame.anchor) / size;
    if (const VoxelRecord* hit = finder_.find(voxel_of_point(to, 1))) ++visibility_.hits[number_of(hit)];
    const double length = (to - from).norm();
    if (!(length > 1)) return;
    const Eigen::Vector3d direction = (to - from) / length;
    walk(from, to - direction, [&](const VoxelIndex& voxel) { pass(voxel, from, direction); });
  }

  Visibility finish() {
    LargeVector<VoxelLeaf> leaves;
    for (const auto& [key, leaf] : empty_) leaves.push_back(leaf);
    visibility_.seen_empty = VoxelTree(std::move(leaves));
    return std::move(visibility_);
  }

 private:
  std::size_t number_of(const VoxelRecord* record) const {
    return static_cast<std::size_t>(record - level_.records().data());
  }

  void pass(const VoxelIndex& voxel, const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
    if (const VoxelRecord* record = finder_.find(voxel)) {
      const Eigen::Vector3d to_mean = mean_of(*record, voxel, 1) - from;
      const double aside = (to_mean - direction * direction.dot(to_mean)).norm();
      if (aside < 1.0 / 3) ++visibility_.passes[number_of(record)];
      return;
    }
    const VoxelIndex origin = VoxelTree::origin_of_leaf(voxel);
    if (!last_ || last_->origin() != origin) {
      last_ = &empty_.try_emplace(key_of_voxel(origin), origin, false).first->second;
    }
    last_->setValueOn(voxel);
  }

  const VoxelMap& map_;
  const VoxelLevel& level_;
  VoxelFinder finder_;
  Visibility visibility_;
  std::map<VoxelKey, VoxelLeaf> empty_;
  VoxelLeaf* last_ = nullptr;
};

}  // namespace

Visibility visibility_of(const VoxelMap& map, std::span<const MeasuredRay> rays) {
  Walker walker(map);
  for (const MeasuredRay& ray : rays) walker.follow(ray);
  return walker.finish();
}

std::vector<MeasuredRay> rays_from(const Eigen::Vector3d& origin, std::span<const Eigen::Vector3d> ends) {
  std::vector<MeasuredRay> rays;
  for (const Eigen::Vector3d& end : ends) rays.push_back({origin, end});
  return rays;
}

}  // namespace vdbmap::test

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/ray_caster.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbmap {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The voxel where a ray ends.
struct End {
  const VoxelLeaf* leaf;
  openvdb::Index offset;
  RayArrival arrival;
};

bool walk(const RayNodes& /*nodes*/, const VoxelLeaf& leaf, const RayPath& path, RayArrival arrival, double end,
          End& result) {
  CellWalk<VoxelLeaf::LOG2DIM, 0> cells(path, leaf.origin(), arrival.distance);
  do {
    if (!leaf.getValueMask().isOn(cells.offset()) || arrival.axis < 0) continue;
    result = {&leaf, cells.offset(), arrival};
    return true;
  } while (cells.advance(arrival, end));
  return false;
}

template <typename Node>
bool walk(const RayNodes& nodes, const Node& node, const RayPath& path, RayArrival arrival, double end, End& result) {
  CellWalk<Node::kLog2Dim, Node::kLog2Size> cells(path, node.origin, arrival.distance);
  do {
    const openvdb::Index offset = cells.offset();
    if (!node.children.isOn(offset)) continue;
    if (walk(nodes, nodes.child(node, offset), path, arrival, end, result)) return true;
  } while (cells.advance(arrival, end));
  return false;
}

// Through which face of the box the ray came to this distance: the axis whose plane it crosses last before it.
int axis_of_entry(const RayPath& path, const openvdb::CoordBBox& box, double distance) {
  int entry = 0;
  double nearest = kInfinity;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<int>(axis);
    const double plane = path.ahead[axis] > 0 ? box.min()[i] : box.max()[i] + 1.0;
    const double gap = std::abs(path.crossing(axis, plane) - distance);
    if (gap < nearest) {
      nearest = gap;
      entry = i;
    }
  }
  return entry;
}

// There are few regions along any ray through the box.
bool walk(const RayNodes& nodes, const RayPath& path, const RayRange& range, End& result) {
  const openvdb::CoordBBox& box = nodes.box();
  if (box.empty()) return false;
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) sum += path.origin[axis] + path.direction[axis];
  if (!std::isfinite(sum)) return false;  // a ray that is no number meets nothing
  const std::optional<RayRange> inside = clip(path, box, range);
  if (!inside) return false;
  RayArrival arrival{inside->begin};
  if (inside->begin > range.begin) arrival.axis = axis_of_entry(path, box, arrival.distance);

  constexpr int kSize = 1 << (RayNodes::Region::kLog2Dim + RayNodes::Region::kLog2Size);
  openvdb::Coord corner;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<int>(axis);
    const double place = path.origin[axis] + arrival.distance * path.direction[axis];
    const int voxel = std::clamp(static_cast<int>(std::floor(place)), box.min()[i], box.max()[i]);
    corner[i] = voxel & ~(kSize - 1);
  }
  while (true) {
    const RayNodes::Region* region = nodes.find_region(corner);
    if (region && walk(nodes, *region, path, arrival, inside->end, result)) return true;
    arrival.distance = kInfinity;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double next = path.crossing(axis, corner[static_cast<int>(axis)] + path.ahead[axis] * kSize);
      if (next < arrival.distance) arrival = {next, static_cast<int>(axis)};
    }
    if (!(arrival.distance < inside->end)) return false;
    corner[arrival.axis] += path.ahead[static_cast<std::size_t>(arrival.axis)] > 0 ? kSize : -kSize;
  }
}

}  // namespace

Eigen::Vector3d normal_of_face(VoxelFace face) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  normal[face / 2] = face % 2 == 0 ? -1 : 1;
  return normal;
}

RayCaster::RayCaster(const VoxelTree& tree, double voxel_size) : nodes_(tree), voxel_size_(voxel_size) {}

std::optional<RayHit> RayCaster::first_hit(const Ray& ray, const RayRange& range) const {
  const RayPath path(ray, voxel_size_);
  End end;
  if (!walk(nodes_, path, range, end)) return std::nullopt;
  const auto axis = static_cast<std::size_t>(end.arrival.axis);
  RayHit hit;
  hit.voxel = end.leaf->offsetToGlobalCoord(end.offset);
  hit.record = end.leaf->transientData() + rank_in_leaf(*end.leaf, end.offset);
  hit.face = static_cast<VoxelFace>(2 * axis + (path.ahead[axis] > 0 ? 0 : 1));
  hit.distance = end.arrival.distance;
  return hit;
}

bool RayCaster::is_blocked(const Ray& ray, const RayRange& range) const {
  End end;
  return walk(nodes_, RayPath(ray, voxel_size_), range, end);
}

}  // namespace vdbmap

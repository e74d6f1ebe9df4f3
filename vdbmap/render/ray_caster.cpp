// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/ray_caster.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbmap {
namespace {

using Root = VoxelTree::RootNodeType;
using UpperNode = Root::ChildNodeType;
using LowerNode = UpperNode::ChildNodeType;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A ray in units of voxels, with what every step needs.
struct Path {
  std::array<double, 3> origin;
  std::array<double, 3> direction;
  std::array<double, 3> inverse;
  std::array<int, 3> step;  ///< +1 or -1

  Path(const Ray& ray, double voxel_size) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      origin[i] = ray.origin[axis] / voxel_size;
      direction[i] = ray.direction[axis] / voxel_size;
      inverse[i] = direction[i] == 0 ? kInfinity : 1 / direction[i];
      step[i] = direction[i] < 0 ? -1 : 1;
    }
  }

  /// Distance at which the ray crosses the plane at this place on the axis.
  double crossing(std::size_t axis, double place) const {
    return direction[axis] == 0 ? kInfinity : (place - origin[axis]) * inverse[axis];
  }
};

/// How the ray came to where it is.
struct Arrival {
  double distance;
  int axis = -1;  ///< of the face it came through last; -1: it began here
};

/// Walks cell by cell over the 2^kLog2Dim cells a side of a node, each 2^kLog2Size voxels a side.
template <int kLog2Dim, int kLog2Size>
class CellWalk {
 public:
  CellWalk(const Path& path, const openvdb::Coord& node_origin, double distance) : path_(path) {
    constexpr double size = 1 << kLog2Size;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double corner = node_origin[static_cast<int>(axis)];
      const double place = path.origin[axis] + distance * path.direction[axis] - corner;
      // By rounding the ray may seem to be just outside of the node it has entered.
      cell_[axis] = std::clamp(static_cast<int>(std::floor(place / size)), 0, kLast);
      next_[axis] = path.crossing(axis, corner + (cell_[axis] + (path.step[axis] > 0 ? 1 : 0)) * size);
      delta_[axis] = path.direction[axis] == 0 ? kInfinity : size * std::abs(path.inverse[axis]);
    }
  }

  /// Number of the cell in the node's tables.
  openvdb::Index offset() const {
    return static_cast<openvdb::Index>((cell_[0] << 2 * kLog2Dim) | (cell_[1] << kLog2Dim) | cell_[2]);
  }

  /// Goes to the next cell; false where the ray leaves the node or its range.
  bool advance(Arrival& arrival, double end) {
    const std::size_t axis = next_[0] < next_[1] ? (next_[0] < next_[2] ? 0 : 2) : (next_[1] < next_[2] ? 1 : 2);
    if (!(next_[axis] < end)) return false;
    arrival = {next_[axis], static_cast<int>(axis)};
    cell_[axis] += path_.step[axis];
    next_[axis] += delta_[axis];
    return cell_[axis] >= 0 && cell_[axis] <= kLast;
  }

 private:
  static constexpr int kLast = (1 << kLog2Dim) - 1;

  const Path& path_;
  std::array<int, 3> cell_;
  std::array<double, 3> next_;   ///< distance at which the ray leaves the cell on each axis
  std::array<double, 3> delta_;  ///< distance from face to face on each axis
};

/// The voxel where a ray ends.
struct End {
  const VoxelLeaf* leaf;
  openvdb::Index offset;
  Arrival arrival;
};

bool walk(const VoxelLeaf& leaf, const Path& path, Arrival arrival, double end, End& result) {
  CellWalk<VoxelLeaf::LOG2DIM, 0> cells(path, leaf.origin(), arrival.distance);
  do {
    if (!leaf.getValueMask().isOn(cells.offset()) || arrival.axis < 0) continue;
    result = {&leaf, cells.offset(), arrival};
    return true;
  } while (cells.advance(arrival, end));
  return false;
}

template <typename Node>
bool walk(const Node& node, const Path& path, Arrival arrival, double end, End& result) {
  CellWalk<Node::LOG2DIM, Node::ChildNodeType::TOTAL> cells(path, node.origin(), arrival.distance);
  do {
    const openvdb::Index offset = cells.offset();
    if (!node.getChildMask().isOn(offset)) continue;
    if (walk(*node.getTable()[offset].getChild(), path, arrival, end, result)) return true;
  } while (cells.advance(arrival, end));
  return false;
}

// The part of the range in which the ray is inside of the box; nothing where it misses.
std::optional<RayRange> clip(const Path& path, const openvdb::CoordBBox& box, RayRange range) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double low = box.min()[static_cast<int>(axis)];
    const double high = box.max()[static_cast<int>(axis)] + 1.0;
    if (path.direction[axis] == 0) {
      if (path.origin[axis] < low || path.origin[axis] >= high) return std::nullopt;
      continue;
    }
    const double a = path.crossing(axis, low);
    const double b = path.crossing(axis, high);
    range.begin = std::max(range.begin, std::min(a, b));
    range.end = std::min(range.end, std::max(a, b));
  }
  if (!(range.begin < range.end)) return std::nullopt;
  return range;
}

// Through which face of the box the ray came to this distance: the axis whose plane it crosses last before it.
int axis_of_entry(const Path& path, const openvdb::CoordBBox& box, double distance) {
  int entry = 0;
  double nearest = kInfinity;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<int>(axis);
    const double plane = path.step[axis] > 0 ? box.min()[i] : box.max()[i] + 1.0;
    const double gap = std::abs(path.crossing(axis, plane) - distance);
    if (gap < nearest) {
      nearest = gap;
      entry = i;
    }
  }
  return entry;
}

// Cells of the root are as large as its children; there are few of them along any ray through the box.
bool walk(const VoxelTree& tree, const openvdb::CoordBBox& box, const Path& path, const RayRange& range, End& result) {
  const std::optional<RayRange> inside = clip(path, box, range);
  if (!inside) return false;
  Arrival arrival{inside->begin};
  if (inside->begin > range.begin) arrival.axis = axis_of_entry(path, box, arrival.distance);

  constexpr int kSize = 1 << UpperNode::TOTAL;
  openvdb::Coord corner;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<int>(axis);
    const double place = path.origin[axis] + arrival.distance * path.direction[axis];
    const int voxel = std::clamp(static_cast<int>(std::floor(place)), box.min()[i], box.max()[i]);
    corner[i] = voxel & ~(kSize - 1);
  }
  while (true) {
    const auto* node = tree.root().template probeConstNode<UpperNode>(corner);
    if (node && walk(*node, path, arrival, inside->end, result)) return true;
    arrival.distance = kInfinity;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double next = path.crossing(axis, corner[static_cast<int>(axis)] + (path.step[axis] > 0 ? kSize : 0));
      if (next < arrival.distance) arrival = {next, static_cast<int>(axis)};
    }
    if (!(arrival.distance < inside->end)) return false;
    corner[arrival.axis] += path.step[static_cast<std::size_t>(arrival.axis)] * kSize;
  }
}

}  // namespace

Eigen::Vector3d normal_of_face(VoxelFace face) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  normal[face / 2] = face % 2 == 0 ? -1 : 1;
  return normal;
}

RayCaster::RayCaster(const VoxelLevel& level) : level_(level) { level.tree().evalLeafBoundingBox(box_); }

std::optional<RayHit> RayCaster::first_hit(const Ray& ray, const RayRange& range) const {
  if (level_.size() == 0) return std::nullopt;
  const Path path(ray, level_.voxel_size());
  End end;
  if (!walk(level_.tree(), box_, path, range, end)) return std::nullopt;
  const auto axis = static_cast<std::size_t>(end.arrival.axis);
  RayHit hit;
  hit.voxel = end.leaf->offsetToGlobalCoord(end.offset);
  hit.record = end.leaf->transientData() + rank_in_leaf(*end.leaf, end.offset);
  hit.face = static_cast<VoxelFace>(2 * axis + (path.step[axis] > 0 ? 0 : 1));
  hit.distance = end.arrival.distance;
  return hit;
}

bool RayCaster::is_blocked(const Ray& ray, const RayRange& range) const {
  if (level_.size() == 0) return false;
  End end;
  return walk(level_.tree(), box_, Path(ray, level_.voxel_size()), range, end);
}

}  // namespace vdbmap

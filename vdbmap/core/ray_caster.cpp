// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/ray_caster.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbmap {
namespace {

// Without a branch, which a ray's way through the voxels would make mispredicted half of the time.
constexpr bool both(bool a, bool b) { return a & b; }

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A ray in units of voxels, with what every step needs.
struct Path {
  std::array<double, 3> origin;
  std::array<double, 3> direction;
  std::array<double, 3> inverse;  ///< infinite along an axis on which the ray stands still
  std::array<double, 3> ahead;    ///< 1 where the ray runs up the axis, else 0: on which side it leaves a cell

  Path(const Ray& ray, double voxel_size) {
    const double voxels_per_metre = 1 / voxel_size;
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      origin[i] = ray.origin[axis] * voxels_per_metre;
      direction[i] = ray.direction[axis] == 0 ? 0.0 : ray.direction[axis] * voxels_per_metre;  // never -0
      inverse[i] = 1 / direction[i];
      ahead[i] = direction[i] < 0 ? 0 : 1;
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

/// Walks cell by cell over the 2^kLog2Dim cells a side of a node, each 2^kLog2Size voxels a side. Steps have no branch
/// that depends on the axis: processors would guess it wrong every other time.
template <int kLog2Dim, int kLog2Size>
class CellWalk {
 public:
  CellWalk(const Path& path, const openvdb::Coord& node_origin, double distance) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      constexpr double size = 1 << kLog2Size;
      const double from_corner = path.origin[axis] - node_origin[static_cast<int>(axis)];
      // By rounding the ray may seem to be just outside of the node it has entered.
      const double place = (from_corner + distance * path.direction[axis]) * (1 / size);
      const int cell = std::clamp(static_cast<int>(place), 0, (1 << kLog2Dim) - 1);
      next_[axis] = ((cell + path.ahead[axis]) * size - from_corner) * path.inverse[axis];
      delta_[axis] = size * std::abs(path.inverse[axis]);
      place_ += cell << kShift[axis];
      step_[axis] = path.ahead[axis] > 0 ? 1 << kShift[axis] : -(1 << kShift[axis]);
    }
  }

  /// Number of the cell in the node's tables.
  openvdb::Index offset() const {
    constexpr int kMask = (1 << kLog2Dim) - 1;
    return static_cast<openvdb::Index>((place_ & kMask) | ((place_ >> 1) & (kMask << kLog2Dim)) |
                                       ((place_ >> 2) & (kMask << 2 * kLog2Dim)));
  }

  /// Goes to the next cell; false where the ray leaves the node or its range.
  bool advance(Arrival& arrival, double end) {
    const bool is_x = both(next_[0] <= next_[1], next_[0] <= next_[2]);
    const bool is_z = both(!is_x, next_[2] < next_[1]);
    const bool is_y = both(!is_x, !is_z);
    const double distance = is_x ? next_[0] : is_z ? next_[2] : next_[1];
    next_[0] += is_x ? delta_[0] : 0.0;
    next_[1] += is_y ? delta_[1] : 0.0;
    next_[2] += is_z ? delta_[2] : 0.0;
    place_ += is_x ? step_[0] : is_z ? step_[2] : step_[1];
    arrival = {distance, is_x ? 0 : is_z ? 2 : 1};
    return both(distance < end, (place_ & kOutside) == 0);
  }

 private:
  // z, y and x lie in one number, each with a bit above it that is set where a step leaves the node on either side.
  static constexpr std::array<int, 3> kShift = {2 * kLog2Dim + 2, kLog2Dim + 1, 0};
  static constexpr int kOutside = (1 << kLog2Dim) | (1 << (2 * kLog2Dim + 1)) | (1 << (3 * kLog2Dim + 2));

  std::array<double, 3> next_;   ///< distance at which the ray leaves the cell on each axis
  std::array<double, 3> delta_;  ///< distance from face to face on each axis
  std::array<int, 3> step_;
  int place_ = 0;
};

/// The voxel where a ray ends.
struct End {
  const VoxelLeaf* leaf;
  openvdb::Index offset;
  Arrival arrival;
};

bool walk(const RayNodes& /*nodes*/, const VoxelLeaf& leaf, const Path& path, Arrival arrival, double end,
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
bool walk(const RayNodes& nodes, const Node& node, const Path& path, Arrival arrival, double end, End& result) {
  CellWalk<Node::kLog2Dim, Node::kLog2Size> cells(path, node.origin, arrival.distance);
  do {
    const openvdb::Index offset = cells.offset();
    if (!node.children.isOn(offset)) continue;
    if (walk(nodes, nodes.child(node, offset), path, arrival, end, result)) return true;
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
bool walk(const RayNodes& nodes, const Path& path, const RayRange& range, End& result) {
  const openvdb::CoordBBox& box = nodes.box();
  if (box.empty()) return false;
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) sum += path.origin[axis] + path.direction[axis];
  if (!std::isfinite(sum)) return false;  // a ray that is no number meets nothing
  const std::optional<RayRange> inside = clip(path, box, range);
  if (!inside) return false;
  Arrival arrival{inside->begin};
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
  const Path path(ray, voxel_size_);
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
  return walk(nodes_, Path(ray, voxel_size_), range, end);
}

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include <Eigen/Core>

#include "vdbmap/core/voxel_tree.h"

/// Rays on their way through cells: what every walk through a grid is made of, whether it looks for what is there or
/// marks what is not.
namespace vdbmap {

struct Ray {
  Eigen::Vector3d origin;     ///< [m, local frame]
  Eigen::Vector3d direction;  ///< distances along the ray are multiples of its length
};

/// A ray in units of voxels, with what every step needs.
struct RayPath {
  std::array<double, 3> origin;
  std::array<double, 3> direction;
  std::array<double, 3> inverse;  ///< infinite along an axis on which the ray stands still
  std::array<double, 3> ahead;    ///< 1 where the ray runs up the axis, else 0: on which side it leaves a cell

  RayPath(const Ray& ray, double voxel_size) {
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
    return direction[axis] == 0 ? std::numeric_limits<double>::infinity() : (place - origin[axis]) * inverse[axis];
  }
};

/// Part of a ray, in multiples of its direction.
struct RayRange {
  double begin = 0;
  double end = std::numeric_limits<double>::infinity();
};

/// The part of the range in which the ray is inside of the box; nothing where it misses.
inline std::optional<RayRange> clip(const RayPath& path, const openvdb::CoordBBox& box, RayRange range) {
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

/// How the ray came to where it is.
struct RayArrival {
  double distance;
  int axis = -1;  ///< of the face it came through last; -1: it began here
};

// Without a branch, which a ray's way through the voxels would make mispredicted half of the time.
constexpr bool hold_both(bool a, bool b) { return a & b; }

/// Walks cell by cell over the 2^kLog2Dim cells a side of a node, each 2^kLog2Size voxels a side. Steps have no branch
/// that depends on the axis: processors would guess it wrong every other time.
template <int kLog2Dim, int kLog2Size>
class CellWalk {
 public:
  CellWalk(const RayPath& path, const openvdb::Coord& node_origin, double distance) {
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

  /// Distance at which the ray leaves the cell.
  double exit() const { return std::min(next_[0], std::min(next_[1], next_[2])); }

  /// Goes to the next cell; false where the ray leaves the node or its range.
  bool advance(RayArrival& arrival, double end) {
    const bool is_x = hold_both(next_[0] <= next_[1], next_[0] <= next_[2]);
    const bool is_z = hold_both(!is_x, next_[2] < next_[1]);
    const bool is_y = hold_both(!is_x, !is_z);
    const double distance = is_x ? next_[0] : is_z ? next_[2] : next_[1];
    next_[0] += is_x ? delta_[0] : 0.0;
    next_[1] += is_y ? delta_[1] : 0.0;
    next_[2] += is_z ? delta_[2] : 0.0;
    place_ += is_x ? step_[0] : is_z ? step_[2] : step_[1];
    arrival = {distance, is_x ? 0 : is_z ? 2 : 1};
    return hold_both(distance < end, (place_ & kOutside) == 0);
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

}  // namespace vdbmap

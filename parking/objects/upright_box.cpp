// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/objects/upright_box.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/convex_hull_2.h>
#include <CGAL/min_quadrilateral_2.h>

namespace vdbmap::parking {
namespace {

using std::numbers::pi;
using Polygon = std::vector<Eigen::Vector2d>;

double within_half_turn(double angle) {
  const double turned = std::fmod(angle, pi);
  return turned < 0 ? turned + pi : turned;
}

double area(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - b.x() * a.y();
  }
  return twice / 2;
}

// What of a convex polygon lies to the left of the line from a to b (Sutherland and Hodgman 1974).
Polygon left_part(const Polygon& polygon, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const auto side = [&](const Eigen::Vector2d& p) {
    return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
  };
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& p = polygon[i];
    const Eigen::Vector2d& q = polygon[(i + 1) % polygon.size()];
    const double from = side(p), to = side(q);
    if (from >= 0) result.push_back(p);
    if ((from > 0 && to < 0) || (from < 0 && to > 0)) result.emplace_back(p + from / (from - to) * (q - p));
  }
  return result;
}

// Headings of the sides of the smallest rectangle around points on the ground.
double heading_of_smallest_rectangle(std::span<const Eigen::Vector3d> points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_2> places, hull, rectangle;
  for (const Eigen::Vector3d& point : points) places.emplace_back(point.x(), point.y());
  std::ranges::sort(places);
  CGAL::convex_hull_2(places.begin(), places.end(), std::back_inserter(hull));
  if (hull.size() < 3) {  // one place, or a line
    const Kernel::Vector_2 line = hull.back() - hull.front();
    return std::atan2(line.y(), line.x());
  }
  CGAL::min_rectangle_2(hull.begin(), hull.end(), std::back_inserter(rectangle));
  const Kernel::Vector_2 side = rectangle[1] - rectangle[0];
  return std::atan2(side.y(), side.x());
}

}  // namespace

Eigen::Vector2d UprightBox::along() const { return {std::cos(heading), std::sin(heading)}; }

Eigen::Vector2d UprightBox::across() const { return {-std::sin(heading), std::cos(heading)}; }

std::array<Eigen::Vector2d, 4> UprightBox::corners() const {
  const Eigen::Vector2d middle = center.head<2>(), half_length = length / 2 * along(),
                        half_width = width / 2 * across();
  return {middle - half_length - half_width, middle + half_length - half_width, middle + half_length + half_width,
          middle - half_length + half_width};
}

bool UprightBox::contains(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d from_middle = point - center.head<2>();
  return std::abs(from_middle.dot(along())) <= length / 2 && std::abs(from_middle.dot(across())) <= width / 2;
}

UprightBox box_of_heading(std::span<const Eigen::Vector3d> points, double heading) {
  if (points.empty()) throw std::invalid_argument("a box stands around one point at least");
  UprightBox box;
  box.heading = heading;
  const Eigen::Vector2d along = box.along(), across = box.across();
  Eigen::Array3d low = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array3d high = -low;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Array3d turned(point.head<2>().dot(along), point.head<2>().dot(across), point.z());
    low = low.min(turned);
    high = high.max(turned);
  }
  const Eigen::Array3d middle = (low + high) / 2, size = high - low;
  box.center << middle[0] * along + middle[1] * across, middle[2];
  box.length = size[0];
  box.width = size[1];
  box.height = size[2];
  if (box.width > box.length) {
    std::swap(box.width, box.length);
    box.heading += pi / 2;
  }
  box.heading = within_half_turn(box.heading);
  return box;
}

UprightBox smallest_box(std::span<const Eigen::Vector3d> points) {
  if (points.empty()) throw std::invalid_argument("a box stands around one point at least");
  return box_of_heading(points, heading_of_smallest_rectangle(points));
}

double overlap_in_plan(const UprightBox& a, const UprightBox& b) {
  const auto corners_a = a.corners(), corners_b = b.corners();
  Polygon common(corners_a.begin(), corners_a.end());
  for (std::size_t i = 0; i < 4; ++i) common = left_part(common, corners_b[i], corners_b[(i + 1) % 4]);
  const double intersection = area(common);
  const double both = a.length * a.width + b.length * b.width - intersection;
  return both > 0 ? intersection / both : 0;
}

}  // namespace vdbmap::parking

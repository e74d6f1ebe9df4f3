// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/plan_rectangle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

namespace vdbmap {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Corners of the convex hull, against the clock (Andrew 1979).
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
  std::ranges::sort(points, {}, [](const Eigen::Vector2d& point) { return std::pair(point.x(), point.y()); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Eigen::Vector2d> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t first = hull.size();
    for (const Eigen::Vector2d& point : points) {
      while (hull.size() >= first + 2 && cross(hull.back() - hull[hull.size() - 2], point - hull.back()) <= 0) {
        hull.pop_back();
      }
      hull.push_back(point);
    }
    hull.pop_back();  // begins the other half
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

PlanRectangle rectangle_of_yaw(const std::vector<Eigen::Vector2d>& hull, double yaw) {
  const Eigen::Vector2d along(std::cos(yaw), std::sin(yaw)), across(-along.y(), along.x());
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Eigen::Vector2d& corner : hull) {
    const Eigen::Array2d turned(corner.dot(along), corner.dot(across));
    low = low.min(turned);
    high = high.max(turned);
  }
  const Eigen::Array2d middle = (low + high) / 2, size = high - low;
  PlanRectangle rectangle{middle[0] * along + middle[1] * across, size[0], size[1], yaw};
  if (rectangle.width > rectangle.length) {
    std::swap(rectangle.width, rectangle.length);
    rectangle.yaw += std::numbers::pi / 2;
  }
  rectangle.yaw = std::fmod(rectangle.yaw + 2 * std::numbers::pi, std::numbers::pi);
  return rectangle;
}

}  // namespace

std::array<Eigen::Vector2d, 4> PlanRectangle::corners() const {
  const Eigen::Vector2d along(std::cos(yaw), std::sin(yaw)), across(-along.y(), along.x());
  const Eigen::Vector2d half_length = length / 2 * along, half_width = width / 2 * across;
  return {center - half_length - half_width, center + half_length - half_width, center + half_length + half_width,
          center - half_length + half_width};
}

PlanRectangle smallest_rectangle(std::span<const Eigen::Vector2d> points) {
  if (points.empty()) throw std::invalid_argument("a rectangle lies around one point at least");
  const std::vector<Eigen::Vector2d> hull = convex_hull({points.begin(), points.end()});
  PlanRectangle smallest = rectangle_of_yaw(hull, 0);
  double smallest_area = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; hull.size() > 1 && i < hull.size(); ++i) {
    const Eigen::Vector2d side = hull[(i + 1) % hull.size()] - hull[i];
    const PlanRectangle rectangle = rectangle_of_yaw(hull, std::atan2(side.y(), side.x()));
    if (rectangle.length * rectangle.width >= smallest_area) continue;
    smallest = rectangle;
    smallest_area = rectangle.length * rectangle.width;
  }
  return smallest;
}

}  // namespace vdbmap

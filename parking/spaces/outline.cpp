// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/spaces/outline.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vdbmap::parking {
namespace {

constexpr double kSmallestArea = 1;  // [m^2] of a place for a vehicle

// Twice the area of the triangle from a over b to c; above 0 where it goes to the left.
double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

bool is_between(double value, double a, double b) { return value >= std::min(a, b) && value <= std::max(a, b); }

// Whether c, on the line through a and b, lies between them.
bool is_on_side(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return is_between(c.x(), a.x(), b.x()) && is_between(c.y(), a.y(), b.y());
}

// Whether the sides from a to b and from c to d have a place in common.
bool meet(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c, const Eigen::Vector2d& d) {
  const double to_c = turn(a, b, c), to_d = turn(a, b, d), to_a = turn(c, d, a), to_b = turn(c, d, b);
  if (((to_c > 0 && to_d < 0) || (to_c < 0 && to_d > 0)) && ((to_a > 0 && to_b < 0) || (to_a < 0 && to_b > 0))) {
    return true;
  }
  return (to_c == 0 && is_on_side(a, b, c)) || (to_d == 0 && is_on_side(a, b, d)) ||
         (to_a == 0 && is_on_side(c, d, a)) || (to_b == 0 && is_on_side(c, d, b));
}

bool crosses_itself(std::span<const Eigen::Vector2d> outline) {
  const std::size_t count = outline.size();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = i + 2; k < count; ++k) {
      if (i == 0 && k == count - 1) continue;  // neighbours
      if (meet(outline[i], outline[i + 1], outline[k], outline[(k + 1) % count])) return true;
    }
  }
  return false;
}

}  // namespace

double signed_area(std::span<const Eigen::Vector2d> outline) {
  double twice = 0;
  for (std::size_t i = 0; i + 2 < outline.size(); ++i) twice += turn(outline[0], outline[i + 1], outline[i + 2]);
  return twice / 2;
}

bool contains(std::span<const Eigen::Vector2d> outline, const Eigen::Vector2d& place) {
  bool is_inside = false;  // an odd number of sides lies to the right
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d &a = outline[i], &b = outline[(i + 1) % outline.size()];
    if ((a.y() > place.y()) == (b.y() > place.y())) continue;
    const double x = a.x() + (place.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (place.x() < x) is_inside = !is_inside;
  }
  return is_inside;
}

std::string problem_of_outline(std::span<const Eigen::Vector2d> outline) {
  if (outline.size() < 3) return "has " + std::to_string(outline.size()) + " different corners, expected 3 or more";
  if (!std::ranges::all_of(outline, [](const Eigen::Vector2d& corner) { return corner.allFinite(); })) {
    return "has a corner that is not finite";
  }
  if (crosses_itself(outline)) return "crosses itself";
  if (std::abs(signed_area(outline)) < kSmallestArea) return "has an area below 1 m^2";
  return "";
}

std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> places) {
  std::ranges::sort(places, {}, [](const Eigen::Vector2d& place) { return std::pair(place.x(), place.y()); });
  std::vector<Eigen::Vector2d> hull;
  const auto go_along = [&](auto begin, auto end) {
    const std::size_t first = hull.size();
    for (auto it = begin; it != end; ++it) {
      while (hull.size() >= first + 2 && turn(hull[hull.size() - 2], hull.back(), *it) <= 0) hull.pop_back();
      hull.push_back(*it);
    }
    hull.pop_back();  // where the other way begins
  };
  if (places.size() < 3) return places;
  go_along(places.begin(), places.end());
  go_along(places.rbegin(), places.rend());
  return hull;
}

}  // namespace vdbmap::parking

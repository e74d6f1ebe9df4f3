// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/things/shrub.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace vdbmap::simulator {
namespace {

using Point = Eigen::Vector3d;

constexpr int kMostLeaves = 20'000;     // of one plant
constexpr double kTwigDistance = 0.35;  // [m] between twigs on the ground
constexpr double kInsideDepth = 2;      // times the depth of the leaves: one in seven stands further inwards
constexpr double kInsideStep = 0.2;     // [m] between the corners of the inside
constexpr double kDent = 0.02;          // [m] by which they are in or out

Point random_vector(Random& random) { return {random.normal(0, 1), random.normal(0, 1), random.normal(0, 1)}; }

// A point of the surface of the box from (-1,-1,0) to (1,1,1), drawn by the areas of the sides it stands for; not its
// bottom.
Point point_on_box(const Point& size, Random& random) {
  Point point(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0, 1));
  const double top = size.x() * size.y(), ends = 2 * size.y() * size.z(), sides = 2 * size.x() * size.z();
  const double choice = random.uniform(0, top + ends + sides);
  if (choice < top) {
    point.z() = 1;
  } else if (choice < top + ends) {
    point.x() = random.chance(0.5) ? 1 : -1;
  } else {
    point.y() = random.chance(0.5) ? 1 : -1;
  }
  return point;
}

// How far the surface swings out in a direction; four waves of the plant's own.
double swing(const Point& p, const Point& size, double phase) {
  const double x = size.x() / 2 * p.x(), y = size.y() / 2 * p.y(), z = size.z() * p.z();
  return std::sin(2.3 * x + phase) * std::sin(3.1 * y + 2.1 * z + 2 * phase) +
         0.5 * std::sin(6.1 * x + 4.7 * z - phase);
}

void add_leaf(const Brush& brush, const Point& center, double size, Random& random) {
  const Point along = size / 2 * random_vector(random).normalized() * random.uniform(0.7, 1.3);
  const Point across = 0.5 * size * along.cross(random_vector(random)).normalized();
  add_quad(brush, center - along, center + across, center + along, center - across);
}

// Thin stems that fan out from the ground.
void add_twigs(const Brush& brush, const ShrubShape& shape, Random& random) {
  const double area = shape.size.x() * shape.size.y();
  const int count = std::clamp(static_cast<int>(area / (kTwigDistance * kTwigDistance)), 3, 60);
  for (int i = 0; i < count; ++i) {
    const Point foot(0.35 * shape.size.x() * random.uniform(-1, 1), 0.3 * shape.size.y() * random.uniform(-1, 1), 0);
    const Point tip(foot.x() * 1.35 + random.normal(0, 0.08), foot.y() * 1.35 + random.normal(0, 0.08),
                    shape.size.z() * random.uniform(0.6, 0.97));
    const Point base(0, 0, shape.base);
    add_tube(brush, {base + foot, base + tip, 0.012, 0.005, 3});
  }
}

// One ring of the inside at a share of its height, with the swing of the surface and dents of its own.
std::vector<Point> inside_ring(const ShrubShape& shape, double share, double dent, double height, int count,
                               double phase, Random& random) {
  const double e = shape.exponent;
  const double reach = std::pow(1 - std::pow(height, e), 1 / e);
  std::vector<Point> ring;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count, x = std::cos(angle), y = std::sin(angle);
    const double norm = std::pow(std::pow(std::abs(x), e) + std::pow(std::abs(y), e), 1 / e);
    Point p(reach * x / norm, reach * y / norm, height);
    p *= share * (1 + shape.wave * swing(p, shape.size, phase)) * (1 + random.normal(0, dent));
    ring.emplace_back(p.x() * shape.size.x() / 2, p.y() * shape.size.y() / 2, shape.base + p.z() * shape.size.z());
  }
  return ring;
}

// A dented superellipsoid without a bottom; `half` is the plant's smallest extent from its middle [m].
void add_inside(const Brush& brush, const ShrubShape& shape, double half, double phase, Random& random) {
  const double share = std::max(0.3, 1 - kInsideDepth * shape.depth / half);
  const int count = std::clamp(static_cast<int>(2 * (shape.size.x() + shape.size.y()) / kInsideStep), 12, 80);
  const int num_rings = std::clamp(static_cast<int>(shape.size.z() / kInsideStep), 3, 10);
  std::vector<Point> below;
  for (int i = 0; i <= num_rings; ++i) {
    // Closer towards the top, where the surface turns.
    const double height = std::sin(std::numbers::pi / 2 * i / (num_rings + 0.3));
    const std::vector<Point> ring = inside_ring(shape, share, kDent / half, height, count, phase, random);
    if (i > 0) add_loft(brush, below, ring, true);
    below = ring;
  }
  add_polygon(brush, below);
}

}  // namespace

void add_shrub(const Brush& leaves, MaterialId twigs, const ShrubShape& shape, Random& random) {
  const Point& size = shape.size;
  const double area = size.x() * size.y() + 2 * (size.x() + size.y()) * size.z();
  const double count = shape.density * area * std::pow(0.1 / shape.leaf_size, 2) * shape.leaf_share;
  const double half = std::min({size.x() / 2, size.y() / 2, size.z()});
  const double phase = random.uniform(0, 2 * std::numbers::pi);
  add_twigs(leaves.with(twigs), shape, random);
  if (shape.is_dense && shape.leaf_share == 1) add_inside(leaves, shape, half, phase, random);
  for (int i = 0; i < std::min(static_cast<int>(count), kMostLeaves); ++i) {
    Point p = point_on_box(size, random);
    const double e = shape.exponent;
    const double norm =
        std::pow(std::pow(std::abs(p.x()), e) + std::pow(std::abs(p.y()), e) + std::pow(p.z(), e), 1 / e);
    // Light falls exponentially inwards, and so do leaves.
    const double inwards = -std::log(1 - random.uniform(0, 1)) * shape.depth / half;
    p *= std::max(0.05, 1 - inwards) * (1 + shape.wave * swing(p, size, phase)) / norm;
    const Point center(p.x() * size.x() / 2, p.y() * size.y() / 2, shape.base + p.z() * size.z());
    add_leaf(leaves, center, shape.leaf_size, random);
  }
}

void add_rough_hedge(const Brush& leaves, MaterialId twigs, const Eigen::Vector3d& size, Random& random) {
  ShrubShape shape{size};
  shape.exponent = random.uniform(4, 9);
  shape.is_dense = random.chance(0.75);
  shape.leaf_size = shape.is_dense ? random.uniform(0.04, 0.08) : random.uniform(0.06, 0.1);
  shape.depth = shape.is_dense ? random.uniform(0.01, 0.05) : random.uniform(0.04, 0.16);
  shape.density = shape.is_dense ? random.uniform(150, 350) : random.uniform(250, 450);
  shape.wave = random.uniform(0.02, 0.10);
  add_shrub(leaves.at({size.x() / 2, size.y() / 2, 0}), twigs, shape, random);
}

void add_rough_bush(const Brush& leaves, MaterialId twigs, double radius, Random& random) {
  ShrubShape shape{{2 * radius * random.uniform(0.8, 1.4), 2 * radius * random.uniform(0.8, 1.2),
                    radius * random.uniform(1.0, 1.9)}};
  shape.exponent = random.uniform(1.6, 3);
  shape.leaf_size = random.uniform(0.06, 0.11);
  shape.is_dense = random.chance(0.5);
  shape.depth = shape.is_dense ? random.uniform(0.03, 0.12) : random.uniform(0.1, 0.3);
  shape.density = random.uniform(120, 300);
  shape.wave = random.uniform(0.05, 0.2);
  add_shrub(leaves, twigs, shape, random);
}

}  // namespace vdbmap::simulator

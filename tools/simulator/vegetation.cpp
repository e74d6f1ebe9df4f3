// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/vegetation.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace vdbmap::simulator {
namespace {

using Point = Eigen::Vector3d;

constexpr double kLeafSize = 0.13;  // [m] edge of a leaf: a twig's worth of real ones
constexpr int kLeavesPerCluster = 60;
constexpr double kClusterRadius = 0.55;     // [m]
constexpr double kClustersPerSquare = 1.5;  // clusters by crown radius squared and height [1/m^3]
constexpr double kShareThatChanges = 0.05;  // of the clusters, from one epoch to the next
constexpr double kLeavesPerHedgeArea = 90;  // [1/m^2]
constexpr int kNumBranches = 13;

Point random_direction(Random& random) {
  const double z = random.uniform(-1, 1);
  const double angle = random.uniform(0, 2 * std::numbers::pi);
  const double radius = std::sqrt(1 - z * z);
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

void add_leaf(const Brush& brush, const Point& center, Random& random) {
  const Point normal = random_direction(random);
  const double size = kLeafSize * random.uniform(0.6, 1.3);
  const Point across = size / 2 * normal.unitOrthogonal();
  const Point along = size / 2 * normal.cross(across).normalized();
  add_quad(brush, center - across, center + along, center + across, center - along);
}

// Leaves about a twig, fewer towards its outside.
void add_cluster(const Brush& brush, const Point& center, double radius, int num_leaves, Random& random) {
  for (int i = 0; i < num_leaves; ++i) {
    add_leaf(brush, center + radius * std::sqrt(random.uniform(0, 1)) * random_direction(random), random);
  }
}

// A place in the crown: an egg with more of its leaves near the surface, where the light is.
Point place_in_crown(const Tree& tree, Random& random) {
  const Point direction = random_direction(random);
  const double share = std::pow(random.uniform(0, 1), 0.4);
  const Point radii(tree.crown_radius, tree.crown_radius, tree.crown_height / 2);
  const double middle = tree.trunk_height + 0.5 * tree.crown_height;
  return Point(0, 0, middle) + share * radii.cwiseProduct(direction);
}

void add_branch(const Brush& brush, const Point& from, const Point& to, double radius) {
  const Point bend = from + 0.5 * (to - from) + Point(0, 0, 0.08 * (to - from).norm());
  add_tube(brush, {from, bend, radius, radius * 0.7, 7});
  add_tube(brush, {bend, to, radius * 0.7, radius * 0.25, 6});
}

// Which clusters an epoch lacks.
bool is_bare(const Tree& tree, int cluster, int epoch) {
  const auto key = static_cast<std::uint64_t>(cluster) << 32 | static_cast<std::uint32_t>(epoch);
  return unit_interval(hash(tree.seed, key)) < kShareThatChanges;
}

}  // namespace

Tree make_tree(const Eigen::Isometry3d& scene_from_foot, double crown_radius, Random& random) {
  Tree tree{scene_from_foot, 0, 0, 0, 0};
  tree.crown_radius = crown_radius * random.uniform(0.8, 1.2);
  tree.crown_height = tree.crown_radius * random.uniform(1.7, 2.4);
  tree.trunk_height = 1.6 + 0.45 * tree.crown_radius + random.uniform(-0.2, 0.5);
  tree.trunk_radius = 0.055 * tree.crown_radius + random.uniform(0.02, 0.08);
  tree.seed = random.seed();
  return tree;
}

Tree make_low_tree(const Eigen::Isometry3d& scene_from_foot, double crown_radius, Random& random) {
  Tree tree = make_tree(scene_from_foot, crown_radius, random);
  tree.trunk_height = random.uniform(0.5, 1.1);
  return tree;
}

void add_wood(Mesh& mesh, const Tree& tree, const StandardMaterials& materials) {
  Random random(hash(tree.seed, 1));
  const Brush brush{&mesh, tree.scene_from_foot, materials.bark, tree.object};
  const Point fork(random.normal(0, 0.08), random.normal(0, 0.08), tree.trunk_height);
  const Point top(random.normal(0, 0.2), random.normal(0, 0.2), tree.trunk_height + 0.7 * tree.crown_height);
  add_tube(brush, {{0, 0, -0.2}, {0, 0, 0.35}, tree.trunk_radius * 1.5, tree.trunk_radius, 12});
  add_tube(brush, {{0, 0, 0.35}, fork, tree.trunk_radius, tree.trunk_radius * 0.8, 12});
  add_tube(brush, {fork, top, tree.trunk_radius * 0.8, 0.03, 8});
  for (int i = 0; i < kNumBranches; ++i) {
    const Point from = fork + random.uniform(0, 0.6) * (top - fork);
    Point tip = place_in_crown(tree, random);
    tip.z() = std::max(tip.z(), from.z() + 0.2);
    add_branch(brush, from, tip, tree.trunk_radius * random.uniform(0.25, 0.5));
    for (int twig = 0; twig < 2; ++twig) {
      add_branch(brush, from + 0.55 * (tip - from), tip + 0.7 * random_direction(random), tree.trunk_radius * 0.15);
    }
  }
}

void roughen(Tree& tree, Random& random) {
  const double lean = random.chance(0.2) ? random.uniform(0.08, 0.25) : std::abs(random.normal(0, 0.03));  // [rad]
  const double towards = random.uniform(0, 2 * std::numbers::pi);
  tree.scene_from_foot.rotate(Eigen::AngleAxisd(lean, Point(std::cos(towards), std::sin(towards), 0)));
  if (random.chance(0.25)) {
    tree.trunk_radius = random.uniform(0.25, 0.5);
    tree.crown_radius *= random.uniform(1.1, 1.7);
    tree.crown_height *= random.uniform(1.1, 1.5);
  }
  tree.trunk_height *= random.uniform(0.8, 1.3);
  tree.crown_height *= random.uniform(0.7, 1.3);
}

void add_crown(Mesh& mesh, const Tree& tree, int epoch, double leaf_share) {
  Random random(hash(tree.seed, 2));
  const Brush brush{&mesh, tree.scene_from_foot, tree.leaves, tree.object};
  const int num_clusters =
      static_cast<int>(kClustersPerSquare * tree.crown_radius * tree.crown_radius * tree.crown_height);
  const int num_leaves = static_cast<int>(kLeavesPerCluster * leaf_share);
  for (int i = 0; i < num_clusters; ++i) {
    const Point center = place_in_crown(tree, random);
    Random leaves(random.seed());
    if (!is_bare(tree, i, epoch)) add_cluster(brush, center, kClusterRadius, num_leaves, leaves);
  }
}

void add_hedge(const Brush& brush, const Eigen::Vector3d& size, Random& random) {
  constexpr double kInside = 0.12;  // [m] of leaves over the dark core
  add_box(brush, Point(kInside, kInside, -0.1), size - Point(kInside, kInside, kInside));
  const double area = 2 * (size.x() + size.y()) * size.z() + size.x() * size.y();
  const int num_leaves = static_cast<int>(kLeavesPerHedgeArea * area);
  for (int i = 0; i < num_leaves; ++i) {
    // A point of the box, moved to a side that is drawn by its area.
    Point point(random.uniform(0, size.x()), random.uniform(0, size.y()), random.uniform(0, size.z()));
    const double side = random.uniform(0, area);
    const double depth = random.uniform(0, kInside);
    const bool is_end = side > area - 2 * size.y() * size.z();
    if (side < size.x() * size.y()) {
      point.z() = size.z() - depth;
    } else if (is_end) {
      point.x() = random.chance(0.5) ? depth : size.x() - depth;
    } else {
      point.y() = random.chance(0.5) ? depth : size.y() - depth;
    }
    add_leaf(brush, point, random);
  }
}

void add_bush(const Brush& brush, double radius, Random& random) {
  const int num_clusters = 2 + static_cast<int>(10 * radius * radius);
  for (int i = 0; i < num_clusters; ++i) {
    Point center = 0.6 * radius * random_direction(random);
    center.z() = std::abs(center.z()) + 0.35 * radius;
    add_cluster(brush, center, 0.5 * radius, kLeavesPerCluster, random);
  }
}

}  // namespace vdbmap::simulator

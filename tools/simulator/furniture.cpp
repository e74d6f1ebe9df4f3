// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/furniture.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace vdbmap::simulator {
namespace {

using Point = Eigen::Vector3d;

// A plate with `num_sides` corners, seen along x.
void add_plate(const Brush& brush, const Point& center, double radius, int num_sides, double turn) {
  std::vector<Point> corners;
  for (int i = 0; i < num_sides; ++i) {
    const double angle = turn + 2 * std::numbers::pi * i / num_sides;
    corners.emplace_back(center + radius * Point(0, std::cos(angle), std::sin(angle)));
  }
  add_polygon(brush, corners);
}

void add_wheel(const Brush& brush, const Point& hub, double radius) {
  constexpr int kNumSegments = 16;
  const auto rim = [&](int i) {
    const double angle = 2 * std::numbers::pi * i / kNumSegments;
    return Point(hub + radius * Point(std::cos(angle), 0, std::sin(angle)));
  };
  for (int i = 0; i < kNumSegments; ++i) add_tube(brush, {rim(i), rim(i + 1), 0.018, 0.018, 5});
  for (int i = 0; i < kNumSegments; i += 2) add_tube(brush, {hub, rim(i), 0.003, 0.003, 3});
}

void add_limb(const Brush& brush, const Point& from, const Point& to, double radius) {
  add_tube(brush, {from, to, radius, radius * 0.75, 8, true});
}

}  // namespace

void add_lamp(const Brush& brush, const StandardMaterials& materials) {
  const Brush pole = brush.with(materials.steel);
  add_tube(pole, {{0, 0, -0.2}, {0, 0, 1.1}, 0.075, 0.075, 12, true});
  add_tube(pole, {{0, 0, 1.1}, {0, 0, 5.6}, 0.055, 0.04, 12});
  add_tube(pole, {{0, 0, 5.6}, {0, 1.1, 5.9}, 0.035, 0.03, 8});
  add_box(brush.with(materials.lamp), {-0.14, 0.9, 5.84}, {0.14, 1.55, 5.96});
}

void add_sign(const Brush& brush, SignKind kind, const StandardMaterials& materials) {
  const double height = kind == SignKind::kStreetName ? 2.6 : 2.4;  // [m] of the plate's middle
  add_tube(brush.with(materials.steel), {{0, 0, -0.2}, {0, 0, height + 0.3}, 0.03, 0.03, 8, true});
  const Point center(0.035, 0, height);
  switch (kind) {
    case SignKind::kNoStopping:
      return add_plate(brush.with(materials.sign_red), center, 0.21, 16, 0);
    case SignKind::kParking:
      return add_plate(brush.with(materials.sign_blue), center, 0.42, 4, std::numbers::pi / 4);
    case SignKind::kGiveWay:
      return add_plate(brush.with(materials.sign_white), center, 0.5, 3, -std::numbers::pi / 2);
    case SignKind::kStreetName:
      return add_box(brush.with(materials.sign_white), {0.03, -0.45, height - 0.1}, {0.04, 0.45, height + 0.1});
  }
}

void add_bollard(const Brush& brush, const StandardMaterials& materials) {
  add_tube(brush.with(materials.bollard), {{0, 0, -0.1}, {0, 0, 0.75}, 0.045, 0.045, 10, true});
  add_tube(brush.with(materials.sign_white), {{0, 0, 0.75}, {0, 0, 0.9}, 0.046, 0.04, 10, true});
}

void add_bin(const Brush& brush, bool is_large) {
  const double width = is_large ? 0.58 : 0.48;
  const double depth = is_large ? 0.70 : 0.52;
  const double height = is_large ? 1.02 : 0.88;
  const double foot = 0.78;  // the box widens upwards
  const auto outline = [&](double z, double scale) {
    const double x = scale * depth / 2;
    const double y = scale * width / 2;
    return std::vector<Point>{{-x, -y, z}, {x, -y, z}, {x, y, z}, {-x, y, z}};
  };
  add_loft(brush, outline(0.04, foot), outline(height, 0.96), true);
  add_loft(brush, outline(height, 1.05), outline(height + 0.05, 1.05), true);
  add_polygon(brush, outline(height + 0.05, 1.05));
  add_tube(brush, {{-depth / 2, -width / 2, 0.1}, {-depth / 2, width / 2, 0.1}, 0.1, 0.1, 10, true});
}

void add_bicycle(const Brush& brush, MaterialId tyre) {
  constexpr double kRadius = 0.34;  // [m] of a 28 inch wheel
  const Point rear(-0.52, 0, kRadius), front(0.55, 0, kRadius), pedals(-0.08, 0, 0.28), seat(-0.25, 0, 0.88),
      head(0.38, 0, 0.86), bar(0.33, 0, 1.04);
  add_wheel(brush.with(tyre), rear, kRadius - 0.018);
  add_wheel(brush.with(tyre), front, kRadius - 0.018);
  const std::array<std::array<Point, 2>, 7> tubes = {{{rear, pedals},
                                                      {rear, seat},
                                                      {pedals, seat},
                                                      {pedals, head},
                                                      {seat - Point(0, 0, 0.1), head},
                                                      {head, front},
                                                      {head, bar}}};
  for (const auto& tube : tubes) add_tube(brush, {tube[0], tube[1], 0.018, 0.018, 6});
  add_tube(brush.with(tyre), {bar - Point(0, 0.29, 0), bar + Point(0, 0.29, 0), 0.015, 0.015, 6, true});
  add_ellipsoid(brush.with(tyre), seat + Point(-0.02, 0, 0.08), {0.14, 0.08, 0.03}, 8);
  add_box(brush.with(tyre), rear + Point(-0.2, -0.07, 0.38), rear + Point(0.2, 0.07, 0.40));
}

void add_person(const Brush& brush, double height, double stride, const Clothes& clothes) {
  const double hip = 0.52 * height, shoulder = 0.82 * height;
  for (const double side : {-1.0, 1.0}) {
    const Point foot(side * std::sin(stride) * hip, side * 0.09, 0.05);
    const Point hip_joint(0, side * 0.09, hip);
    add_limb(brush.with(clothes.trousers), hip_joint, foot, 0.085);
    add_box(brush.with(clothes.trousers), foot + Point(-0.09, -0.045, -0.05), foot + Point(0.17, 0.045, 0.03));
    const Point hand(-side * std::sin(stride) * 0.45, side * 0.24, hip - 0.02);
    add_limb(brush.with(clothes.jacket), {0, side * 0.20, shoulder - 0.03}, hand, 0.055);
    add_ellipsoid(brush.with(clothes.skin), hand, {0.05, 0.04, 0.07}, 8);
  }
  add_ellipsoid(brush.with(clothes.jacket), {0, 0, (hip + shoulder) / 2}, {0.13, 0.22, (shoulder - hip) / 2 + 0.09},
                12);
  add_ellipsoid(brush.with(clothes.skin), {0.01, 0, 0.93 * height}, {0.10, 0.08, 0.07 * height}, 10);
}

void add_fence(const Brush& brush, double length, double height, double bar_distance) {
  for (const double z : {0.25 * height, 0.85 * height}) add_box(brush, {0, 0.02, z}, {length, 0.05, z + 0.06});
  for (double x = 0; x < length - 0.04; x += bar_distance) add_box(brush, {x, 0, 0.05}, {x + 0.045, 0.02, height});
  const int num_posts = 1 + static_cast<int>(length / 2.2);
  for (int i = 0; i <= num_posts; ++i) {
    const double x = length * i / num_posts;
    add_box(brush, {x - 0.04, 0.02, -0.2}, {x + 0.04, 0.10, height + 0.05});
  }
}

void add_shed(const Brush& brush, const Eigen::Vector3d& size, MaterialId door, MaterialId roof) {
  add_box(brush, {0, 0, -0.3}, size);
  add_box(brush.with(door), {0.25, -0.02, 0}, {size.x() - 0.25, 0, size.z() - 0.4});
  add_box(brush.with(roof), {-0.15, -0.15, size.z()}, {size.x() + 0.15, size.y() + 0.15, size.z() + 0.15});
}

}  // namespace vdbmap::simulator

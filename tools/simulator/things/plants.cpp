// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/things/plants.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/simulator/things/shrub.h"

namespace vdbmap::simulator {
namespace {

using Point = Eigen::Vector3d;
using Color = Eigen::Vector3f;

constexpr double kWinterLeaves = 0.12;  // share of the leaves that a shrub keeps; dead ones and evergreen neighbours

// Greens of different plants; in winter the few leaves left are brown.
Brush leaves_of(const Site& site) {
  const auto shade = static_cast<float>(site.random.uniform(0.7, 1.2));
  const Color green(.28F * shade, .42F * shade, .17F * shade), brown(.42F, .32F, .20F);
  return site.paint(SurfaceClass::kVegetation, site.is_winter ? brown : green,
                    static_cast<float>(site.random.uniform(0.35, 0.55)), 0, Texture::kLeaves);
}

void draw_shrub(const Site& site, ShrubShape shape, bool is_evergreen) {
  if (site.is_winter && !is_evergreen) shape.leaf_share = kWinterLeaves;
  add_shrub(leaves_of(site), site.standard().twigs, shape, site.random);
}

}  // namespace

void draw_clipped_hedge(const Site& site) {
  const Point size(site.length, site.random.uniform(0.5, 1.1), site.random.uniform(0.8, 2.1));
  add_rough_hedge(leaves_of(site).at({-size.x() / 2, -size.y() / 2, 0}), site.standard().twigs, size, site.random);
}

void draw_wild_bushes(const Site& site) {
  const std::size_t count = 1 + site.random.index(3);
  for (std::size_t i = 0; i < count; ++i) {
    const double radius = std::min(0.65 * site.width, site.random.uniform(0.4, 1.3));
    const double x = count == 1 ? 0 : site.random.uniform(-0.3, 0.3) * site.length;
    Site bush = site;
    bush.brush = site.brush.at({x, site.random.uniform(-0.3, 0.3), 0}, site.random.uniform(0, 6));
    ShrubShape shape{{2 * radius, 2 * radius * site.random.uniform(0.7, 1.1), radius * site.random.uniform(1.1, 2.1)}};
    shape.exponent = site.random.uniform(1.6, 2.6);
    shape.leaf_size = site.random.uniform(0.06, 0.12);
    shape.is_dense = site.random.chance(0.5);
    shape.depth = shape.is_dense ? site.random.uniform(0.04, 0.15) : site.random.uniform(0.12, 0.4);
    shape.density = site.random.uniform(100, 280);
    shape.wave = site.random.uniform(0.08, 0.3);
    draw_shrub(bush, shape, false);
  }
}

void draw_car_sized_shrub(const Site& site) {
  ShrubShape shape{{site.random.uniform(3.2, 4.8), site.random.uniform(1.3, 1.9), site.random.uniform(1.1, 1.8)}};
  shape.exponent = site.random.uniform(2.5, 7);
  shape.leaf_size = site.random.uniform(0.05, 0.09);
  shape.is_dense = site.random.chance(0.8);
  shape.depth = shape.is_dense ? site.random.uniform(0.01, 0.06) : site.random.uniform(0.05, 0.2);
  shape.density = site.random.uniform(200, 450);
  shape.wave = site.random.uniform(0.02, 0.12);
  draw_shrub(site, shape, true);
}

// Ground cover and low shrubs, as they grow between parking spaces and before houses: often without a rim, or with a
// low kerb, one plant beside the other.
void draw_planting(const Site& site) {
  const double half = site.length / 2, aside = site.width / 2;
  if (site.random.chance(0.4)) {
    const double rim = site.random.uniform(0.05, 0.2);
    const Brush kerb = site.brush.with(site.standard().kerb);
    for (const double side : {-1.0, 1.0}) {
      add_box(kerb, {-half, side * aside - 0.06, -0.2}, {half, side * aside + 0.06, rim});
      add_box(kerb, {side * half - 0.06, -aside, -0.2}, {side * half + 0.06, aside, rim});
    }
  }
  add_box(site.brush.with(site.standard().soil), {-half, -aside, -0.2}, {half, aside, 0.03});
  const bool is_evergreen = site.random.chance(0.5);
  const std::size_t count = 1 + site.random.index(4);
  const bool is_along = site.length >= site.width;
  const double pitch = std::max(site.length, site.width) / static_cast<double>(count);
  double height = site.random.uniform(0.15, 1.1);
  for (std::size_t i = 0; i < count; ++i) {
    if (site.random.chance(0.4)) height = site.random.uniform(0.12, 1.1);
    const double middle = pitch * (static_cast<double>(i) + 0.5) - std::max(half, aside);
    const double along = pitch * site.random.uniform(0.85, 1.15);
    const double across = std::min(site.length, site.width) * site.random.uniform(0.75, 1.0);
    ShrubShape shape{is_along ? Point(along, across, height) : Point(across, along, height)};
    shape.exponent = site.random.uniform(2.2, 8);
    shape.is_dense = site.random.chance(0.8);
    shape.leaf_size = shape.is_dense ? site.random.uniform(0.03, 0.07) : site.random.uniform(0.04, 0.1);
    shape.depth = shape.is_dense ? site.random.uniform(0.01, 0.04) : site.random.uniform(0.04, 0.15);
    shape.density = site.random.uniform(120, 300);
    shape.wave = site.random.uniform(0.02, 0.15);
    Site plant = site;
    plant.brush = site.brush.at(is_along ? Point(middle, 0, 0) : Point(0, middle, 0));
    draw_shrub(plant, shape, is_evergreen);
  }
}

// Knee to breast high, clipped, narrow: the border of a front garden.
void draw_low_hedge(const Site& site) {
  const Point size(site.length, site.random.uniform(0.3, 0.7), site.random.uniform(0.4, 1.2));
  add_rough_hedge(leaves_of(site).at({-size.x() / 2, -size.y() / 2, 0}), site.standard().twigs, size, site.random);
}

void draw_bed(const Site& site) {
  const Point half(site.length / 2, site.random.uniform(0.35, 0.7), 0);
  const double height = site.random.uniform(0.15, 0.5);
  const bool is_wood = site.random.chance(0.4);
  const Brush rim =
      site.paint(SurfaceClass::kOtherStructure, is_wood ? Color(.45F, .34F, .24F) : Color(.55F, .54F, .52F), 0.35F, 0,
                 is_wood ? Texture::kWood : Texture::kPlaster);
  for (const double side : {-1.0, 1.0}) {
    add_box(rim, {-half.x(), side * half.y() - 0.04, -0.2}, {half.x(), side * half.y() + 0.04, height});
    add_box(rim, {side * half.x() - 0.04, -half.y(), -0.2}, {side * half.x() + 0.04, half.y(), height});
  }
  add_box(site.brush.with(site.standard().soil), {-half.x(), -half.y(), -0.1}, {half.x(), half.y(), height - 0.06});
  ShrubShape shape{{2 * half.x() - 0.1, 2 * half.y() - 0.1, site.random.uniform(0.25, 0.8)}};
  shape.base = height - 0.06;
  shape.leaf_size = site.random.uniform(0.05, 0.1);
  shape.depth = 0.2;
  shape.density = site.random.uniform(80, 200);
  shape.wave = 0.3;
  shape.is_dense = site.random.chance(0.4);
  draw_shrub(site, shape, site.random.chance(0.5));
}

void draw_ivy(const Site& site) {
  const Brush leaves = leaves_of(site);
  const double height = site.random.uniform(2, 7);
  const int count = static_cast<int>(130 * site.length * height);
  for (int i = 0; i < std::min(count, 6000); ++i) {
    // Narrower towards its top.
    const double z = height * std::pow(site.random.uniform(0, 1), 1.4);
    const double x = site.length / 2 * (1 - 0.6 * z / height) * site.random.uniform(-1, 1);
    const Point center(x, -std::abs(site.random.normal(0.08, 0.06)), z);
    const Point along = 0.06 * Point(site.random.normal(0, 1), site.random.normal(0, 0.5), site.random.normal(0, 1));
    const Point across = 0.06 * Point(site.random.normal(0, 1), site.random.normal(0, 0.5), site.random.normal(0, 1));
    add_quad(leaves, center - along, center + across, center + along, center - across);
  }
}

void draw_tree_pit(const Site& site) {
  add_box(site.brush.with(site.standard().soil), {-0.9, -0.9, -0.2}, {0.9, 0.9, 0.02});
  const Brush guard = site.paint(SurfaceClass::kFence, Color(.25F, .26F, .25F), 0.2F);
  for (const double side : {-0.9, 0.9}) {
    add_tube(guard, {{-0.9, side, 0.35}, {0.9, side, 0.35}, 0.02, 0.02, 6});
    add_tube(guard, {{side, -0.9, 0.35}, {side, 0.9, 0.35}, 0.02, 0.02, 6});
    for (const double other : {-0.9, 0.9})
      add_tube(guard, {{side, other, -0.1}, {side, other, 0.37}, 0.02, 0.02, 6, true});
  }
  if (site.random.chance(0.4)) return;
  ShrubShape shape{{1.5, 1.5, site.random.uniform(0.2, 0.6)}};
  shape.density = 100;
  shape.wave = 0.3;
  draw_shrub(site, shape, false);
}

void draw_thick_trunk(const Site& site) {
  const Brush bark = site.brush.with(site.standard().bark);
  const double radius = site.random.uniform(0.28, 0.6);
  const double height = site.random.chance(0.3) ? site.random.uniform(0.4, 1.2) : site.random.uniform(4, 9);
  const Point lean(site.random.normal(0, 0.06) * height, site.random.normal(0, 0.06) * height, height);
  add_tube(bark, {{0, 0, -0.2}, 0.1 * lean, 1.35 * radius, radius, 14});
  add_tube(bark, {0.1 * lean, lean, radius, 0.75 * radius, 14, true});
  if (height < 2) return;
  for (int i = 0; i < 6; ++i) {
    const Point from = site.random.uniform(0.45, 0.95) * lean;
    const double angle = site.random.uniform(0, 2 * std::numbers::pi), reach = site.random.uniform(0.5, 2);
    const Point to = from + Point(reach * std::cos(angle), reach * std::sin(angle), 0.7 * reach);
    add_tube(bark, {from, to, 0.3 * radius, 0.2 * radius, 8, true});
  }
}

void draw_conifer(const Site& site) {
  const Brush leaves = leaves_of(site);
  const double height = site.random.uniform(2, 8), radius = height * site.random.uniform(0.14, 0.3);
  add_tube(site.brush.with(site.standard().bark), {{0, 0, -0.2}, {0, 0, 0.9 * height}, 0.03 * height, 0.02, 8});
  const int count = std::min(static_cast<int>(180 * height * radius), 6000);
  for (int i = 0; i < count; ++i) {
    const double z = height * (1 - std::sqrt(site.random.uniform(0, 1)));
    const double reach = radius * (1 - z / height) * std::pow(site.random.uniform(0, 1), 0.35);
    const double angle = site.random.uniform(0, 2 * std::numbers::pi);
    const Point center(reach * std::cos(angle), reach * std::sin(angle), z + 0.1);
    const Point out(0.12 * std::cos(angle), 0.12 * std::sin(angle), -0.04);
    const Point across = 0.05 * Point(-std::sin(angle), std::cos(angle), site.random.normal(0, 0.5));
    add_quad(leaves, center - out, center + across, center + out, center - across);
  }
}

void draw_tall_grass(const Site& site) {
  const Brush leaves = leaves_of(site);
  const int count = static_cast<int>(140 * site.length);
  for (int i = 0; i < count; ++i) {
    const Point foot(site.length / 2 * site.random.uniform(-1, 1), site.random.normal(0, 0.3), 0);
    const Point tip =
        foot + Point(site.random.normal(0, 0.1), site.random.normal(0, 0.1), site.random.uniform(0.15, 0.6));
    const Point across(0.015 * site.random.normal(0, 1), 0.015 * site.random.normal(0, 1), 0);
    add_triangle(leaves, foot - across, foot + across, tip);
  }
}

}  // namespace vdbmap::simulator

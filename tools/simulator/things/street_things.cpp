// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/things/street_things.h"

#include <array>
#include <cmath>
#include <vector>

#include "tools/simulator/furniture.h"

namespace vdbmap::simulator {
namespace {

using Point = Eigen::Vector3d;
using Color = Eigen::Vector3f;
using enum SurfaceClass;

Color any_color(Random& random) {
  return {static_cast<float>(random.uniform(.15, .85)), static_cast<float>(random.uniform(.15, .8)),
          static_cast<float>(random.uniform(.15, .8))};
}

Brush wood(const Site& site, SurfaceClass label) {
  return site.paint(label, Color(.55F, .43F, .30F), 0.4F, 0, Texture::kWood);
}

void add_table(const Brush& brush, double height) {
  add_tube(brush, {{0, 0, height - 0.03}, {0, 0, height}, 0.35, 0.35, 12, true});
  add_tube(brush, {{0, 0, 0}, {0, 0, height}, 0.03, 0.03, 6});
  add_tube(brush, {{0, 0, 0}, {0, 0, 0.03}, 0.2, 0.2, 10, true});
}

void add_chair(const Brush& brush) {
  add_box(brush, {-0.2, -0.2, 0.43}, {0.2, 0.2, 0.47});
  add_box(brush, {-0.2, 0.17, 0.47}, {0.2, 0.2, 0.85});
  for (const double x : {-0.18, 0.18}) {
    for (const double y : {-0.18, 0.18}) add_tube(brush, {{x, y, 0}, {x, y, 0.45}, 0.015, 0.015, 5});
  }
}

void add_parasol(const Brush& cloth, const Brush& pole) {
  add_tube(pole, {{0, 0, 0}, {0, 0, 2.4}, 0.025, 0.025, 6});
  add_tube(cloth, {{0, 0, 2.1}, {0, 0, 2.55}, 1.4, 0.05, 8});
}

}  // namespace

void draw_skip(const Site& site) {
  const double half = site.random.uniform(1.5, 2.2), width = site.random.uniform(0.75, 0.95),
               height = site.random.uniform(1.1, 1.7), slant = site.random.uniform(0.2, 0.7);
  const auto outline = [&](double z, double inset) {
    return std::vector<Point>{
        {-half + inset, -width, z}, {half - inset, -width, z}, {half - inset, width, z}, {-half + inset, width, z}};
  };
  const Brush steel = site.paint(kOtherObject, any_color(site.random), 0.3F, 0.1F);
  add_loft(steel, outline(0.08, slant), outline(height, 0), true);
  add_polygon(steel, outline(0.08, slant));
  for (const double side : {-width, width}) {
    for (const double x : {-0.6 * half, 0.0, 0.6 * half}) {
      add_box(steel, {x - 0.04, side - 0.05, 0.1}, {x + 0.04, side + 0.05, height});
    }
  }
  const double fill = site.random.uniform(0.3, 1.05) * height;
  const Brush rubble = site.paint(kOtherObject, Color(.50F, .45F, .40F), 0.35F, 0, Texture::kPlaster);
  for (int i = 0; i < 40; ++i) {
    const Point at(site.random.uniform(-0.8, 0.8) * (half - slant), site.random.uniform(-0.8, 0.8) * width, fill);
    const double s = site.random.uniform(0.08, 0.35);
    add_box(rubble.at(at, site.random.uniform(0, 3)), {-s, -0.6 * s, -0.6}, {s, 0.6 * s, site.random.uniform(0, 0.25)});
  }
}

void draw_scaffolding(const Site& site) {
  const Brush steel = site.paint(kOtherStructure, Color(.60F, .61F, .62F), 0.4F, 0.2F);
  const Brush planks = wood(site, kOtherStructure);
  const int storeys = 2 + static_cast<int>(site.random.index(4));
  const double half = site.length / 2, height = 2.0 * storeys + 1;
  for (double x = -half; x <= half + 0.01; x += 2.5) {
    for (const double y : {-0.6, 0.2}) add_tube(steel, {{x, y, 0}, {x, y, height}, 0.025, 0.025, 6});
  }
  for (int storey = 1; storey <= storeys; ++storey) {
    const double z = 2.0 * storey;
    add_box(planks, {-half, -0.6, z - 0.05}, {half, 0.2, z});
    for (const double rail : {0.5, 1.0})
      add_tube(steel, {{-half, -0.6, z + rail}, {half, -0.6, z + rail}, 0.02, 0.02, 5});
    if (storey % 2 == 1) add_tube(steel, {{-half, -0.62, z - 2}, {-half + 2.5, -0.62, z}, 0.02, 0.02, 5});
  }
  if (!site.random.chance(0.35)) return;
  // A net that lets two thirds of the light through.
  const Brush net = site.brush.with(
      site.world.add_material({kOtherStructure, Color(.75F, .78F, .76F), 0.4F, 0.65F, 0, Texture::kPlain}));
  add_quad(net, {-half, -0.65, 2}, {half, -0.65, 2}, {half, -0.65, height}, {-half, -0.65, height});
}

void draw_cafe(const Site& site) {
  const Brush metal = site.paint(kOtherObject, any_color(site.random), 0.4F, 0.1F);
  const Brush cloth = site.paint(kOtherObject, any_color(site.random), 0.5F);
  const int count = std::max(1, static_cast<int>(site.length / 1.9));
  for (int i = 0; i < count; ++i) {
    const Brush at =
        metal.at({site.length * ((i + 0.5) / count - 0.5), site.random.normal(0, 0.1), 0}, site.random.uniform(0, 6));
    add_table(at, 0.74);
    const std::size_t chairs = 2 + site.random.index(3);
    for (std::size_t c = 0; c < chairs; ++c) {
      const double angle = 1.57 * static_cast<double>(c) + site.random.normal(0, 0.2);
      add_chair(at.at({0.62 * std::cos(angle), 0.62 * std::sin(angle), 0}, angle - 1.57));
    }
    if (site.random.chance(0.35)) add_parasol(at.with(cloth.material), at);
  }
}

void draw_market_stall(const Site& site) {
  const Brush frame = site.paint(kOtherStructure, Color(.6F, .6F, .6F), 0.4F, 0.1F);
  const Brush cloth = site.paint(kOtherStructure, any_color(site.random), 0.5F);
  const Brush goods = site.paint(kOtherObject, any_color(site.random), 0.4F);
  const double half = site.length / 2;
  for (const double x : {-half, half}) {
    for (const double y : {-0.9, 0.9}) add_tube(frame, {{x, y, 0}, {x, y, 2.2}, 0.025, 0.025, 6});
  }
  add_quad(cloth, {-half - 0.2, -1.2, 2.0}, {half + 0.2, -1.2, 2.0}, {half + 0.2, 0, 2.6}, {-half - 0.2, 0, 2.6});
  add_quad(cloth, {-half - 0.2, 1.2, 2.0}, {half + 0.2, 1.2, 2.0}, {half + 0.2, 0, 2.6}, {-half - 0.2, 0, 2.6});
  add_box(frame, {-half, -0.9, 0.75}, {half, -0.1, 0.8});
  add_quad(cloth, {-half, -0.91, 0.1}, {half, -0.91, 0.1}, {half, -0.91, 0.78}, {-half, -0.91, 0.78});
  for (double x = -half + 0.1; x < half - 0.4; x += 0.5) {
    const double height = site.random.uniform(0.05, 0.35);
    add_box(goods, {x, -0.85, 0.8}, {x + 0.42, -0.3, 0.8 + height});
  }
}

void draw_pallets(const Site& site) {
  const Brush planks = wood(site, kOtherObject);
  const std::size_t stacks = 1 + site.random.index(2);
  for (std::size_t s = 0; s < stacks; ++s) {
    const Brush stack =
        planks.at({1.4 * static_cast<double>(s), site.random.normal(0, 0.1), 0}, site.random.normal(0, 0.1));
    const int count = 1 + static_cast<int>(site.random.index(9));
    for (int i = 0; i < count; ++i) {
      const double z = 0.144 * i;
      for (const double y : {-0.4, -0.05, 0.3}) add_box(stack, {-0.6, y, z}, {0.6, y + 0.1, z + 0.12});
      for (double x = -0.6; x < 0.55; x += 0.22) add_box(stack, {x, -0.4, z + 0.12}, {x + 0.14, 0.4, z + 0.144});
    }
    if (!site.random.chance(0.4)) continue;
    const Brush load = site.paint(kOtherObject, any_color(site.random), 0.4F).at({1.4 * static_cast<double>(s), 0, 0});
    add_box(load, {-0.55, -0.38, 0.144 * count}, {0.55, 0.38, 0.144 * count + site.random.uniform(0.3, 1.1)});
  }
}

void draw_snow_heap(const Site& site) {
  const Brush snow = site.brush.with(site.standard().snow);
  for (int i = 0; i < 6; ++i) {
    const Point at(site.random.uniform(-0.4, 0.4) * site.length, site.random.normal(0, 0.2), 0);
    add_ellipsoid(snow, at,
                  {site.random.uniform(0.4, 1.2), site.random.uniform(0.3, 0.7), site.random.uniform(0.25, 0.9)}, 12);
  }
}

void draw_construction_fence(const Site& site) {
  const Brush steel = site.paint(kFence, Color(.62F, .64F, .65F), 0.4F, 0.2F);
  const Brush foot = site.paint(kOtherObject, Color(.25F, .25F, .25F), 0.2F);
  const int fields = std::max(1, static_cast<int>(site.length / 3.5));
  double x = -1.75 * fields, y = 0;
  for (int field = 0; field < fields; ++field) {
    const double yaw = 0.12 * site.random.uniform(-1, 1);
    const Brush at = steel.at({x, y, 0}, yaw);
    for (const double end : {0.0, 3.45}) add_tube(at, {{end, 0, 0.05}, {end, 0, 2.0}, 0.02, 0.02, 6});
    for (const double z : {0.15, 2.0}) add_tube(at, {{0, 0, z}, {3.45, 0, z}, 0.02, 0.02, 6});
    for (double bar = 0.15; bar < 3.4; bar += 0.15) add_tube(at, {{bar, 0, 0.15}, {bar, 0, 2.0}, 0.003, 0.003, 3});
    for (double z = 0.4; z < 2; z += 0.3) add_tube(at, {{0, 0, z}, {3.45, 0, z}, 0.003, 0.003, 3});
    add_box(foot.at({x, y, 0}), {-0.35, -0.12, 0}, {0.35, 0.12, 0.12});
    x += 3.5 * std::cos(yaw);
    y += 3.5 * std::sin(yaw);
  }
}

void draw_bin_row(const Site& site) {
  const std::array<Color, 4> colors = {
      {{.25F, .26F, .27F}, {.12F, .25F, .50F}, {.40F, .28F, .16F}, {.78F, .65F, .10F}}};
  const int count = std::max(1, static_cast<int>(site.length / 0.75));
  for (int i = 0; i < count; ++i) {
    if (site.random.chance(0.2)) continue;
    const Brush bin = site.paint(kOtherObject, colors[site.random.index(4)], 0.3F, 0.1F);
    const double x = site.length * ((i + 0.5) / count - 0.5);
    add_bin(bin.at({x, site.random.normal(0, 0.12), 0}, 1.57 + site.random.normal(0, 0.35)), site.random.chance(0.6));
  }
}

void draw_wide_sign(const Site& site) {
  const Brush post = site.brush.with(site.standard().steel);
  const double half = site.random.uniform(0.6, 1.5), low = site.random.uniform(1.8, 2.4),
               height = site.random.uniform(0.5, 1.2);
  for (const double y : {-0.8 * half, 0.8 * half}) add_tube(post, {{0, y, -0.2}, {0, y, low + height}, 0.04, 0.04, 8});
  const MaterialId plate = site.random.chance(0.5) ? site.standard().sign_blue : site.standard().sign_white;
  add_box(site.brush.with(plate), {-0.06, -half, low}, {-0.04, half, low + height});
}

void draw_cabinet(const Site& site) {
  const Brush box = site.paint(kOtherObject, Color(.62F, .64F, .60F), 0.4F, 0.1F);
  const double half = site.random.uniform(0.3, 0.8);
  add_box(box, {-half, -0.2, 0}, {half, 0.2, site.random.uniform(0.9, 1.6)});
}

void draw_bench(const Site& site) {
  const Brush slats = wood(site, kOtherObject);
  for (const double y : {-0.2, -0.05, 0.1}) add_box(slats, {-0.9, y, 0.43}, {0.9, y + 0.1, 0.46});
  for (const double z : {0.6, 0.75}) add_box(slats, {-0.9, 0.22, z}, {0.9, 0.25, z + 0.1});
  for (const double x : {-0.7, 0.7}) add_box(slats, {x - 0.03, -0.2, 0}, {x + 0.03, 0.26, 0.43});
}

void draw_bus_shelter(const Site& site) {
  const Brush frame = site.paint(kOtherStructure, Color(.35F, .36F, .38F), 0.3F, 0.1F);
  const Brush glass =
      site.brush.with(site.world.add_material({kOtherStructure, Color(.55F, .62F, .64F), 0.06F, 0.75F, 0.7F}));
  for (const double x : {-1.8, 0.0, 1.8}) add_tube(frame, {{x, 0.6, 0}, {x, 0.6, 2.4}, 0.04, 0.04, 8});
  add_box(frame, {-2, -0.7, 2.4}, {2, 0.75, 2.5});
  add_quad(glass, {-1.8, 0.6, 0.3}, {1.8, 0.6, 0.3}, {1.8, 0.6, 2.3}, {-1.8, 0.6, 2.3});
  add_quad(glass, {1.8, -0.4, 0.3}, {1.8, 0.6, 0.3}, {1.8, 0.6, 2.3}, {1.8, -0.4, 2.3});
  add_box(frame, {-1.2, 0.25, 0.42}, {1.2, 0.55, 0.47});
}

void draw_parked_bicycles(const Site& site) {
  const MaterialId tyre = site.world.add_material({kBicycle, Color(.1F, .1F, .1F), .1F});
  const int count = 1 + static_cast<int>(site.random.index(5));
  for (int i = 0; i < count; ++i) {
    const Brush frame = site.paint(kBicycle, any_color(site.random), 0.4F, 0.2F);
    const Brush upright = frame.at({0.55 * (i - count / 2.0), 0, 0}, 1.57 + site.random.normal(0, 0.15));
    add_bicycle(upright.at(Eigen::Isometry3d(Eigen::AngleAxisd(site.random.normal(0, 0.12), Point::UnitX()))), tyre);
  }
}

}  // namespace vdbmap::simulator

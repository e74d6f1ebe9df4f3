// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/things/garden_things.h"

#include <algorithm>
#include <cmath>

#include "tools/simulator/things/plants.h"
#include "tools/simulator/things/shrub.h"

namespace vdbmap::simulator {
namespace {

using Point = Eigen::Vector3d;
using Color = Eigen::Vector3f;

}  // namespace

void draw_bank(const Site& site) {
  constexpr double kReach = 0.8;  // [m] beyond the room, at most
  const Brush grass = site.brush.with(site.standard().grass);
  const double height = site.random.uniform(0.3, 1.1);
  const std::size_t count = 1 + site.random.index(3);
  for (std::size_t i = 0; i < count; ++i) {
    const double y = site.random.normal(0, 0.15);
    const double x = site.length * (site.random.uniform(0.3, 0.7) - 0.5);
    const double half = std::min(site.length * site.random.uniform(0.25, 0.5), site.length / 2 + kReach - std::abs(x));
    const double width = site.width * site.random.uniform(0.35, 0.5);
    add_ellipsoid(grass, {x, y, -0.1}, {half, width, 0.1 + height * site.random.uniform(0.6, 1)}, 24);
  }
  if (site.random.chance(0.5)) draw_tall_grass(site);
}

void draw_boulders(const Site& site) {
  const Brush stone = site.paint(SurfaceClass::kOtherObject, Color(.50F, .49F, .46F), 0.35F, 0, Texture::kPlaster);
  const std::size_t count = 1 + site.random.index(3);
  for (std::size_t i = 0; i < count; ++i) {
    const double size = site.random.uniform(0.2, 0.6);
    const double x = site.length * ((static_cast<double>(i) + 0.5) / static_cast<double>(count) - 0.5);
    add_ellipsoid(stone.at({x, site.random.normal(0, 0.1), 0.3 * size}, site.random.uniform(0, 6)), {0, 0, 0},
                  {size, size * site.random.uniform(0.6, 1), size * site.random.uniform(0.5, 0.9)},
                  6 + 2 * static_cast<int>(site.random.index(3)));
  }
}

void draw_walled_hedge(const Site& site) {
  const double depth = site.random.uniform(0.25, 0.4), wall = site.random.uniform(0.25, 0.8), half = site.length / 2;
  const MaterialId stone =
      site.random.chance(0.5)
          ? site.standard().brick_wall
          : site.world.add_material({SurfaceClass::kFence, Color(.66F, .65F, .62F), .4F, 0, 0, Texture::kPlaster});
  add_box(site.brush.with(stone), {-half, -depth / 2, -0.3}, {half, depth / 2, wall});
  const Point size(site.length, depth + site.random.uniform(0.1, 0.4), site.random.uniform(0.3, 1.2));
  const Brush leaves = site.paint(SurfaceClass::kVegetation, Color(.26F, .40F, .16F), 0.45F, 0, Texture::kLeaves);
  add_rough_hedge(leaves.at({-half, -size.y() / 2 + 0.05, wall - 0.05}), site.standard().twigs, size, site.random);
}

}  // namespace vdbmap::simulator

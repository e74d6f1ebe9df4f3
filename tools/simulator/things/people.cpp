// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/things/people.h"

#include <cmath>
#include <numbers>

#include "tools/simulator/furniture.h"
#include "tools/simulator/things/large_vehicles.h"

namespace vdbmap::simulator {
namespace {

using Point = Eigen::Vector3d;
using Color = Eigen::Vector3f;
using enum SurfaceClass;

Brush cloth(const Site& site, SurfaceClass label) {
  const Color color(static_cast<float>(site.random.uniform(.08, .8)), static_cast<float>(site.random.uniform(.08, .7)),
                    static_cast<float>(site.random.uniform(.08, .8)));
  return site.paint(label, color, static_cast<float>(site.random.uniform(0.1, 0.6)));
}

Clothes clothes_of(const Site& site, SurfaceClass label) {
  return {site.paint(label, Color(.74F, .57F, .47F), 0.5F).material, cloth(site, label).material,
          cloth(site, label).material};
}

// An adult, or one time in six a child.
double any_height(Random& random) {
  return random.chance(0.17) ? random.uniform(1.0, 1.5) : std::clamp(random.normal(1.72, 0.09), 1.5, 1.98);
}

void add_any_person(const Site& site, const Brush& at) {
  const Clothes clothes = clothes_of(site, kPerson);
  add_person(at, any_height(site.random), site.random.uniform(0, 0.5), clothes);
  if (!site.random.chance(0.4)) return;
  // A bag on the back, or in the hand.
  const bool is_rucksack = site.random.chance(0.5);
  const Brush bag = at.with(clothes.trousers);
  if (is_rucksack) add_box(bag, {-0.32, -0.15, 1.0}, {-0.12, 0.15, 1.45});
  if (!is_rucksack) add_box(bag, {-0.15, 0.26, 0.35}, {0.15, 0.36, 0.7});
}

// Seated from the hips up, legs forward; the seat's height [m].
void add_rider(const Brush& at, double seat, double lean, const Clothes& clothes) {
  const Point hip(-0.2, 0, seat), shoulder = hip + Point(0.5 * std::sin(lean), 0, 0.5 * std::cos(lean));
  for (const double side : {-1.0, 1.0}) {
    const Point knee = hip + Point(0.38, side * 0.14, -0.12);
    add_tube(at.with(clothes.trousers), {hip + Point(0, side * 0.1, 0), knee, 0.09, 0.07, 8, true});
    add_tube(at.with(clothes.trousers), {knee, knee + Point(-0.12, 0, -0.42), 0.07, 0.05, 8, true});
    add_tube(at.with(clothes.jacket),
             {shoulder + Point(0, side * 0.19, -0.04), {0.33, side * 0.27, seat + 0.17}, 0.055, 0.045, 8, true});
  }
  add_ellipsoid(at.with(clothes.jacket), (hip + shoulder) / 2, {0.16, 0.21, 0.34}, 12);
  add_ellipsoid(at.with(clothes.skin), shoulder + Point(0.05, 0, 0.25), {0.12, 0.1, 0.14}, 10);
}

}  // namespace

void draw_person(const Site& site) { add_any_person(site, site.brush); }

void draw_group(const Site& site) {
  const std::size_t count = 2 + site.random.index(4);
  for (std::size_t i = 0; i < count; ++i) {
    const double angle =
        2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count) + site.random.normal(0, 0.3);
    const double reach = 0.45 + 0.1 * static_cast<double>(count);
    add_any_person(site,
                   site.brush.at({reach * std::cos(angle), reach * std::sin(angle), 0}, angle + std::numbers::pi));
  }
}

void draw_cyclist(const Site& site) {
  const Brush frame = cloth(site, kBicyclist);
  add_bicycle(frame, site.paint(kBicyclist, Color(.1F, .1F, .1F), .1F).material);
  add_rider(site.brush, 0.98, site.random.uniform(0.1, 0.6), clothes_of(site, kBicyclist));
}

void draw_motorcyclist(const Site& site) {
  const VehicleShape shape = make_large_shape(VehicleBody::kMotorcycle, 3, site.random);
  const MaterialId paint = site.world.add_paint(kMotorcyclist, site.random);
  add_large_vehicle(site.brush.with(paint), shape, site.world.vehicle(kMotorcyclist));
  add_rider(site.brush, 0.85, 0.2, clothes_of(site, kMotorcyclist));
}

void draw_wheelchair(const Site& site) {
  const Brush frame = site.paint(kPerson, Color(.2F, .2F, .22F), 0.2F);
  for (const double side : {-0.3, 0.3}) {
    add_tube(frame, {{-0.1, side - 0.02, 0.3}, {-0.1, side + 0.02, 0.3}, 0.3, 0.3, 16, false});
    add_tube(frame, {{0.35, side - 0.02, 0.09}, {0.35, side + 0.02, 0.09}, 0.09, 0.09, 10, true});
  }
  add_box(frame, {-0.25, -0.24, 0.45}, {0.25, 0.24, 0.5});
  add_box(frame, {-0.3, -0.24, 0.5}, {-0.25, 0.24, 0.95});
  add_rider(site.brush.at({0.1, 0, 0}), 0.6, 0.0, clothes_of(site, kPerson));
  if (site.random.chance(0.5)) add_any_person(site, site.brush.at({-0.75, 0, 0}));
}

void draw_pram(const Site& site) {
  const Brush hood = cloth(site, kOtherObject);
  add_any_person(site, site.brush.at({-0.55, 0, 0}));
  add_ellipsoid(hood, {0.35, 0, 0.75}, {0.42, 0.24, 0.25}, 10);
  for (const double x : {0.1, 0.6}) {
    for (const double y : {-0.27, 0.27})
      add_tube(hood, {{x, y - 0.02, 0.14}, {x, y + 0.02, 0.14}, 0.14, 0.14, 12, true});
  }
  for (const double y : {-0.22, 0.22}) add_tube(hood, {{0.2, y, 0.6}, {-0.35, y, 1.02}, 0.015, 0.015, 6});
  add_tube(hood, {{-0.35, -0.22, 1.02}, {-0.35, 0.22, 1.02}, 0.015, 0.015, 6});
}

void draw_dog(const Site& site) {
  add_any_person(site, site.brush.at({-0.9, 0.3, 0}));
  const Brush fur = site.paint(kOtherObject, Color(.40F, .30F, .20F), 0.4F);
  const double size = site.random.uniform(0.6, 1.1);
  const auto p = [&](double x, double y, double z) { return Point(size * x, size * y, size * z); };
  add_ellipsoid(fur, p(0, 0, 0.5), p(0.4, 0.14, 0.17), 10);
  add_ellipsoid(fur, p(0.48, 0, 0.68), p(0.17, 0.1, 0.11), 10);
  add_tube(fur, {p(-0.35, 0, 0.55), p(-0.6, 0, 0.75), 0.03, 0.015, 6});
  for (const double x : {-0.28, 0.28}) {
    for (const double y : {-0.1, 0.1}) add_tube(fur, {p(x, y, 0.45), p(x, y, 0), 0.05 * size, 0.03 * size, 6, true});
  }
}

}  // namespace vdbmap::simulator

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/things/large_vehicles.h"

#include <array>
#include <utility>
#include <vector>

namespace vdbmap::simulator {
namespace {

using Point = Eigen::Vector3d;

constexpr double kDoorLength = 1.05;  // [m]
constexpr double kDoorHinge = 0.30;   // of a car's length from its front

// A vehicle's parts by the shape's measures: x = 0 in its middle.
struct LargeVehicle {
  const Brush& paint;
  const VehicleShape& shape;
  const VehicleMaterials& materials;

  double front() const { return shape.length / 2; }
  double half_width() const { return shape.width / 2; }

  void draw_wheels(double x, double tyre_width) const {
    const double r = shape.wheel_radius;
    for (const double side : {-1.0, 1.0}) {
      const double outside = side * (half_width() - 0.02);
      add_tube(paint.with(materials.tyre), {{x, outside - side * tyre_width, r}, {x, outside, r}, r, r, 18, true});
      add_tube(paint.with(materials.rim),
               {{x, outside - 0.01, r}, {x, outside + 0.01, r}, 0.55 * r, 0.55 * r, 12, true});
    }
  }

  // A prism across the vehicle of an outline in x and z.
  void draw_prism(const Brush& brush, const std::vector<std::pair<double, double>>& outline, double half) const {
    std::vector<Point> left, right;
    for (const auto& [x, z] : outline) {
      left.emplace_back(x, half, z);
      right.emplace_back(x, -half, z);
    }
    add_loft(brush, left, right, true);
    add_polygon(brush, left);
    add_polygon(brush, right);
  }

  // Bonnet, sloping windscreen and roof of a cab that ends at x = `back`.
  void draw_cab(double back, double top) const {
    const double w = half_width() - 0.04;
    const double belt = 0.45 * top + 0.25;
    const double nose = shape.body == VehicleBody::kBoxVan ? 0.85 : 0.1;
    draw_prism(paint, {{back, 0.35}, {front(), 0.35}, {front(), belt - 0.25}, {front() - nose, belt}, {back, belt}}, w);
    const double roof_front = front() - nose - 0.45;
    const Brush glass = paint.with(materials.glass);
    for (const double side : {-w, w}) {
      const std::array<Point, 4> window = {{{back + 0.15, side, belt},
                                            {front() - nose, side, belt},
                                            {roof_front, side, top - 0.2},
                                            {back + 0.15, side, top - 0.2}}};
      add_polygon(glass, window);
    }
    add_quad(glass, {front() - nose, -w, belt}, {front() - nose, w, belt}, {roof_front, w, top - 0.2},
             {roof_front, -w, top - 0.2});
    add_box(paint, {back, -w, top - 0.2}, {roof_front, w, top});
    add_box(paint.with(materials.interior), {back + 0.25, -0.8 * w, 0.6}, {back + 0.6, 0.8 * w, belt + 0.3});
    add_box(paint.with(materials.headlight), {front() - 0.1, -0.8 * w, 0.65}, {front() + 0.01, -0.55 * w, 0.85});
    add_box(paint.with(materials.headlight), {front() - 0.1, 0.55 * w, 0.65}, {front() + 0.01, 0.8 * w, 0.85});
    for (const double side : {-1.0, 1.0}) {
      add_box(paint.with(materials.trim), {roof_front, side * w - 0.12 + side * 0.12, belt + 0.2},
              {roof_front + 0.1, side * w + 0.12 + side * 0.12, belt + 0.6});
    }
  }

  void draw_rear() const {
    const double w = half_width();
    add_box(paint.with(materials.plate), {-front() - 0.006, -0.26, 0.6}, {-front() + 0.05, 0.26, 0.71});
    for (const double side : {-0.85, 0.75}) {
      add_box(paint.with(materials.tail_light), {-front() - 0.004, side * w, 0.8},
              {-front() + 0.1, (side + 0.1) * w, 1.0});
    }
  }

  void draw_box_truck() const {
    const double cab = shape.body == VehicleBody::kTruck ? 1.9 : 2.3;
    const double floor = shape.body == VehicleBody::kTruck ? 1.0 : 0.7;
    add_box(paint, {-front(), -half_width(), floor}, {front() - cab - 0.08, half_width(), shape.height});
    draw_cab(front() - cab, std::min(shape.height, shape.body == VehicleBody::kTruck ? 2.9 : 2.35));
    add_box(paint.with(materials.trim), {-front() + 0.1, -0.45, floor - 0.3}, {front() - cab, 0.45, floor});
    add_box(paint.with(materials.trim), {-front(), -half_width() + 0.1, 0.45},
            {-front() + 0.08, half_width() - 0.1, 0.6});
    draw_wheels(shape.wheelbase / 2 + 0.2, 0.28);
    draw_wheels(-shape.wheelbase / 2 + 0.2, shape.body == VehicleBody::kTruck ? 0.55 : 0.28);
    draw_rear();
  }

  void draw_bus() const {
    const double w = half_width(), sill = 1.05, top = shape.height - 0.45;
    draw_prism(paint, {{-front(), 0.3}, {front(), 0.3}, {front(), sill}, {-front(), sill}}, w);
    add_box(paint, {-front(), -w, top}, {front(), w, shape.height});
    const Brush glass = paint.with(materials.glass);
    for (const double side : {-w + 0.02, w - 0.02}) {
      add_quad(glass, {-front(), side, sill}, {front(), side, sill}, {front(), side, top}, {-front(), side, top});
    }
    for (const double end : {-front() + 0.02, front() - 0.02}) {
      add_quad(glass, {end, -w, sill}, {end, w, sill}, {end, w, top}, {end, -w, top});
    }
    for (double x = -front(); x <= front(); x += shape.length / 8) {
      for (const double side : {-1.0, 1.0})
        add_box(paint, {x - 0.05, side * w - 0.04, sill}, {x + 0.05, side * w + 0.04, top});
    }
    for (double x = -front() + 1; x < front() - 1.5; x += 0.85) {
      for (const double side : {-0.55, 0.55}) {
        add_box(paint.with(materials.interior), {x, side * w - 0.4, 0.5}, {x + 0.12, side * w + 0.4, 1.35});
      }
    }
    draw_wheels(front() - 2.6, 0.3);
    draw_wheels(-front() + 3.2, 0.55);
    draw_rear();
  }

  void draw_hitch(double back, double z) const {
    add_tube(paint.with(materials.trim), {{back, 0, z}, {front(), 0, z}, 0.05, 0.05, 6, true});
    add_tube(paint.with(materials.trim), {{front() - 0.15, 0, 0}, {front() - 0.15, 0, z}, 0.04, 0.04, 6, true});
  }

  void draw_caravan() const {
    const double body = front() - 1.1, h = shape.height;
    draw_prism(
        paint,
        {{-front(), 0.5}, {-front() - 0.0, 1.2}, {-front() + 0.35, h}, {body - 0.5, h}, {body, 1.4}, {body - 0.1, 0.5}},
        half_width());
    for (const double side : {-1.0, 1.0}) {
      const double y = side * (half_width() + 0.004);
      add_quad(paint.with(materials.trim), {-0.6, y, 1.3}, {0.5, y, 1.3}, {0.5, y, 1.9}, {-0.6, y, 1.9});
    }
    draw_wheels(-0.3, 0.2);
    draw_hitch(body, 0.5);
    draw_rear();
  }

  // A flat bed with low walls; the higher ones have a tarpaulin over them.
  void draw_trailer() const {
    const double body = front() - 0.9, w = half_width() - 0.12;
    const bool is_covered = shape.height > 1.4;
    const double wall = is_covered ? shape.height : std::min(shape.height, 1.0);
    add_box(paint, {-front(), -w, 0.5}, {body, w, 0.58});
    if (is_covered) {
      add_box(paint, {-front(), -w, 0.58}, {body, w, wall});
    } else {
      for (const double side : {-w, w - 0.04}) add_box(paint, {-front(), side, 0.58}, {body, side + 0.04, wall});
      for (const double end : {-front(), body - 0.04}) add_box(paint, {end, -w, 0.58}, {end + 0.04, w, wall});
    }
    draw_wheels(-0.25, 0.18);
    draw_hitch(body, 0.5);
    add_box(paint.with(materials.plate), {-front() - 0.006, -0.26, 0.52}, {-front(), 0.26, 0.63});
  }

  void draw_motorcycle() const {
    const double r = shape.wheel_radius, rear = -shape.wheelbase / 2, fore = shape.wheelbase / 2;
    for (const double x : {rear, fore}) {
      add_tube(paint.with(materials.tyre), {{x, -0.07, r}, {x, 0.07, r}, r, r, 16, true});
    }
    const Brush metal = paint.with(materials.rim);
    for (const double side : {-0.09, 0.09})
      add_tube(metal, {{fore, side, r}, {fore - 0.28, side, 0.95}, 0.03, 0.03, 6});
    add_tube(metal, {{fore - 0.3, -0.38, 1.0}, {fore - 0.3, 0.38, 1.0}, 0.025, 0.025, 6, true});
    add_ellipsoid(paint, {0.12, 0, 0.78}, {0.32, 0.16, 0.17}, 10);
    add_box(paint.with(materials.trim), {rear - 0.15, -0.14, 0.72}, {-0.1, 0.14, 0.84});
    add_box(metal, {-0.25, -0.2, 0.2}, {0.3, 0.2, 0.6});
    add_tube(metal, {{0.2, 0.18, 0.3}, {rear, 0.2, 0.33}, 0.05, 0.06, 8, true});
    add_box(paint.with(materials.headlight), {fore - 0.22, -0.09, 0.85}, {fore - 0.1, 0.09, 1.02});
    add_box(paint.with(materials.plate), {rear - 0.32, -0.1, 0.5}, {rear - 0.31, 0.1, 0.7});
  }
};

}  // namespace

void add_large_vehicle(const Brush& paint, const VehicleShape& shape, const VehicleMaterials& materials) {
  const LargeVehicle vehicle{paint, shape, materials};
  switch (shape.body) {
    case VehicleBody::kBus:
      return vehicle.draw_bus();
    case VehicleBody::kCaravan:
      return vehicle.draw_caravan();
    case VehicleBody::kTrailer:
      return vehicle.draw_trailer();
    case VehicleBody::kMotorcycle:
      return vehicle.draw_motorcycle();
    default:
      return vehicle.draw_box_truck();
  }
}

void add_open_door(const Brush& paint, const VehicleShape& shape, double side, double angle,
                   const VehicleMaterials& materials) {
  // From the hinge backwards and outwards.
  const Brush door = paint.at({shape.length * (0.5 - kDoorHinge), side * shape.width / 2, 0}, EIGEN_PI - side * angle);
  const double belt = 0.62 * shape.height;
  add_box(door, {0, -0.03, 0.3}, {kDoorLength, 0.03, belt});
  add_quad(door.with(materials.glass), {0.3, 0, belt}, {kDoorLength, 0, belt}, {kDoorLength, 0, 0.93 * shape.height},
           {0.55, 0, 0.93 * shape.height});
  add_box(door.with(materials.trim), {kDoorLength - 0.04, -0.02, belt}, {kDoorLength, 0.02, 0.93 * shape.height});
}

}  // namespace vdbmap::simulator

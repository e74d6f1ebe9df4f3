// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/vehicle_model.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/simulator/things/large_vehicles.h"

namespace vdbmap::simulator {
namespace {

using Point = Eigen::Vector3d;

constexpr double kBeltWidth = 0.93;   // share of the half width where the cabin begins
constexpr double kRoofCrown = 0.05;   // [m] that the roof is higher in its middle
constexpr double kCabinFloor = 0.32;  // [m]

// A four-cornered surface: u from the first edge to the second, v from its beginning to its end.
struct Patch {
  Point first_begin, first_end, second_begin, second_end;

  Point at(double u, double v) const {
    return (1 - u) * ((1 - v) * first_begin + v * first_end) + u * ((1 - v) * second_begin + v * second_end);
  }
};

void add_patch(const Brush& brush, const Patch& patch, double u0, double u1, double v0, double v1) {
  if (u1 - u0 < 1e-6 || v1 - v0 < 1e-6) return;
  add_quad(brush, patch.at(u0, v0), patch.at(u1, v0), patch.at(u1, v1), patch.at(u0, v1));
}

// A sheet of paint with windows from v = low to v = high.
void add_glazed_patch(const Brush& paint, MaterialId glass, const Patch& patch,
                      const std::vector<std::pair<double, double>>& windows, double low, double high) {
  double end = 0;
  for (const auto& [begin, next_end] : windows) {
    add_patch(paint, patch, end, begin, 0, 1);
    add_patch(paint, patch, begin, next_end, 0, low);
    add_patch(paint, patch, begin, next_end, high, 1);
    add_patch(paint.with(glass), patch, begin, next_end, low, high);
    end = next_end;
  }
  add_patch(paint, patch, end, 1, 0, 1);
}

class Vehicle {
 public:
  Vehicle(const Brush& paint, const VehicleShape& shape, const StandardMaterials& materials)
      : paint_(paint), shape_(shape), style_(style_of(shape.body)), materials_(materials) {}

  void draw() const {
    draw_lower_body();
    draw_cabin();
    draw_roof();
    draw_interior();
    for (const double side : {-1.0, 1.0}) {
      draw_wheel(+shape_.wheelbase / 2, side);
      draw_wheel(-shape_.wheelbase / 2, side);
      draw_mirror(side);
      draw_lights(side);
    }
    draw_plates();
  }

 private:
  double x(double from_front) const { return shape_.length * (0.5 - from_front); }
  double half_width() const { return shape_.width / 2; }
  double roof_edge() const { return shape_.height - kRoofCrown; }
  double roof_half_width() const { return style_.roof_half_width * half_width(); }

  // Height of the lower body's upper edge.
  double belt(double from_front) const {
    const auto& stations = style_.stations;
    for (std::size_t i = 1; i < stations.size(); ++i) {
      if (from_front > stations[i].from_front) continue;
      const double share =
          (from_front - stations[i - 1].from_front) / (stations[i].from_front - stations[i - 1].from_front);
      return shape_.height * ((1 - share) * stations[i - 1].top + share * stations[i].top);
    }
    return shape_.height * stations.back().top;
  }

  // From the right upper edge round below to the left upper edge.
  std::vector<Point> section(const BodyStation& station) const {
    const double w = station.half_width * half_width();
    const double top = station.top * shape_.height;
    const double low = station.bottom;
    const double front = x(station.from_front);
    return {{front, -kBeltWidth * w, top}, {front, -w, top - 0.10},     {front, -w, low + 0.15},
            {front, -0.86 * w, low},       {front, 0.86 * w, low},      {front, w, low + 0.15},
            {front, w, top - 0.10},        {front, kBeltWidth * w, top}};
  }

  // The style's stations, with one more at each end of the opening.
  std::vector<BodyStation> stations_with_opening() const {
    std::vector<BodyStation> stations = style_.stations;
    for (const double cut : {style_.windscreen_foot, style_.open_end}) {
      for (std::size_t i = 1; i < stations.size(); ++i) {
        if (!(stations[i - 1].from_front < cut && cut < stations[i].from_front)) continue;
        const BodyStation& a = stations[i - 1];
        const BodyStation& b = stations[i];
        const double share = (cut - a.from_front) / (b.from_front - a.from_front);
        const BodyStation between = {cut, a.half_width + share * (b.half_width - a.half_width),
                                     a.top + share * (b.top - a.top), a.bottom + share * (b.bottom - a.bottom)};
        stations.insert(stations.begin() + static_cast<std::ptrdiff_t>(i), between);
        break;
      }
    }
    return stations;
  }

  void draw_lower_body() const {
    const std::vector<BodyStation> stations = stations_with_opening();
    for (std::size_t i = 1; i < stations.size(); ++i) {
      const double middle = (stations[i - 1].from_front + stations[i].from_front) / 2;
      const bool is_open = style_.windscreen_foot < middle && middle < style_.open_end;
      add_loft(paint_, section(stations[i - 1]), section(stations[i]), !is_open);
    }
    add_polygon(paint_, section(stations.front()));
    add_polygon(paint_, section(stations.back()));
  }

  Point foot(double from_front, double side) const {
    return {x(from_front), side * kBeltWidth * half_width(), belt(from_front)};
  }
  Point eave(double from_front, double side) const { return {x(from_front), side * roof_half_width(), roof_edge()}; }

  void draw_cabin() const {
    const MaterialId glass = materials_.car_glass;
    for (const double side : {-1.0, 1.0}) {
      const Patch patch = {foot(style_.windscreen_foot, side), eave(style_.roof_front, side),
                           foot(style_.rear_window_foot, side), eave(style_.roof_rear, side)};
      add_glazed_patch(paint_, glass, patch, style_.side_windows, 0.06, 0.90);
    }
    const Patch windscreen = {foot(style_.windscreen_foot, -1), eave(style_.roof_front, -1),
                              foot(style_.windscreen_foot, 1), eave(style_.roof_front, 1)};
    add_glazed_patch(paint_, glass, windscreen, {{0.05, 0.95}}, 0.04, 0.94);
    const Patch rear = {foot(style_.rear_window_foot, -1), eave(style_.roof_rear, -1), foot(style_.rear_window_foot, 1),
                        eave(style_.roof_rear, 1)};
    const std::vector<std::pair<double, double>> rear_window = {{0.10, 0.90}};
    const std::vector<std::pair<double, double>> none;
    add_glazed_patch(paint_, glass, rear, style_.has_rear_window ? rear_window : none, 0.18, 0.88);
  }

  std::vector<Point> roof_section(double from_front, double crown) const {
    std::vector<Point> points;
    for (const double share : {-1.0, -0.6, 0.0, 0.6, 1.0}) {
      points.emplace_back(x(from_front), share * roof_half_width(), roof_edge() + crown * (1 - share * share));
    }
    return points;
  }

  void draw_roof() const {
    const double length = style_.roof_rear - style_.roof_front;
    const std::vector<std::vector<Point>> sections = {
        roof_section(style_.roof_front, 0), roof_section(style_.roof_front + 0.2 * length, kRoofCrown),
        roof_section(style_.roof_front + 0.7 * length, kRoofCrown), roof_section(style_.roof_rear, 0)};
    for (std::size_t i = 1; i < sections.size(); ++i) add_loft(paint_, sections[i - 1], sections[i], false);
  }

  void draw_interior() const {
    const Brush inside = paint_.with(materials_.car_interior);
    const double w = 0.85 * half_width();
    const double front = x(style_.windscreen_foot) - 0.05;
    const double rear = x(style_.open_end) + 0.05;
    const double cargo = shape_.body == VehicleBody::kPickup ? 0.62 : kCabinFloor;  // a pickup's bed is higher
    const double back_of_cabin = x(style_.rear_window_foot) + 0.05;
    add_quad(inside, {front, -w, kCabinFloor}, {front, w, kCabinFloor}, {back_of_cabin, w, kCabinFloor},
             {back_of_cabin, -w, kCabinFloor});
    if (back_of_cabin - rear > 0.2) {
      add_quad(inside, {back_of_cabin, -w, cargo}, {back_of_cabin, w, cargo}, {rear, w, cargo}, {rear, -w, cargo});
    }
    add_box(inside, {front - 0.35, -w, 0.55}, {front, w, belt(style_.windscreen_foot) - 0.03});  // dashboard
    const double seat = front - 1.05;
    for (const double side : {-0.5, 0.5}) draw_seat(inside, seat, side * w * 1.05);
    if (shape_.body == VehicleBody::kVan) {
      add_box(inside, {seat - 0.35, -w, kCabinFloor}, {seat - 0.3, w, roof_edge() - 0.05});  // bulkhead
    } else if (seat - 0.95 > back_of_cabin + 0.1) {
      add_box(inside, {seat - 1.0, -w * 0.9, kCabinFloor}, {seat - 0.85, w * 0.9, belt(0.6) + 0.12});
    }
  }

  void draw_seat(const Brush& inside, double back, double y) const {
    const double top = belt(0.5) + 0.10;
    add_box(inside, {back, y - 0.24, kCabinFloor}, {back + 0.50, y + 0.24, 0.60});
    add_box(inside, {back - 0.14, y - 0.24, kCabinFloor}, {back, y + 0.24, top});
    add_box(inside, {back - 0.12, y - 0.12, top}, {back - 0.02, y + 0.12, top + 0.20});  // headrest
  }

  // Arch, tyre and rim, each a few millimetres before the other.
  void draw_wheel(double at, double side) const {
    const double r = shape_.wheel_radius;
    draw_arch({at, side * (half_width() + 0.001), r}, 1.13 * r);
    const auto draw_disc = [&](MaterialId material, double radius, double outside) {
      const double y = side * (half_width() + outside);
      add_tube(paint_.with(material), {{at, y - side * 0.22, r}, {at, y, r}, radius, radius, 20, true});
    };
    draw_disc(materials_.tyre, r, 0.004);
    draw_disc(materials_.rim, 0.66 * r, 0.007);
  }

  // The dark upper half of a disc.
  void draw_arch(const Point& hub, double radius) const {
    constexpr int kNumSides = 12;
    std::vector<Point> corners;
    for (int i = 0; i <= kNumSides; ++i) {
      const double angle = std::numbers::pi * i / kNumSides;
      corners.emplace_back(hub + radius * Point(std::cos(angle), 0, std::sin(angle)));
    }
    add_polygon(paint_.with(materials_.car_trim), corners);
  }

  void draw_mirror(double side) const {
    const double front = x(style_.windscreen_foot) - 0.25;
    const double z = belt(style_.windscreen_foot) + 0.02;
    const double inner = side * (kBeltWidth * half_width());
    const double outer = side * (half_width() + 0.14);
    add_box(paint_, {front - 0.10, std::min(inner, outer), z}, {front, std::max(inner, outer), z + 0.13});
  }

  void draw_lights(double side) const {
    const auto draw_light = [&](MaterialId material, double front, double back, double height) {
      const double a = side * 0.52 * half_width();
      const double b = side * 0.78 * half_width();
      add_box(paint_.with(material), {back, std::min(a, b), height - 0.12}, {front, std::max(a, b), height});
    };
    draw_light(materials_.headlight, x(0) + 0.004, x(0) - 0.1, 0.92 * belt(0));
    draw_light(materials_.tail_light, x(1) + 0.1, x(1) - 0.004, 0.95 * belt(1));
  }

  void draw_plates() const {
    const Brush plate = paint_.with(materials_.plate);
    add_box(plate, {x(0) - 0.05, -0.26, 0.34}, {x(0) + 0.006, 0.26, 0.45});
    add_box(plate, {x(1) - 0.006, -0.26, 0.48}, {x(1) + 0.05, 0.26, 0.59});
  }

  Brush paint_;
  const VehicleShape& shape_;
  const BodyStyle& style_;
  const StandardMaterials& materials_;
};

}  // namespace

void add_vehicle(const Brush& paint, const VehicleShape& shape, const StandardMaterials& materials) {
  Vehicle(paint, shape, materials).draw();
}

void add_any_vehicle(const Brush& paint, const VehicleShape& shape, const World& world) {
  if (shape.body < VehicleBody::kBoxVan) return add_vehicle(paint, shape, world.standard());
  add_large_vehicle(paint, shape, world.vehicle(class_of(shape.body)));
}

}  // namespace vdbmap::simulator

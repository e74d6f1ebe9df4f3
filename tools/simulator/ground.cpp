// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/ground.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vdbmap::simulator {
namespace {

constexpr double kStationStep = 0.5;      // [m]
constexpr double kKerbStoneWidth = 0.14;  // [m]
constexpr double kNearGround = 70;        // [m] on either side; coarser beyond
constexpr double kAtKerb = 1e-6;          // [m] beyond the kerb's offset the ground is that of the pavement

// A strip of ground along the street, between two distances from the axis.
struct Strip {
  double from;
  double to;
  bool is_kerb_face = false;
};

void append_strips(std::vector<Strip>& strips, double from, double to, double widest) {
  const int count = std::max(1, static_cast<int>(std::ceil((to - from) / widest)));
  for (int i = 0; i < count; ++i) {
    strips.push_back({from + (to - from) * i / count, from + (to - from) * (i + 1) / count});
  }
}

std::vector<Strip> make_strips(const SideLayout& side, double depth) {
  const double kerb = side.kerb_offset();
  const double stone = kerb + kKerbStoneWidth;
  std::vector<Strip> strips;
  append_strips(strips, 0, side.lane_width, 1);
  if (side.parking_width > 0) append_strips(strips, side.lane_width, kerb, 1.1);
  strips.push_back({kerb, kerb + kAtKerb, true});
  strips.push_back({kerb + kAtKerb, stone});
  append_strips(strips, stone, side.pavement_offset(), 0.6);
  if (side.garden_depth > 0) append_strips(strips, side.pavement_offset(), side.facade_offset(), 1.5);
  if (depth > side.facade_offset()) append_strips(strips, side.facade_offset(), std::min(depth, kNearGround), 6);
  if (depth > kNearGround) append_strips(strips, kNearGround, depth, 20);
  return strips;
}

MaterialId material_behind_pavement(const StandardMaterials& m, const LotKind& lot) {
  if (lot == LotKind::kSideStreet) return m.asphalt;
  if (lot == LotKind::kCarPark) return m.parking;
  return lot == LotKind::kDriveway || lot == LotKind::kHall ? m.setts : m.grass;
}

MaterialId material_at(const StandardMaterials& m, const SideLayout& side, const Strip& strip, LotKind lot) {
  const double middle = (strip.from + strip.to) / 2;
  if (middle < side.lane_width) return m.asphalt;
  if (lot == LotKind::kSideStreet) return m.asphalt;
  if (middle < side.kerb_offset()) return m.parking;
  if (middle < side.kerb_offset() + kKerbStoneWidth) return m.kerb;
  if (middle < side.pavement_offset()) return lot == LotKind::kDriveway ? m.setts : m.slabs;
  return material_behind_pavement(m, lot);
}

// Stations at which something begins: those of a fixed step, and the borders of lots.
std::vector<double> make_stations(const StreetLayout& layout, const SideLayout& side) {
  std::vector<double> stations;
  const int count = static_cast<int>((layout.end() - layout.begin()) / kStationStep);
  for (int i = 0; i <= count; ++i) stations.push_back(layout.begin() + i * kStationStep);
  for (const Lot& lot : side.lots) {
    if (lot.kind != LotKind::kHouse && lot.along.end < layout.end()) {
      stations.insert(stations.end(), {lot.along.begin, lot.along.end});
    }
  }
  std::ranges::sort(stations);
  return stations;
}

LotKind lot_at(const SideLayout& side, double station) {
  const auto found = std::ranges::find_if(
      side.lots, [&](const Lot& lot) { return lot.along.begin <= station && station < lot.along.end; });
  return found == side.lots.end() ? LotKind::kHouse : found->kind;
}

Eigen::Vector3d ground_point(const StreetLayout& layout, double station, double offset) {
  const Eigen::Vector2d point = layout.axis.point(station, offset);
  return {point.x(), point.y(), layout.ground_height(station, offset)};
}

void add_strip(const Brush& brush, const StreetLayout& layout, const SideLayout& side, const Strip& strip,
               const std::vector<double>& stations, const StandardMaterials& materials) {
  for (std::size_t i = 1; i < stations.size(); ++i) {
    const double a = stations[i - 1];
    const double b = stations[i];
    if (b - a < 1e-9) continue;
    const LotKind lot = lot_at(side, (a + b) / 2);
    if (strip.is_kerb_face && lot == LotKind::kSideStreet) continue;
    if (lot == LotKind::kCrossing) continue;  // drawn once for both streets
    add_quad(brush.with(material_at(materials, side, strip, lot)), ground_point(layout, a, side.sign * strip.from),
             ground_point(layout, b, side.sign * strip.from), ground_point(layout, b, side.sign * strip.to),
             ground_point(layout, a, side.sign * strip.to));
  }
}

}  // namespace

void add_ground(World& world, Mesh& mesh, const StreetLayout& layout) {
  const StandardMaterials& materials = world.standard();
  const Brush brush = world.add_object(mesh, {"ground", {}}, Eigen::Isometry3d::Identity(), materials.asphalt);
  for (const SideLayout& side : layout.sides) {
    const std::vector<double> stations = make_stations(layout, side);
    for (const Strip& strip : make_strips(side, layout.ground_depth))
      add_strip(brush, layout, side, strip, stations, materials);
  }
}

}  // namespace vdbmap::simulator

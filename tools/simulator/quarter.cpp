// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/quarter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/simulator/furniture.h"
#include "tools/simulator/lots.h"

namespace vdbmap::simulator {
namespace {

using std::numbers::pi;

constexpr double kMargin = 40;          // [m] that streets go on beyond the outer crossings
constexpr double kOutskirts = 70;       // [m] of ground around the quarter
constexpr double kSceneryDepth = 30;    // [m] behind the axis that gardens and parks reach
constexpr double kAroundCorner = 1.5;   // [m] of a crossing beyond the other street's pavement
constexpr double kHouseDepth = 13;      // [m] of the houses around whose corner a column's lots begin
constexpr double kBlockRise = 0.08;     // [m] of gardens over the hills, about as high as the pavements
constexpr double kSpecialShare = 0.35;  // of the rows that a park, car park, hall or open ground follows

// Stations of crossings along one direction.
std::vector<double> stations_of_blocks(int num_blocks, Random& random) {
  std::vector<double> stations = {0};
  for (int i = 0; i < num_blocks; ++i) stations.push_back(stations.back() + random.uniform(75, 100));
  return stations;
}

StreetLayout make_straight_street(const StreetAxis& axis, double length, Random& random) {
  StreetLayout street;
  street.axis = axis;
  street.length = length;
  street.margin = kMargin;
  street.is_ideal = false;
  street.sides = {make_rough_side(+1, true, random), make_rough_side(-1, true, random)};
  street.scenery_depth = kSceneryDepth;
  street.ground_depth = 0;
  return street;
}

double widest_pavement(const StreetLayout& street) {
  return std::max(street.sides[0].pavement_offset(), street.sides[1].pavement_offset()) + kAroundCorner;
}

// Lots that end with the stretch: what reaches beyond makes room for a gap.
void append_lots(SideLayout& side, Interval stretch, double corner, Random& random) {
  const auto append_gap = [&](double begin, double end) {
    if (end - begin > 0.01) side.lots.push_back({LotKind::kGap, {begin, end}, 0, random.seed()});
  };
  const double first = std::min(stretch.begin + corner, stretch.middle());
  const double last = std::max(stretch.end - corner, stretch.middle());
  append_gap(stretch.begin, first);
  std::vector<Lot> lots = make_rough_lots(side, {first, last}, {std::nullopt, kSpecialShare}, random);
  while (!lots.empty() && lots.back().along.end > last) lots.pop_back();
  side.lots.insert(side.lots.end(), lots.begin(), lots.end());
  append_gap(lots.empty() ? first : lots.back().along.end, stretch.end);
}

// Lots between crossings, which lie at the stations and reach `half` to both sides.
void plan_lots(StreetLayout& street, const std::vector<double>& stations, const std::vector<double>& halves,
               double corner, Random& random) {
  for (SideLayout& side : street.sides) {
    double begin = street.begin();
    for (std::size_t i = 0; i < stations.size(); ++i) {
      append_lots(side, {begin, stations[i] - halves[i]}, corner, random);
      side.lots.push_back({LotKind::kCrossing, {stations[i] - halves[i], stations[i] + halves[i]}, 0, 0});
      begin = stations[i] + halves[i];
    }
    append_lots(side, {begin, street.end()}, corner, random);
    add_islands(side, street.length, random);
  }
}

// Up and down the rows, then the columns: every street is driven whole, and most crossings several times.
std::vector<Leg> make_tour(std::size_t num_rows, std::size_t num_columns, const std::vector<double>& xs,
                           const std::vector<double>& ys) {
  std::vector<Leg> tour;
  bool is_east = false;
  for (std::size_t row = 0; row < num_rows; ++row) {
    tour.push_back(
        {row, is_east ? xs.back() : (row == 0 ? -0.5 * kMargin : xs.front()), is_east ? xs.front() : xs.back()});
    is_east = !is_east;
    if (row + 1 < num_rows) tour.push_back({num_rows + (is_east ? num_columns - 1 : 0), ys[row], ys[row + 1]});
  }
  bool is_north = true;
  for (std::size_t i = 0; i < num_columns; ++i) {
    const std::size_t column = is_east ? num_columns - 1 - i : i;
    tour.push_back({num_rows + column, is_north ? ys.back() : ys.front(), is_north ? ys.front() : ys.back()});
    is_north = !is_north;
    if (i + 1 == num_columns) break;
    const std::size_t next = is_east ? column - 1 : column + 1;
    tour.push_back({is_north ? num_rows - 1 : 0, xs[column], xs[next]});
  }
  return tour;
}

// From the facades of one street to those of the next; the outskirts beyond the outer ones.
std::vector<Block> make_blocks(const Quarter& quarter, std::size_t num_rows, const std::vector<double>& xs,
                               const std::vector<double>& ys) {
  const auto bounds = [&](const std::vector<double>& stations, std::size_t first, bool is_column) {
    std::vector<std::pair<double, double>> found;
    double from = stations.front() - kOutskirts;
    for (std::size_t i = 0; i < stations.size(); ++i) {
      // Rows have the north on their left, columns the west.
      const auto& sides = quarter.layouts[first + i].sides;
      found.emplace_back(from, stations[i] - sides[is_column ? 0 : 1].facade_offset());
      from = stations[i] + sides[is_column ? 1 : 0].facade_offset();
    }
    found.emplace_back(from, stations.back() + kOutskirts);
    return found;
  };
  std::vector<Block> blocks;
  for (const auto& [row_from, row_to] : bounds(xs, num_rows, true)) {
    for (const auto& [column_from, column_to] : bounds(ys, 0, false)) {
      blocks.push_back({row_from, row_to, column_from, column_to});
    }
  }
  return blocks;
}

// A grid of about `step` [m] over a rectangle of stations of the first row and column.
template <typename MaterialAt>
void add_grid(const Brush& brush, const StreetAxis& axis, const Block& area, double step, double rise,
              const MaterialAt& material_at) {
  const int nx = std::max(1, static_cast<int>(std::ceil((area.row_to - area.row_from) / step)));
  const int ny = std::max(1, static_cast<int>(std::ceil((area.column_to - area.column_from) / step)));
  const auto x = [&](int i) { return area.row_from + (area.row_to - area.row_from) * i / nx; };
  const auto y = [&](int k) { return area.column_from + (area.column_to - area.column_from) * k / ny; };
  const auto corner = [&](int i, int k) {
    const Eigen::Vector2d point = axis.point(x(i), y(k));
    return Eigen::Vector3d(point.x(), point.y(), axis.hills->height(point) + rise);
  };
  for (int i = 0; i < nx; ++i) {
    for (int k = 0; k < ny; ++k) {
      add_quad(brush.with(material_at((x(i) + x(i + 1)) / 2, (y(k) + y(k + 1)) / 2)), corner(i, k), corner(i + 1, k),
               corner(i + 1, k + 1), corner(i, k + 1));
    }
  }
}

void add_crossing(World& world, Mesh& mesh, const Quarter& quarter, const Crossing& crossing) {
  const StandardMaterials& materials = world.standard();
  const StreetLayout& row = quarter.layouts[crossing.row_street];
  const StreetLayout& column = quarter.layouts[crossing.column_street];
  const Brush brush = world.add_object(mesh, {"crossing", {}}, Eigen::Isometry3d::Identity(), materials.asphalt);
  const auto material_at = [&](double x, double y) {
    const double dx = x - crossing.row_station, dy = y - crossing.column_station;
    // Left of a column lies the west.
    const bool is_road =
        std::abs(dy) < row.side_of(dy).kerb_offset() || std::abs(dx) < column.side_of(-dx).kerb_offset();
    return is_road ? materials.asphalt : materials.slabs;
  };
  add_grid(brush, quarter.layouts.front().axis,
           {crossing.row_station - crossing.half_row, crossing.row_station + crossing.half_row,
            crossing.column_station - crossing.half_column, crossing.column_station + crossing.half_column},
           0.5, 0, material_at);
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      const double station = crossing.row_station + x * (crossing.half_row - 0.8);
      const Eigen::Isometry3d corner = row.place(station, y * (crossing.half_column - 0.8), x < 0 ? pi : 0);
      const SignKind kind = x * y > 0 ? SignKind::kGiveWay : SignKind::kStreetName;
      add_sign(world.add_object(mesh, {"sign", {}}, corner, materials.steel), kind, materials);
    }
  }
}

}  // namespace

Quarter make_quarter(const StreetOptions& options) {
  Random random(hash(options.seed, 1));
  const std::vector<double> xs = stations_of_blocks(options.quarter_columns, random);
  const std::vector<double> ys = stations_of_blocks(options.quarter_rows, random);
  StreetAxis axis = make_axis(random);
  axis.bend_amplitude = 0;
  axis.hills = make_hills(random);
  Quarter quarter;
  for (const double y : ys) {
    StreetAxis row = axis;
    row.start = axis.point(0, y);
    quarter.layouts.push_back(make_straight_street(row, xs.back(), random));
  }
  for (const double x : xs) {
    StreetAxis column = axis;
    column.start = axis.point(x, 0);
    column.heading = axis.heading + pi / 2;
    quarter.layouts.push_back(make_straight_street(column, ys.back(), random));
  }
  std::vector<double> row_halves, column_halves;  // along rows, along columns
  for (std::size_t i = 0; i < xs.size(); ++i) row_halves.push_back(widest_pavement(quarter.layouts[ys.size() + i]));
  for (std::size_t k = 0; k < ys.size(); ++k) column_halves.push_back(widest_pavement(quarter.layouts[k]));
  for (std::size_t k = 0; k < ys.size(); ++k) plan_lots(quarter.layouts[k], xs, row_halves, 0, random);
  for (std::size_t i = 0; i < xs.size(); ++i) {
    plan_lots(quarter.layouts[ys.size() + i], ys, column_halves, kHouseDepth, random);
  }
  for (StreetLayout& street : quarter.layouts) {
    street.ground_depth = std::max(street.sides[0].facade_offset(), street.sides[1].facade_offset());
  }
  for (std::size_t k = 0; k < ys.size(); ++k) {
    for (std::size_t i = 0; i < xs.size(); ++i) {
      quarter.crossings.push_back({k, ys.size() + i, xs[i], ys[k], row_halves[i], column_halves[k]});
    }
  }
  quarter.blocks = make_blocks(quarter, ys.size(), xs, ys);
  quarter.tour = make_tour(ys.size(), xs.size(), xs, ys);
  return quarter;
}

void add_crossings(World& world, Mesh& mesh, const Quarter& quarter) {
  const MaterialId grass = world.standard().grass;
  const Brush brush = world.add_object(mesh, {"ground", {}}, Eigen::Isometry3d::Identity(), grass);
  for (const Block& block : quarter.blocks) {
    add_grid(brush, quarter.layouts.front().axis, block, 3, kBlockRise, [&](double, double) { return grass; });
  }
  for (const Crossing& crossing : quarter.crossings) add_crossing(world, mesh, quarter, crossing);
}

}  // namespace vdbmap::simulator

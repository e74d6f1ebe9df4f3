// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/facade.h"

#include <algorithm>

namespace vdbmap::simulator {
namespace {

using Point = Eigen::Vector3d;

// Lengths [m].
constexpr double kFrameWidth = 0.07;
constexpr double kFrameDepth = 0.05;
constexpr double kCurtainGap = 0.14;
constexpr double kStepHeight = 0.17;
constexpr double kStepDepth = 0.29;
constexpr double kRailingHeight = 0.95;
constexpr double kBarDistance = 0.12;
constexpr double kBarWidth = 0.02;

std::vector<double> cuts(double first, double last, const std::vector<WallPatch>& holes, double WallPatch::*low,
                         double WallPatch::*high) {
  std::vector<double> values = {first, last};
  for (const WallPatch& hole : holes) values.insert(values.end(), {hole.*low, hole.*high});
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

bool is_in_hole(double x, double z, const std::vector<WallPatch>& holes) {
  return std::ranges::any_of(
      holes, [&](const WallPatch& h) { return h.left < x && x < h.right && h.bottom < z && z < h.top; });
}

// A rectangle square to y.
void add_pane(const Brush& brush, const WallPatch& p, double y) {
  add_quad(brush, {p.left, y, p.bottom}, {p.right, y, p.bottom}, {p.right, y, p.top}, {p.left, y, p.top});
}

void add_reveals(const Brush& wall, const WallPatch& hole, double recess) {
  const std::vector<Point> outside = {
      {hole.left, 0, hole.bottom}, {hole.right, 0, hole.bottom}, {hole.right, 0, hole.top}, {hole.left, 0, hole.top}};
  std::vector<Point> inside = outside;
  for (Point& corner : inside) corner.y() = recess;
  add_loft(wall, outside, inside, true);
}

void add_frame(const Brush& brush, const WallPatch& h, double recess) {
  const double back = recess + kFrameDepth;
  add_box(brush, {h.left, recess, h.bottom}, {h.left + kFrameWidth, back, h.top});
  add_box(brush, {h.right - kFrameWidth, recess, h.bottom}, {h.right, back, h.top});
  add_box(brush, {h.left, recess, h.bottom}, {h.right, back, h.bottom + kFrameWidth});
  add_box(brush, {h.left, recess, h.top - kFrameWidth}, {h.right, back, h.top});
  const double middle = (h.left + h.right) / 2;
  add_box(brush, {middle - kFrameWidth / 2, recess, h.bottom}, {middle + kFrameWidth / 2, back, h.top});
}

// A blind that is let down in part, a curtain, or the far wall of a room.
void add_view_inside(const Brush& wall, const WallPatch& hole, double recess, const StandardMaterials& materials,
                     Random& random) {
  WallPatch view = hole;
  const double choice = random.uniform(0, 1);
  if (choice < 0.25) {
    view.bottom = hole.top - random.uniform(0.2, 1) * (hole.top - hole.bottom);
    add_pane(wall.with(materials.window_frame), view, recess + 0.03);
  } else if (choice < 0.65) {
    add_pane(wall.with(materials.curtain), view, recess + kCurtainGap);
  }
  const double depth = random.uniform(2.5, 4.5);
  view = {hole.left - 1, hole.right + 1, hole.bottom - 0.9, hole.top + 0.5};
  add_pane(wall.with(materials.interior), view, depth);
}

void add_steps(const Brush& brush, const WallPatch& hole) {
  const int count = std::min(3, static_cast<int>(hole.bottom / kStepHeight));
  for (int i = 0; i < count; ++i) {
    add_box(brush, {hole.left - 0.2, -kStepDepth * (i + 1), -0.3},
            {hole.right + 0.2, -kStepDepth * i, hole.bottom - kStepHeight * i});
  }
}

}  // namespace

void add_wall(const Brush& brush, const WallPatch& wall, const std::vector<WallPatch>& holes) {
  const std::vector<double> xs = cuts(wall.left, wall.right, holes, &WallPatch::left, &WallPatch::right);
  const std::vector<double> zs = cuts(wall.bottom, wall.top, holes, &WallPatch::bottom, &WallPatch::top);
  for (std::size_t i = 1; i < xs.size(); ++i) {
    for (std::size_t k = 1; k < zs.size(); ++k) {
      if (is_in_hole((xs[i - 1] + xs[i]) / 2, (zs[k - 1] + zs[k]) / 2, holes)) continue;
      add_pane(brush, {xs[i - 1], xs[i], zs[k - 1], zs[k]}, 0);
    }
  }
}

void add_window(const Brush& wall, const WallPatch& hole, double recess, const StandardMaterials& materials,
                Random& random) {
  add_reveals(wall, hole, recess);
  add_frame(wall.with(materials.window_frame), hole, recess);
  add_pane(wall.with(materials.window_glass), hole, recess + kFrameDepth / 2);
  add_box(wall.with(materials.stone), {hole.left - 0.05, -0.06, hole.bottom - 0.05},
          {hole.right + 0.05, recess, hole.bottom});
  add_view_inside(wall, hole, recess + kFrameDepth, materials, random);
}

void add_door(const Brush& wall, const WallPatch& hole, double recess, const StandardMaterials& materials) {
  add_reveals(wall, hole, recess);
  const double light = hole.top - 0.4;  // the window above the door
  add_pane(wall.with(materials.door), {hole.left, hole.right, hole.bottom, light}, recess);
  add_pane(wall.with(materials.window_glass), {hole.left, hole.right, light, hole.top}, recess);
  add_pane(wall.with(materials.interior), {hole.left - 1, hole.right + 1, hole.bottom, hole.top + 0.3}, recess + 2.5);
  add_steps(wall.with(materials.stone), hole);
}

void add_balcony(const Brush& wall, const WallPatch& floor, double depth, const StandardMaterials& materials) {
  add_box(wall.with(materials.stone), {floor.left, -depth, floor.bottom - 0.16}, {floor.right, 0, floor.bottom});
  const Brush railing = wall.with(materials.railing);
  const double rail = floor.bottom + kRailingHeight;
  const auto add_bar = [&](double x, double y) {
    add_box(railing, {x, y, floor.bottom}, {x + kBarWidth, y + kBarWidth, rail});
  };
  for (double x = floor.left; x < floor.right - kBarWidth; x += kBarDistance) add_bar(x, -depth);
  for (double y = -depth; y < -kBarWidth; y += kBarDistance) {
    add_bar(floor.left, y);
    add_bar(floor.right - kBarWidth, y);
  }
  add_box(railing, {floor.left, -depth, rail}, {floor.right, -depth + 0.05, rail + 0.04});
  add_box(railing, {floor.left, -depth, rail}, {floor.left + 0.05, 0, rail + 0.04});
  add_box(railing, {floor.right - 0.05, -depth, rail}, {floor.right, 0, rail + 0.04});
}

}  // namespace vdbmap::simulator

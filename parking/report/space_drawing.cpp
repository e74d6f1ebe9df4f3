// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/report/space_drawing.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/Eigenvalues>

#include "parking/spaces/kerb_rows.h"
#include "vdbmap/render/draw.h"
#include "vdbmap/render/overlay.h"
#include "vdbmap/render/text.h"

namespace vdbmap::parking {
namespace {

using std::numbers::pi;

constexpr double kFill = 0.42, kCandidateFill = 0.12;  // opacity
constexpr double kBoxHeight = 1.5;                     // [m]
constexpr double kEyeBack = 14, kEyeHeight = 8.5;      // [m] from the first space
constexpr double kLabelReach = 75;                     // [m] from the eye
constexpr double kFieldOfViewDeg = 78, kElevationDeg = -11;
constexpr double kDash = 0.5;  // [m]

Rgb8 color_of(const ParkingSpace& space, const SpaceOccupancy& state) {
  return space.is_candidate ? kCandidateColor : color_of(state.state);
}

// Corners at a height above the ground, as they appear; nothing where one is behind the camera.
std::optional<std::vector<Eigen::Vector2d>> corners_in(const Camera& camera, const ParkingSpace& space, double height) {
  std::vector<Eigen::Vector2d> corners;
  for (const Eigen::Vector2d& corner : space.outline) {
    const auto place = camera.project({corner.x(), corner.y(), space.ground.value_or(0) + height});
    if (!place || !(place->pixel.cwiseAbs().maxCoeff() < 1e5)) return std::nullopt;
    corners.push_back(place->pixel);
  }
  return corners;
}

bool is_seen(const Image& image, const std::vector<Eigen::Vector2d>& corners) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : corners) box.extend(corner);
  return box.intersects(Eigen::AlignedBox2d(Eigen::Vector2d(0, 0), Eigen::Vector2d(image.width(), image.height())));
}

void draw_outline(Image& image, std::vector<Eigen::Vector2d> corners, double width, Rgb8 color, double dash) {
  corners.push_back(corners.front());
  if (dash <= 0) return draw_polyline(image, corners, width, {color});
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Eigen::Vector2d step = corners[i + 1] - corners[i];
    const int count = std::max(1, static_cast<int>(step.norm() / dash / 2));
    for (int k = 0; k < count; ++k) {
      draw_line(image, corners[i] + step * k / count, corners[i] + step * (k + 0.5) / count, width, {color});
    }
  }
}

void draw_on_ground(Image& image, const Camera& camera, const ParkingSpace& space, const SpaceOccupancy& state,
                    double width, double dash) {
  const auto corners = corners_in(camera, space, 0.05);
  if (!corners || !is_seen(image, *corners)) return;
  const Rgb8 color = color_of(space, state);
  const Rgb8 fill = state.state == SpaceState::kOccupied ? color_of(state.state) : color;
  fill_polygon(image, *corners, {fill, space.is_candidate && fill == color ? kCandidateFill : kFill});
  draw_outline(image, *corners, width, color, space.is_candidate ? dash : 0);
}

void draw_label(Image& image, const Eigen::Vector2d& place, const std::string& text, int size, Rgb8 color) {
  draw_text(image, place, text,
            {.size = size,
             .ink = {rgb8(0xffffff)},
             .align = TextAlign::kCenter,
             .is_bold = true,
             .halo = size / 6.0,
             .halo_color = color});
}

// Spaces, those far from the camera first.
std::vector<std::size_t> by_distance(const std::vector<ParkingSpace>& spaces, const Eigen::Vector3d& eye) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < spaces.size(); ++i) order.emplace_back(-(middle_of(spaces[i]) - eye.head<2>()).norm(), i);
  std::ranges::sort(order);
  std::vector<std::size_t> numbers;
  for (const auto& [distance, number] : order) numbers.push_back(number);
  return numbers;
}

double median_ground(const std::vector<ParkingSpace>& spaces) {
  std::vector<double> heights;
  for (const ParkingSpace& space : spaces) {
    if (space.ground) heights.push_back(*space.ground);
  }
  if (heights.empty()) return 0;
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  return *middle;
}

// Above the begin of the street, in the middle between the spaces along its kerbs.
Camera street_camera(const std::vector<ParkingSpace>& spaces, const StreetFrame& frame, const ImageSize& size) {
  constexpr double kFirst = 70;  // [m] of the street
  std::vector<const ParkingSpace*> kerb;
  for (const ParkingSpace& space : spaces) {
    if (space.angle == ParkingAngle::kParallel) kerb.push_back(&space);
  }
  if (kerb.empty()) {
    for (const ParkingSpace& space : spaces) kerb.push_back(&space);
  }
  const auto at = [&](const ParkingSpace* space) { return frame.coordinates_of(middle_of(*space)); };
  double first = frame.high.x();
  for (const ParkingSpace* space : kerb) first = std::min(first, at(space).x());
  std::vector<double> across;
  std::vector<ParkingSpace> near;
  for (const ParkingSpace* space : kerb) {
    if (at(space).x() > first + kFirst) continue;
    across.push_back(at(space).y());
    near.push_back(*space);
  }
  const auto [low, high] = std::ranges::minmax(across);
  const Eigen::Vector2d place = frame.place_at({first - kEyeBack, (low + high) / 2});
  const double heading_deg = std::atan2(frame.along.y(), frame.along.x()) * 180 / pi;
  return Camera::perspective(
      map_from_camera_at({place.x(), place.y(), median_ground(near) + kEyeHeight}, heading_deg, kElevationDeg),
      kFieldOfViewDeg, size);
}

PathOverlay edges_of(const ParkingSpace& space, Rgb8 color) {
  PathOverlay edges{"", {}, color};
  std::vector<Eigen::Vector3d> low, high;
  for (const Eigen::Vector2d& corner : space.outline) {
    low.emplace_back(corner.x(), corner.y(), space.ground.value_or(0) + 0.05);
    high.emplace_back(corner.x(), corner.y(), space.ground.value_or(0) + kBoxHeight);
    edges.pieces.push_back({low.back(), high.back()});
  }
  for (std::vector<Eigen::Vector3d>* ring : {&low, &high}) {
    ring->push_back(ring->front());
    edges.pieces.push_back(*ring);
  }
  return edges;
}

}  // namespace

Rgb8 color_of(SpaceState state) {
  switch (state) {
    case SpaceState::kOccupied:
      return rgb8(0xd32f23);
    case SpaceState::kVacant:
      return rgb8(0x1f9d48);
    case SpaceState::kUnknown:
      break;
  }
  return rgb8(0x7d7d7d);
}

double StreetFrame::heading_deg() const { return std::atan2(up().y(), up().x()) * 180 / pi; }

StreetFrame street_frame(const std::vector<ParkingSpace>& spaces) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const ParkingSpace& space : spaces) mean += middle_of(space) / static_cast<double>(spaces.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const ParkingSpace& space : spaces) {
    scatter += (middle_of(space) - mean) * (middle_of(space) - mean).transpose();
  }
  StreetFrame frame;
  const Eigen::Vector2d along = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(scatter).eigenvectors().col(1);
  const bool is_upside_down = along.x() < -1e-9 || (std::abs(along.x()) <= 1e-9 && along.y() < 0);
  frame.along = is_upside_down ? Eigen::Vector2d(-along) : along;
  Eigen::AlignedBox2d box;
  for (const ParkingSpace& space : spaces) {
    for (const Eigen::Vector2d& corner : space.outline) box.extend(frame.coordinates_of(corner));
  }
  frame.low = box.min();
  frame.high = box.max();
  return frame;
}

bool has_changed(const SpaceOccupancy& state) {
  return state.previous && *state.previous != SpaceState::kUnknown && state.state != SpaceState::kUnknown &&
         *state.previous != state.state;
}

Image draw_plan(const OccupancyRecord& record, const VoxelLevel& scene, const VoxelColors& colors,
                const StreetFrame& frame, const Eigen::Vector2d& middle, double width, const ImageSize& size) {
  constexpr double kAbove = 200;        // [m]
  constexpr int kSmallestLetters = 18;  // [pixels]
  const Eigen::Vector2d place = frame.place_at(middle);
  const Camera camera = Camera::orthographic(
      map_from_camera_at({place.x(), place.y(), median_ground(record.spaces) + kAbove}, frame.heading_deg(), -90),
      width, size);
  VoxelView view = view_voxels(scene, colors, camera);
  const double pixels_per_metre = size.width / width;
  const double line = std::clamp(0.14 * pixels_per_metre, 2.0, 5.0);
  const int letters = static_cast<int>(std::clamp(1.35 * pixels_per_metre, 9.0, 40.0));
  for (std::size_t i = 0; i < record.spaces.size(); ++i) {
    draw_on_ground(view.image, camera, record.spaces[i], record.states[i], line, kDash * pixels_per_metre);
  }
  for (std::size_t i = 0; i < record.spaces.size(); ++i) {
    const ParkingSpace& space = record.spaces[i];
    const Eigen::Vector2d center = middle_of(space);
    const auto appears = camera.project({center.x(), center.y(), space.ground.value_or(0)});
    const auto corners = corners_in(camera, space, 0);
    if (!appears || !corners || !is_seen(view.image, *corners)) continue;
    if (has_changed(record.states[i]) && !space.is_candidate) {
      const double radius = 0.31 * letters;
      const Eigen::Vector2d at = corners->front() + 0.28 * (appears->pixel - corners->front());
      draw_disc(view.image, at, radius + 1.5, {rgb8(0x1c1c1c)});
      draw_disc(view.image, at, radius, {kChangeColor});
    }
    if (letters < kSmallestLetters) continue;
    draw_label(view.image, appears->pixel, space.id, letters, color_of(space, record.states[i]));
  }
  return std::move(view.image);
}

Image draw_perspective(const OccupancyRecord& record, const VoxelLevel& scene, const VoxelColors& colors,
                       const StreetFrame& frame, const ImageSize& size) {
  const Camera camera = street_camera(record.spaces, frame, size);
  const Eigen::Vector3d eye = camera.map_from_camera().translation();
  VoxelView view = view_voxels(scene, colors, camera);
  const std::vector<std::size_t> order = by_distance(record.spaces, eye);
  for (const std::size_t i : order) {
    const ParkingSpace& space = record.spaces[i];
    const double distance = (middle_of(space) - eye.head<2>()).norm();
    const double width = std::clamp(90 / distance, 1.2, 4.5);
    draw_on_ground(view.image, camera, space, record.states[i], width, 8);
    if (!space.is_candidate && corners_in(camera, space, 0) && corners_in(camera, space, kBoxHeight)) {
      draw_path(view, camera, edges_of(space, color_of(space, record.states[i])), width);
    }
  }
  for (const std::size_t i : order) {
    const ParkingSpace& space = record.spaces[i];
    const Eigen::Vector2d center = middle_of(space);
    const double distance = (center - eye.head<2>()).norm();
    const auto appears = camera.project({center.x(), center.y(), space.ground.value_or(0) + kBoxHeight + 0.4});
    if (!appears || distance > kLabelReach) continue;
    draw_label(view.image, appears->pixel, space.id, static_cast<int>(std::clamp(1000 / distance, 15.0, 34.0)),
               color_of(space, record.states[i]));
  }
  return std::move(view.image);
}

}  // namespace vdbmap::parking

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/overlay.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "vdbmap/render/draw.h"

namespace vdbmap {
namespace {

constexpr double kHiddenBy = 0.5;      // [m] a path that far behind a voxel is hidden
constexpr double kLongestStep = 0.25;  // [m] between places at which a path is looked for behind voxels
constexpr double kHiddenOpacity = 0.3;
constexpr double kPointSize = 0.06;  // [m]

/// Where something appears, and whether voxels are at least `tolerance` before it.
struct Sighting {
  Eigen::Vector2d pixel;
  bool is_hidden;
};

double distance_from(const Camera& camera, const Eigen::Vector3d& point, double depth) {
  return camera.is_perspective() ? (point - camera.map_from_camera().translation()).norm() : depth;
}

std::optional<Sighting> look_at(const VoxelView& view, const Camera& camera, const Eigen::Vector3d& point,
                                double tolerance) {
  const std::optional<ImagePoint> place = camera.project(point);
  if (!place || !(place->pixel.cwiseAbs().maxCoeff() < 1e6)) return std::nullopt;
  const int x = static_cast<int>(std::floor(place->pixel.x()));
  const int y = static_cast<int>(std::floor(place->pixel.y()));
  const bool is_inside = x >= 0 && y >= 0 && x < view.image.width() && y < view.image.height();
  const bool is_hidden = is_inside && view.distance_at(x, y) < distance_from(camera, point, place->depth) - tolerance;
  return Sighting{place->pixel, is_hidden};
}

/// Cuts a path where it goes behind voxels or leaves the view, and draws the parts.
class PathPen {
 public:
  PathPen(VoxelView& view, double width, Rgb8 color) : view_(view), width_(width), color_(color) {}

  void go_to(const std::optional<Sighting>& sighting) {
    if (!sighting) return lift();
    const bool changes = !line_.empty() && sighting->is_hidden != is_hidden_;
    line_.push_back(sighting->pixel);
    if (changes) lift();
    if (line_.empty()) line_.push_back(sighting->pixel);
    is_hidden_ = sighting->is_hidden;
  }

  void lift() {
    if (line_.size() > 1) draw_polyline(view_.image, line_, width_, {color_, is_hidden_ ? kHiddenOpacity : 1});
    line_.clear();
  }

 private:
  VoxelView& view_;
  double width_;
  Rgb8 color_;
  std::vector<Eigen::Vector2d> line_;
  bool is_hidden_ = false;
};

// A camera that looks straight down sees paths through trees and roofs.
double tolerance_for(const Camera& camera) {
  const bool is_plan = !camera.is_perspective() && std::abs(camera.map_from_camera().linear()(2, 2)) > 0.99;
  return is_plan ? std::numeric_limits<double>::infinity() : kHiddenBy;
}

void draw_piece(VoxelView& view, const Camera& camera, const std::vector<Eigen::Vector3d>& piece, double width,
                Rgb8 color) {
  const double tolerance = tolerance_for(camera);
  PathPen pen(view, width, color);
  if (!piece.empty()) pen.go_to(look_at(view, camera, piece.front(), tolerance));
  for (std::size_t i = 0; i + 1 < piece.size(); ++i) {
    const Eigen::Vector3d step = piece[i + 1] - piece[i];
    const int count = static_cast<int>(std::clamp(std::ceil(step.norm() / kLongestStep), 1.0, 1000.0));
    for (int k = 1; k <= count; ++k) pen.go_to(look_at(view, camera, piece[i] + step * k / count, tolerance));
  }
  pen.lift();
}

}  // namespace

void draw_path(VoxelView& view, const Camera& camera, const PathOverlay& path, double width) {
  for (const std::vector<Eigen::Vector3d>& piece : path.pieces) {
    draw_piece(view, camera, piece, width, path.color);
    for (const Eigen::Vector3d& place : piece) {
      const auto sighting = look_at(view, camera, place, tolerance_for(camera));
      if (sighting && !sighting->is_hidden) draw_disc(view.image, sighting->pixel, 0.9 * width, {path.color});
    }
  }
}

void draw_points(VoxelView& view, const Camera& camera, const PointsOverlay& points, double voxel_size) {
  for (const Eigen::Vector3d& point : points.points) {
    const auto sighting = look_at(view, camera, point, 2 * voxel_size);
    if (!sighting || sighting->is_hidden) continue;
    const double distance = (point - camera.map_from_camera().translation()).norm();
    const double pixel = camera.is_perspective() ? distance * camera.pixel_width() : camera.pixel_width();
    draw_disc(view.image, sighting->pixel, std::clamp(kPointSize / 2 / pixel, 0.8, 3.0), {points.color, 0.85});
  }
}

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/camera.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

namespace vdbmap {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;
constexpr double kMaxFieldOfViewDeg = 170;
constexpr double kNearest = 1e-6;  // [m] in front of a pinhole camera

}  // namespace

Camera::Camera(const Eigen::Isometry3d& map_from_camera, bool is_perspective, double pixel_width, const ImageSize& size)
    : map_from_camera_(map_from_camera), is_perspective_(is_perspective), pixel_width_(pixel_width), size_(size) {
  if (size.width < 1 || size.height < 1) throw std::invalid_argument("a camera needs a picture of at least one pixel");
  if (!map_from_camera.matrix().allFinite()) throw std::invalid_argument("pose of the camera is not finite");
}

Camera Camera::perspective(const Eigen::Isometry3d& map_from_camera, double field_of_view_deg, const ImageSize& size) {
  if (!(field_of_view_deg > 0 && field_of_view_deg <= kMaxFieldOfViewDeg)) {
    throw std::invalid_argument("field of view is " + std::to_string(field_of_view_deg) +
                                " degrees, expected above 0, at most 170");
  }
  const double half_width = std::tan(field_of_view_deg * kRadPerDeg / 2);
  return {map_from_camera, true, 2 * half_width / size.width, size};
}

Camera Camera::orthographic(const Eigen::Isometry3d& map_from_camera, double width, const ImageSize& size) {
  if (!(width > 0) || std::isinf(width)) {
    throw std::invalid_argument("width of the view is " + std::to_string(width) + " m, expected above 0");
  }
  return {map_from_camera, false, width / size.width, size};
}

Ray Camera::ray_through(const Eigen::Vector2d& pixel) const {
  const double x = (pixel.x() - size_.width / 2.0) * pixel_width_;
  const double y = (pixel.y() - size_.height / 2.0) * pixel_width_;
  if (is_perspective_) {
    return {map_from_camera_.translation(), map_from_camera_.linear() * Eigen::Vector3d(x, y, 1).normalized()};
  }
  return {map_from_camera_ * Eigen::Vector3d(x, y, 0), map_from_camera_.linear().col(2)};
}

// All corners of a box that is not seen lie beyond one of the planes around the picture, or behind the camera.
bool Camera::may_see(const Eigen::AlignedBox3d& box) const {
  const Eigen::Array2d half = Eigen::Array2d(size_.width, size_.height) * pixel_width_ / 2;
  Eigen::Array<double, 5, 1> nearest = Eigen::Array<double, 5, 1>::Constant(std::numeric_limits<double>::infinity());
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
    const Eigen::Vector3d in_camera = map_from_camera_.linear().transpose() * (corner - map_from_camera_.translation());
    const double scale = is_perspective_ ? in_camera.z() : 1;
    const double width = half.x() * scale;
    const double height = half.y() * scale;
    Eigen::Array<double, 5, 1> beyond;
    beyond << in_camera.x() - width, -in_camera.x() - width, in_camera.y() - height, -in_camera.y() - height,
        is_perspective_ ? -in_camera.z() : -1;
    nearest = nearest.min(beyond);
  }
  return (nearest <= 0).all();
}

std::optional<ImagePoint> Camera::project(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d in_camera = map_from_camera_.linear().transpose() * (point - map_from_camera_.translation());
  const double scale = is_perspective_ ? in_camera.z() * pixel_width_ : pixel_width_;
  if (is_perspective_ && !(in_camera.z() > kNearest)) return std::nullopt;
  const Eigen::Vector2d middle(size_.width / 2.0, size_.height / 2.0);
  return ImagePoint{middle + in_camera.head<2>() / scale, in_camera.z()};
}

Eigen::Isometry3d map_from_camera_at(const Eigen::Vector3d& eye, double heading_deg, double elevation_deg) {
  const double heading = heading_deg * kRadPerDeg;
  const double elevation = elevation_deg * kRadPerDeg;
  const Eigen::Vector3d forward(std::cos(heading) * std::cos(elevation), std::sin(heading) * std::cos(elevation),
                                std::sin(elevation));
  const Eigen::Vector3d right(std::sin(heading), -std::cos(heading), 0);
  Eigen::Isometry3d map_from_camera = Eigen::Isometry3d::Identity();
  map_from_camera.linear() << right, forward.cross(right), forward;
  map_from_camera.translation() = eye;
  return map_from_camera;
}

}  // namespace vdbmap

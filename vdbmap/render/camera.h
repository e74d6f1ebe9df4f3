// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "vdbmap/core/ray_caster.h"

namespace vdbmap {

/// Width and height of a picture [pixels].
struct ImageSize {
  int width = 1920;
  int height = 1080;
};

/// A place in a picture [pixels from the upper left corner] and how far it is from the camera along its view [m].
struct ImagePoint {
  Eigen::Vector2d pixel;
  double depth;
};

/// Turns pixels into rays and points into pixels. Camera frame: x to the right, y down, z forward.
class Camera {
 public:
  /// A pinhole camera. Throws std::invalid_argument unless the horizontal field of view lies in (0, 170] degrees.
  static Camera perspective(const Eigen::Isometry3d& map_from_camera, double field_of_view_deg, const ImageSize& size);

  /// Parallel rays; `width` [m] of the scene fills the picture. Throws std::invalid_argument unless it is above 0.
  static Camera orthographic(const Eigen::Isometry3d& map_from_camera, double width, const ImageSize& size);

  const ImageSize& size() const { return size_; }
  const Eigen::Isometry3d& map_from_camera() const { return map_from_camera_; }
  bool is_perspective() const { return is_perspective_; }

  /// Width of a pixel: in radians at the middle of the picture with perspective, else in metres.
  double pixel_width() const { return pixel_width_; }

  /// The ray through a place in the picture; its direction is a unit vector.
  Ray ray_through(const Eigen::Vector2d& pixel) const;

  /// Whether something in the box [m, local frame] may appear in the picture; never false where it does.
  bool may_see(const Eigen::AlignedBox3d& box) const;

  /// Where a point [m, local frame] appears; nothing behind a pinhole camera.
  std::optional<ImagePoint> project(const Eigen::Vector3d& point) const;

 private:
  Camera(const Eigen::Isometry3d& map_from_camera, bool is_perspective, double pixel_width, const ImageSize& size);

  Eigen::Isometry3d map_from_camera_;
  bool is_perspective_;
  double pixel_width_;
  ImageSize size_;
};

/// A camera at `eye` whose view has this heading (degrees to the left of the x axis) and elevation (degrees above the
/// horizon, -90 to 90); the horizon lies level.
Eigen::Isometry3d map_from_camera_at(const Eigen::Vector3d& eye, double heading_deg, double elevation_deg);

}  // namespace vdbmap

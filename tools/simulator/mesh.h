// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "tools/simulator/material.h"

namespace vdbmap::simulator {

/// Three corners and what they belong to. Both sides are seen.
struct Triangle {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint32_t c = 0;
  MaterialId material = 0;
  ObjectId object = 0;
};

/// The surfaces of a scene [m, scene frame].
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Triangle> triangles;

  /// Appends another mesh's surfaces.
  void append(const Mesh& other);
};

/// Where and as what the next parts are added to a mesh.
struct Brush {
  Mesh* mesh;
  Eigen::Isometry3d scene_from_part = Eigen::Isometry3d::Identity();
  MaterialId material = 0;
  ObjectId object = 0;

  /// The same brush with another material.
  Brush with(MaterialId other) const { return {mesh, scene_from_part, other, object}; }
  /// The same brush in a frame of its own.
  Brush at(const Eigen::Isometry3d& part_from_detail) const {
    return {mesh, scene_from_part * part_from_detail, material, object};
  }
  /// The same brush moved within its frame, then turned about its vertical [rad].
  Brush at(const Eigen::Vector3d& position, double yaw = 0) const;
};

using Corners = std::span<const Eigen::Vector3d>;

void add_triangle(const Brush& brush, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// Corners in order round the quadrilateral.
void add_quad(const Brush& brush, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
              const Eigen::Vector3d& d);

/// A fan from the first corner: for convex outlines.
void add_polygon(const Brush& brush, Corners corners);

/// An axis-parallel box of the brush's frame.
void add_box(const Brush& brush, const Eigen::Vector3d& min, const Eigen::Vector3d& max);

/// The walls of a tapered tube, and its ends where they are wanted.
struct Tube {
  Eigen::Vector3d from;
  Eigen::Vector3d to;
  double radius_from;
  double radius_to;
  int num_sides = 10;
  bool is_capped = false;
};
void add_tube(const Brush& brush, const Tube& tube);

/// An ellipsoid of flat faces.
void add_ellipsoid(const Brush& brush, const Eigen::Vector3d& center, const Eigen::Vector3d& radii, int num_sides = 10);

/// The skin between two outlines of equally many corners; a closed outline joins its last corner with its first.
void add_loft(const Brush& brush, Corners outline_a, Corners outline_b, bool is_closed);

}  // namespace vdbmap::simulator

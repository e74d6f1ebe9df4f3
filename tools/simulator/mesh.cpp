// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/mesh.h"

#include <array>
#include <cmath>
#include <numbers>

namespace vdbmap::simulator {
namespace {

std::uint32_t add_vertex(const Brush& brush, const Eigen::Vector3d& point) {
  brush.mesh->vertices.push_back((brush.scene_from_part * point).cast<float>());
  return static_cast<std::uint32_t>(brush.mesh->vertices.size() - 1);
}

void add_face(const Brush& brush, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  brush.mesh->triangles.push_back({a, b, c, brush.material, brush.object});
}

// Corners of a circle about `center`, square to `axis`.
std::vector<Eigen::Vector3d> circle(const Eigen::Vector3d& center, const Eigen::Vector3d& axis, double radius,
                                    int num_sides) {
  const Eigen::Vector3d across = axis.unitOrthogonal();
  const Eigen::Vector3d along = axis.normalized().cross(across);
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < num_sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / num_sides;
    corners.emplace_back(center + radius * (std::cos(angle) * across + std::sin(angle) * along));
  }
  return corners;
}

std::vector<Eigen::Vector3d> ellipse(const Eigen::Vector3d& center, const Eigen::Vector3d& radii, double latitude,
                                     int num_sides) {
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < num_sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / num_sides;
    const Eigen::Vector3d direction(std::cos(latitude) * std::cos(angle), std::cos(latitude) * std::sin(angle),
                                    std::sin(latitude));
    corners.emplace_back(center + radii.cwiseProduct(direction));
  }
  return corners;
}

}  // namespace

void Mesh::append(const Mesh& other) {
  const auto shift = static_cast<std::uint32_t>(vertices.size());
  vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
  for (Triangle triangle : other.triangles) {
    triangle.a += shift;
    triangle.b += shift;
    triangle.c += shift;
    triangles.push_back(triangle);
  }
}

Brush Brush::at(const Eigen::Vector3d& position, double yaw) const {
  return at(Eigen::Isometry3d(Eigen::Translation3d(position) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ())));
}

void add_triangle(const Brush& brush, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const std::uint32_t first = add_vertex(brush, a);
  add_vertex(brush, b);
  add_vertex(brush, c);
  add_face(brush, first, first + 1, first + 2);
}

void add_quad(const Brush& brush, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
              const Eigen::Vector3d& d) {
  const std::array<Eigen::Vector3d, 4> corners = {a, b, c, d};
  add_polygon(brush, corners);
}

void add_polygon(const Brush& brush, Corners corners) {
  const auto first = static_cast<std::uint32_t>(brush.mesh->vertices.size());
  for (const Eigen::Vector3d& corner : corners) add_vertex(brush, corner);
  for (std::uint32_t i = 2; i < corners.size(); ++i) add_face(brush, first, first + i - 1, first + i);
}

void add_box(const Brush& brush, const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
  const auto first = static_cast<std::uint32_t>(brush.mesh->vertices.size());
  for (int i = 0; i < 8; ++i) {
    add_vertex(brush, {i & 1 ? max.x() : min.x(), i & 2 ? max.y() : min.y(), i & 4 ? max.z() : min.z()});
  }
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kFaces = {
      {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};
  for (const auto& face : kFaces) {
    add_face(brush, first + face[0], first + face[1], first + face[2]);
    add_face(brush, first + face[0], first + face[2], first + face[3]);
  }
}

void add_tube(const Brush& brush, const Tube& tube) {
  const Eigen::Vector3d axis = tube.to - tube.from;
  const std::vector<Eigen::Vector3d> begin = circle(tube.from, axis, tube.radius_from, tube.num_sides);
  const std::vector<Eigen::Vector3d> end = circle(tube.to, axis, tube.radius_to, tube.num_sides);
  add_loft(brush, begin, end, true);
  if (!tube.is_capped) return;
  add_polygon(brush, begin);
  add_polygon(brush, end);
}

void add_ellipsoid(const Brush& brush, const Eigen::Vector3d& center, const Eigen::Vector3d& radii, int num_sides) {
  const int num_rings = num_sides / 2;
  const auto latitude = [&](int ring) { return std::numbers::pi * (static_cast<double>(ring) / num_rings - 0.5); };
  for (int ring = 0; ring < num_rings; ++ring) {
    add_loft(brush, ellipse(center, radii, latitude(ring), num_sides),
             ellipse(center, radii, latitude(ring + 1), num_sides), true);
  }
}

void add_loft(const Brush& brush, Corners outline_a, Corners outline_b, bool is_closed) {
  const auto count = static_cast<std::uint32_t>(outline_a.size());
  const auto first = static_cast<std::uint32_t>(brush.mesh->vertices.size());
  for (const Eigen::Vector3d& corner : outline_a) add_vertex(brush, corner);
  for (const Eigen::Vector3d& corner : outline_b) add_vertex(brush, corner);
  for (std::uint32_t i = 0; i < count - (is_closed ? 0 : 1); ++i) {
    const std::uint32_t next = (i + 1) % count;
    add_face(brush, first + i, first + next, first + count + next);
    add_face(brush, first + i, first + count + next, first + count + i);
  }
}

}  // namespace vdbmap::simulator

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "tools/simulator/ray_caster.h"
#include "vdbmap/io/kitti/label_file.h"

namespace vdbmap::simulator {

class Traffic;

/// What a point was measured on: the numbers of SurfaceClass and of the world's object.
using PointTruth = PointLabel;

/// The triangle of what was measured on no surface: rain.
inline constexpr std::uint32_t kNoTriangle = std::numeric_limits<std::uint32_t>::max();

/// What laser pulses and cameras meet at a time. Refers to parts that must outlive it. Triangles are numbered through:
/// those of the mesh, then those of the traffic's.
struct SceneView {
  const Mesh& mesh;
  const std::vector<Material>& materials;
  const RayCaster& caster;
  const Traffic* traffic = nullptr;  ///< what moves, where anything does
  double time = 0;                   ///< [s]

  SceneView at(double other_time) const { return {mesh, materials, caster, traffic, other_time}; }

  const Triangle& triangle(std::uint32_t index) const;
  const Material& material(std::uint32_t index) const { return materials[triangle(index).material]; }

  /// The class of a triangle, that of moving things where it moves, and its object.
  PointTruth truth(std::uint32_t index) const;

  std::optional<Hit> first_hit(const Ray& ray) const;
  bool is_blocked(const Ray& ray) const;
};

}  // namespace vdbmap::simulator

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include <Eigen/Core>

#include "tools/simulator/mesh.h"

namespace vdbmap::simulator {

/// A ray's part between two distances [m]; `direction` has length 1.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
  double nearest = 0;
  double farthest = 1000;
};

/// Where a ray meets a surface first.
struct Hit {
  double distance;         ///< [m] along the ray
  std::uint32_t triangle;  ///< of the mesh
  Eigen::Vector3d normal;  ///< of the surface, on the side of the ray's origin
};

/// Finds what rays hit. Any number of threads may ask at once.
class RayCaster {
 public:
  explicit RayCaster(const Mesh& mesh);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;

  std::optional<Hit> first_hit(const Ray& ray) const;

  /// Whether the ray hits anything.
  bool is_blocked(const Ray& ray) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace vdbmap::simulator

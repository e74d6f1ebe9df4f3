// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tools/simulator/ray_caster.h"
#include "tools/simulator/world.h"

namespace vdbmap::simulator {

/// What moves while it is scanned: rigid bodies, each with its poses over time. Any number of threads may ask at once.
class Traffic {
 public:
  static constexpr double kPeriod = 0.05;  ///< [s] between the poses of a mover

  /// A body and its way. Before its first pose and after its last it is not there.
  struct Mover {
    ObjectId object;
    Mesh model;                                      ///< in the body's frame: x forward, z up
    double begin_time;                               ///< [s] of the first pose
    std::vector<Eigen::Isometry3d> scene_from_body;  ///< kPeriod apart
  };

  explicit Traffic(std::vector<Mover> movers);

  /// The models of all movers, one behind the other, in their own frames.
  const Mesh& mesh() const { return mesh_; }
  const std::vector<Mover>& movers() const { return movers_; }

  /// The nearest hit at the time; its triangle counts in mesh().
  std::optional<Hit> first_hit(const Ray& ray, double time) const;

 private:
  // A ball around the model and where its triangles begin in mesh().
  struct Body {
    RayCaster caster;
    Eigen::Vector3d center;
    double radius;
    std::uint32_t first_triangle;
  };

  std::vector<Mover> movers_;
  std::vector<Body> bodies_;
  Mesh mesh_;
};

/// The pose of a mover, or nothing where it is not there.
std::optional<Eigen::Isometry3d> pose_at(const Traffic::Mover& mover, double time);

}  // namespace vdbmap::simulator

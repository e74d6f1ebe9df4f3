// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "tools/simulator/lidar.h"
#include "tools/simulator/pulse.h"

namespace vdbmap::simulator {

/// A few surfaces whose equations a test knows.
struct SimpleScene {
  Mesh mesh;
  std::vector<Material> materials;

  /// Adds a material of that reflectance; returns the brush for it.
  Brush brush(float reflectance, float transmission = 0) {
    Material material{SurfaceClass::kBuilding, Eigen::Vector3f(0.5F, 0.5F, 0.5F)};
    material.reflectance = reflectance;
    material.transmission = transmission;
    materials.push_back(material);
    return {&mesh, Eigen::Isometry3d::Identity(), static_cast<MaterialId>(materials.size() - 1), 0};
  }
};

/// A wall in the plane x = `distance`, `size` [m] wide and high, about the x axis.
inline void add_wall_across(const Brush& brush, double distance, double size) {
  const double h = size / 2;
  add_quad(brush, {distance, -h, -h}, {distance, h, -h}, {distance, h, h}, {distance, -h, h});
}

/// How many of `count` pulses along x come back, and their ranges.
inline std::vector<double> ranges_along_x(const SimpleScene& scene, const PulseModel& model, int count) {
  const RayCaster caster(scene.mesh);
  std::vector<double> ranges;
  for (int i = 0; i < count; ++i) {
    RayRandom random(hash(7, static_cast<std::uint64_t>(i)));
    const auto echo = measure({scene.mesh, scene.materials, caster}, model, Eigen::Vector3d::Zero(),
                              Eigen::Vector3d::UnitX(), random);
    if (echo) ranges.push_back(echo->range);
  }
  return ranges;
}

}  // namespace vdbmap::simulator

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/shading.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbmap {
namespace {

const LinearColor kSunColor(1.02F, 0.96F, 0.86F);
const LinearColor kSkyColor(0.50F, 0.55F, 0.62F);
const LinearColor kGroundColor(0.24F, 0.22F, 0.20F);  // light that the ground throws back upwards

/// A direction about a normal, and its share of the sky's light.
struct SkyRay {
  double along_a;
  double along_b;
  double along_normal;
};

// Two rings of four about the normal, 25 and 58 degrees off it: the middles of equal shares of cosine-weighted light.
// Even and odd ones are two to a ring each.
constexpr std::array<SkyRay, 8> kSkyRays = {{{0.42, 0.0, 0.91},
                                             {0.0, 0.42, 0.91},
                                             {-0.42, 0.0, 0.91},
                                             {0.0, -0.42, 0.91},
                                             {0.60, 0.60, 0.53},
                                             {-0.60, 0.60, 0.53},
                                             {-0.60, -0.60, 0.53},
                                             {0.60, -0.60, 0.53}}};

// 0 where everything about the voxel is closed, 1 where it is open; near obstacles count more than far ones.
double openness(const RayCaster& caster, const Eigen::Vector3d& origin, const Eigen::Vector3d& normal, double reach,
                SkyRays rays) {
  const Eigen::Vector3d side = std::abs(normal.z()) < 0.7 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d a = side.cross(normal).normalized();
  const Eigen::Vector3d b = normal.cross(a);
  const std::size_t step = rays == SkyRays::kAll ? 1 : 2;
  double open = 0;
  for (std::size_t i = rays == SkyRays::kOddHalf ? 1 : 0; i < kSkyRays.size(); i += step) {
    const SkyRay& ray = kSkyRays[i];
    const Eigen::Vector3d direction = ray.along_a * a + ray.along_b * b + ray.along_normal * normal;
    const auto hit = caster.first_hit({origin, direction}, {0, reach});
    open += hit ? hit->distance / reach : 1;
  }
  return open * static_cast<double>(step) / kSkyRays.size();
}

LinearColor mixed(const LinearColor& a, const LinearColor& b, double share) {
  return a + (b - a) * static_cast<float>(std::clamp(share, 0.0, 1.0));
}

}  // namespace

Lighting Lighting::for_camera(const Camera& camera) {
  const Eigen::Matrix3d& axes = camera.map_from_camera().linear();
  const Eigen::Vector3d right = axes.col(0);
  // Away from the viewer in the plane of the ground; up in the picture for a view from above.
  const Eigen::Vector3d ahead = Eigen::Vector3d::UnitZ().cross(right).normalized();
  const bool is_plan = std::abs(axes.col(2).z()) > 0.99;
  const double towards = is_plan ? 0.35 : -0.40;
  return {(-0.55 * right + towards * ahead + 0.75 * Eigen::Vector3d::UnitZ()).normalized()};
}

LightOnVoxel light_on_voxel(const RayCaster& caster, const Eigen::Vector3d& center, double voxel_size,
                            const Eigen::Vector3d& normal, const Lighting& lighting, SkyRays rays) {
  const Eigen::Vector3d origin = center + 1.3 * voxel_size * normal;  // above the roughness of its own surface
  LightOnVoxel light;
  light.sky_share = openness(caster, origin, normal, lighting.sky_reach, rays);
  light.is_in_shade =
      normal.dot(lighting.to_sun) <= 0 || caster.is_blocked({origin, lighting.to_sun}, {0, lighting.shadow_reach});
  return light;
}

LinearColor light_on_face(const LightOnVoxel& voxel, const Eigen::Vector3d& normal, const Lighting& lighting) {
  const double open = 0.25 + 0.75 * voxel.sky_share * voxel.sky_share;
  const LinearColor sky = mixed(kGroundColor, kSkyColor, 0.5 + 0.5 * normal.z()) * static_cast<float>(open);
  const double incidence = normal.dot(lighting.to_sun);
  if (voxel.is_in_shade || incidence <= 0) return sky;
  return sky + kSunColor * static_cast<float>(incidence);
}

Eigen::Vector3d shading_normal(const VoxelRecord& record, VoxelFace face, const Eigen::Vector3d& to_viewer) {
  Eigen::Vector3d stored = normal_of(record);
  if (stored.dot(to_viewer) < 0) stored = -stored;
  const double trust = std::min(1.0, 1.5 * planarity_of(record));
  return (trust * stored + (1 - trust) * normal_of_face(face) + 0.05 * to_viewer).normalized();
}

LinearColor haze_color() { return {0.76F, 0.80F, 0.84F}; }

LinearColor background(const Camera& camera, const Eigen::Vector3d& direction) {
  if (!camera.is_perspective()) return {0.93F, 0.93F, 0.91F};
  const LinearColor zenith(0.30F, 0.47F, 0.72F);
  const LinearColor ground(0.60F, 0.61F, 0.60F);
  const double height = direction.z();
  if (height < 0) return mixed(haze_color(), ground, std::sqrt(-height));
  return mixed(haze_color(), zenith, 1.4 * std::sqrt(height));
}

}  // namespace vdbmap

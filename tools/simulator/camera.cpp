// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "vdbmap/core/srgb.h"

namespace vdbmap::simulator {
namespace {

constexpr double kNoise = 0.02;                 // of a camera, as a share of the light
constexpr double kOffSurface = 0.03;            // [m] where shadow rays begin
constexpr double kGroundLight = 0.16;           // share of the light that the ground sends up
constexpr double kExposure = 0.78;              // so that white walls in the sun just saturate
constexpr double kFarthestShadow = 80;          // [m]
constexpr Rgb16 kDrop = {45000, 46000, 48000};  // of rain, which is no surface: grey as the sky behind it

double linear(double srgb) {
  return linear_from_srgb(static_cast<std::uint16_t>(std::lround(std::clamp(srgb, 0.0, 1.0) * 65535))) / 65535.0;
}

// A fixed random number of [-1, 1] for each cell of a grid.
double cell_noise(double x, double y, double z) {
  const auto key = [](double value) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value)));
  };
  return 2 * unit_interval(hash(hash(key(x), key(y)), key(z))) - 1;
}

bool is_joint(double position, double spacing, double width) {
  return position - spacing * std::floor(position / spacing) < width;
}

// Courses of bricks 7.5 cm high and 25 cm long with pale mortar between.
double brick_shade(double along, double height) {
  const double course = std::floor(height / 0.075);
  const double shifted = along + (std::fmod(std::abs(course), 2) < 1 ? 0 : 0.125);
  if (is_joint(height, 0.075, 0.011) || is_joint(shifted, 0.25, 0.011)) return 1.35;
  return 1 + 0.18 * cell_noise(shifted / 0.25, course, 0);
}

// Factor on a material's colour.
double texture_shade(Texture texture, const Eigen::Vector3d& p, const Eigen::Vector3d& normal, std::uint32_t triangle) {
  // Along the wall, level.
  const double along = p.x() * -normal.y() + p.y() * normal.x();
  switch (texture) {
    case Texture::kPlain:
      return 1;
    case Texture::kAsphalt:
      return 1 + 0.10 * cell_noise(p.x() / 0.02, p.y() / 0.02, 0) + 0.08 * cell_noise(p.x() / 1.7, p.y() / 2.3, 1);
    case Texture::kSlabs:
      return is_joint(p.x(), 0.5, 0.012) || is_joint(p.y(), 0.5, 0.012)
                 ? 0.7
                 : 1 + 0.09 * cell_noise(p.x() / 0.5, p.y() / 0.5, 2);
    case Texture::kSetts:
      return is_joint(p.x(), 0.16, 0.02) || is_joint(p.y(), 0.16, 0.02)
                 ? 0.72
                 : 1 + 0.14 * cell_noise(p.x() / 0.16, p.y() / 0.16, 3);
    case Texture::kPlaster:
      return 1 + 0.03 * cell_noise(along / 0.05, p.z() / 0.05, 4) + 0.04 * cell_noise(along / 1.5, p.z() / 1.5, 5);
    case Texture::kBrick:
      return brick_shade(along, p.z());
    case Texture::kRoofTiles:
      return 1 + 0.16 * cell_noise(p.x() / 0.25, p.y() / 0.25, p.z() / 0.3);
    case Texture::kGrass:
      return 1 + 0.28 * cell_noise(p.x() / 0.04, p.y() / 0.04, 6) + 0.12 * cell_noise(p.x() / 0.7, p.y() / 0.7, 7);
    case Texture::kLeaves:
      return 1 + 0.35 * (2 * unit_interval(hash(triangle / 2)) - 1);
    case Texture::kWood:
      return 1 + 0.15 * cell_noise(p.x() / 0.09, p.y() / 0.09, p.z() / 1.4);
  }
  return 1;
}

bool is_in_shadow(const SceneView& view, const Daylight& light, const Eigen::Vector3d& point,
                  const Eigen::Vector3d& normal) {
  return view.is_blocked({point + kOffSurface * (normal + light.to_sun), light.to_sun, 0, kFarthestShadow});
}

}  // namespace

Daylight make_daylight(std::uint64_t seed, int epoch) {
  Random random(hash(hash(seed, 61), static_cast<std::uint64_t>(epoch)));
  const double bearing = random.uniform(-2.6, -0.5);  // [rad] from east to north: from south-west to south-east
  const double elevation = random.uniform(0.6, 0.95);
  Daylight light;
  light.to_sun = {std::cos(elevation) * std::cos(bearing), std::cos(elevation) * std::sin(bearing),
                  std::sin(elevation)};
  return light;
}

Rgb16 color_of(const SceneView& view, const Daylight& light, const Eigen::Vector3d& point, const Echo& echo,
               RayRandom& random) {
  if (echo.triangle == kNoTriangle) return kDrop;
  const Material& material = view.material(echo.triangle);
  double facing = echo.normal.dot(light.to_sun);
  if (material.texture == Texture::kLeaves) facing = 0.35 + 0.3 * std::abs(facing);  // leaves glow from both sides
  const bool is_lit = facing > 0 && !is_in_shadow(view, light, point, echo.normal);
  const double up = 0.5 + 0.5 * echo.normal.z();
  Eigen::Array3d irradiance = light.sky * (up + (1 - up) * kGroundLight);
  if (is_lit) irradiance += light.sun * facing;
  const double shade = texture_shade(material.texture, point, echo.normal, echo.triangle);
  const double factor = kExposure * shade * (1 + random.normal(0, kNoise));
  const auto channel = [&](int i) {
    return srgb_from_linear(std::clamp(linear(material.color[i]) * irradiance[i] * factor, 0.0, 1.0));
  };
  return {channel(0), channel(1), channel(2)};
}

}  // namespace vdbmap::simulator

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/weather.h"

#include "tools/simulator/random.h"

namespace vdbmap::simulator {
namespace {

constexpr double kWetShare = 0.25;  // of the days
constexpr float kWetGround = 0.4F;  // of its reflectance that wet ground keeps

bool is_ground(SurfaceClass label) {
  using enum SurfaceClass;
  return label == kRoad || label == kParking || label == kPavement;
}

}  // namespace

std::vector<Material> weathered(std::vector<Material> materials, bool is_wet, std::uint64_t seed) {
  for (std::size_t i = 0; i < materials.size(); ++i) {
    Material& material = materials[i];
    const double chance = unit_interval(hash(hash(seed, 94), i));
    if (material.transmission > 0.5F) material.reflectance *= 0.3F;
    if (material.transmission == 0 && material.reflectance < 1 && chance < 1.0 / 7) material.reflectance *= 0.6F;
    if (!is_wet || !is_ground(material.label)) continue;
    material.reflectance *= kWetGround;
    material.gloss = 0.5F;
    material.color *= 0.75F;
  }
  return materials;
}

bool is_wet(std::uint64_t seed, int epoch) {
  return unit_interval(hash(hash(seed, 95), static_cast<std::uint64_t>(epoch))) < kWetShare;
}

}  // namespace vdbmap::simulator

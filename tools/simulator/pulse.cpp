// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/pulse.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vdbmap::simulator {
namespace {

constexpr int kMostPanes = 8;            // that a pulse passes
constexpr double kBehindPane = 0.002;    // [m] where it goes on
constexpr double kRoughShare = 0.3;      // of a rough surface's return does not depend on the angle
constexpr double kMirrorSharpness = 24;  // exponent of the lobe of glossy surfaces
constexpr double kFlatTolerance = 0.06;  // [m] off the plane of the first surface is another surface
constexpr double kMergedShare = 0.45;    // of the double echoes is measured between its surfaces
constexpr double kReflectivityNoise = 0.05;
constexpr double kFarthestSpeck = 12;  // [m] drops beyond send too little back

// What a thin ray meets behind the panes that let it pass.
struct Return {
  Hit hit;
  double strength;  // share of the light that a perfect white surface would send back
};

// Lambert's law with a share that rough surfaces send back at any angle; glossy ones send light elsewhere.
double angular_return(const Material& material, double cosine) {
  const double rough = kRoughShare + (1 - kRoughShare) * cosine;
  const double mirrored = std::pow(cosine, kMirrorSharpness);
  return (1 - material.gloss) * rough + 2 * material.gloss * mirrored;
}

std::optional<Return> trace(const SceneView& view, const PulseModel& model, const Eigen::Vector3d& origin,
                            const Eigen::Vector3d& direction, RayRandom& random) {
  Ray ray = {origin, direction, 0, model.farthest};
  double light = 1;
  for (int pane = 0; pane < kMostPanes; ++pane) {
    const std::optional<Hit> hit = view.first_hit(ray);
    if (!hit) return std::nullopt;
    const Material& material = view.material(hit->triangle);
    if (material.transmission == 0 || !random.chance(material.transmission)) {
      const double cosine = std::abs(hit->normal.dot(direction));
      return Return{*hit, light * material.reflectance * angular_return(material, cosine)};
    }
    light *= 0.85;  // there and back through the pane
    ray.nearest = hit->distance + kBehindPane;
  }
  return std::nullopt;
}

// A direction within the beam, two thirds of its radius off the middle: where half of its light is.
Eigen::Vector3d off_center(const Eigen::Vector3d& direction, double divergence, RayRandom& random) {
  const Eigen::Vector3d across = direction.unitOrthogonal();
  const Eigen::Vector3d up = direction.cross(across);
  const double angle = random.uniform(0, 2 * std::numbers::pi);
  return (direction + divergence / 3 * (std::cos(angle) * across + std::sin(angle) * up)).normalized();
}

bool is_other_surface(const Return& a, const Eigen::Vector3d& direction_a, const Return& b,
                      const Eigen::Vector3d& direction_b) {
  const Eigen::Vector3d gap = b.hit.distance * direction_b - a.hit.distance * direction_a;
  return std::abs(a.hit.normal.dot(gap)) > kFlatTolerance;
}

// The return of a beam that met two surfaces.
Return combine(const PulseModel& model, const Return& a, const Return& b, RayRandom& random) {
  Return stronger = a.strength >= b.strength ? a : b;
  const Return& weaker = a.strength >= b.strength ? b : a;
  const double gap = std::abs(a.hit.distance - b.hit.distance);
  if (gap > model.merging_distance || !random.chance(kMergedShare)) return stronger;
  const double share = weaker.strength / (a.strength + b.strength);
  stronger.hit.distance += share * random.uniform(0, 2) * (weaker.hit.distance - stronger.hit.distance);
  return stronger;
}

std::optional<Return> trace_beam(const SceneView& view, const PulseModel& model, const Eigen::Vector3d& origin,
                                 const Eigen::Vector3d& direction, RayRandom& random) {
  const std::optional<Return> middle = trace(view, model, origin, direction, random);
  if (model.divergence == 0) return middle;
  const Eigen::Vector3d aside = off_center(direction, model.divergence, random);
  const std::optional<Return> other = trace(view, model, origin, aside, random);
  if (!middle || !other) return middle;
  return is_other_surface(*middle, direction, *other, aside) ? combine(model, *middle, *other, random) : middle;
}

// The radar equation of surfaces that fill the beam: light falls off with the square of the range.
bool is_detected(const PulseModel& model, const Return& found, RayRandom& random) {
  if (model.random_loss > 0 && random.chance(model.random_loss)) return false;
  if (model.half_range == 0) return true;
  const double light = found.strength / 0.1 * std::pow(model.half_range / found.hit.distance, 2);
  return random.chance(light * light / (1 + light * light));
}

std::optional<Echo> rain_echo(const PulseModel& model, const Eigen::Vector3d& direction, RayRandom& random) {
  if (model.specks == 0 || !random.chance(model.specks * kFarthestSpeck)) return std::nullopt;
  return Echo{random.uniform(model.nearest, kFarthestSpeck), kNoTriangle, -direction, random.uniform(0.01, 0.05)};
}

}  // namespace

std::optional<Echo> measure(const SceneView& view, const PulseModel& model, const Eigen::Vector3d& origin,
                            const Eigen::Vector3d& direction, RayRandom& random) {
  const std::optional<Return> found = trace_beam(view, model, origin, direction, random);
  const std::optional<Echo> speck = rain_echo(model, direction, random);
  if (speck && (!found || speck->range < found->hit.distance)) return speck;
  if (!found || !is_detected(model, *found, random)) return std::nullopt;
  const double range = found->hit.distance + (model.range_noise > 0 ? random.normal(0, model.range_noise) : 0.0);
  if (range < model.nearest || range > model.farthest) return std::nullopt;
  const double reflectivity = std::max(0.0, found->strength * (1 + random.normal(0, kReflectivityNoise)));
  return Echo{range, found->hit.triangle, found->hit.normal, reflectivity};
}

}  // namespace vdbmap::simulator

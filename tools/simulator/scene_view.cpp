// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/scene_view.h"

#include "tools/simulator/traffic.h"

namespace vdbmap::simulator {

const Triangle& SceneView::triangle(std::uint32_t index) const {
  const auto num_lasting = static_cast<std::uint32_t>(mesh.triangles.size());
  return index < num_lasting ? mesh.triangles[index] : traffic->mesh().triangles[index - num_lasting];
}

PointTruth SceneView::truth(std::uint32_t index) const {
  if (index == kNoTriangle) return {static_cast<std::uint16_t>(SurfaceClass::kOutlier), 0};
  const SurfaceClass label = material(index).label;
  const bool moves = index >= mesh.triangles.size();
  return {static_cast<std::uint16_t>(moves ? moving_class(label) : label), triangle(index).object};
}

std::optional<Hit> SceneView::first_hit(const Ray& ray) const {
  std::optional<Hit> hit = caster.first_hit(ray);
  if (traffic == nullptr) return hit;
  Ray nearer = ray;
  if (hit) nearer.farthest = hit->distance;
  std::optional<Hit> moving = traffic->first_hit(nearer, time);
  if (!moving) return hit;
  moving->triangle += static_cast<std::uint32_t>(mesh.triangles.size());
  return moving;
}

bool SceneView::is_blocked(const Ray& ray) const {
  return caster.is_blocked(ray) || (traffic != nullptr && traffic->first_hit(ray, time));
}

}  // namespace vdbmap::simulator

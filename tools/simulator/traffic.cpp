// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/traffic.h"

#include <algorithm>
#include <utility>

namespace vdbmap::simulator {
namespace {

// A mover's poses before and after a time, and the share of the way between them.
struct Between {
  const Eigen::Isometry3d& before;
  const Eigen::Isometry3d& after;
  double share;

  Eigen::Vector3d position() const { return (1 - share) * before.translation() + share * after.translation(); }
};

std::optional<Between> find(const Traffic::Mover& mover, double time) {
  const double place = (time - mover.begin_time) / Traffic::kPeriod;
  if (place < 0 || place >= static_cast<double>(mover.scene_from_body.size()) - 1) return std::nullopt;
  const auto index = static_cast<std::size_t>(place);
  return Between{mover.scene_from_body[index], mover.scene_from_body[index + 1], place - static_cast<double>(index)};
}

Eigen::Isometry3d interpolate(const Between& between) {
  const Eigen::Quaterniond a(between.before.linear()), b(between.after.linear());
  Eigen::Isometry3d pose(a.slerp(between.share, b));
  pose.translation() = between.position();
  return pose;
}

bool passes_ball(const Ray& ray, const Eigen::Vector3d& center, double radius) {
  const Eigen::Vector3d to_center = center - ray.origin;
  const double along = to_center.dot(ray.direction);
  if (along < ray.nearest - radius || along > ray.farthest + radius) return false;
  return to_center.squaredNorm() - along * along <= radius * radius;
}

}  // namespace

std::optional<Eigen::Isometry3d> pose_at(const Traffic::Mover& mover, double time) {
  const std::optional<Between> between = find(mover, time);
  return between ? std::optional(interpolate(*between)) : std::nullopt;
}

Traffic::Traffic(std::vector<Mover> movers) : movers_(std::move(movers)) {
  for (const Mover& mover : movers_) {
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& vertex : mover.model.vertices) box.extend(vertex);
    bodies_.push_back({RayCaster(mover.model), box.center().cast<double>(), box.diagonal().norm() / 2.0,
                       static_cast<std::uint32_t>(mesh_.triangles.size())});
    mesh_.append(mover.model);
  }
}

std::optional<Hit> Traffic::first_hit(const Ray& ray, double time) const {
  std::optional<Hit> nearest;
  Ray rest = ray;
  for (std::size_t i = 0; i < movers_.size(); ++i) {
    const std::optional<Between> between = find(movers_[i], time);
    // The ball about the body's foot needs no rotation.
    if (!between || !passes_ball(rest, between->position(), bodies_[i].radius + bodies_[i].center.norm())) continue;
    const Eigen::Isometry3d body_from_scene = interpolate(*between).inverse();
    const std::optional<Hit> hit = bodies_[i].caster.first_hit(
        {body_from_scene * rest.origin, body_from_scene.linear() * rest.direction, rest.nearest, rest.farthest});
    if (!hit) continue;
    nearest = {hit->distance, bodies_[i].first_triangle + hit->triangle,
               body_from_scene.linear().transpose() * hit->normal};
    rest.farthest = hit->distance;
  }
  return nearest;
}

}  // namespace vdbmap::simulator

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/site_placement.h"

namespace vdbmap {

SitePlacement::SitePlacement(const MapFrame& frame, double geoid_offset) : anchor_(frame.anchor) {
  if (frame.epsg) transform_.emplace(*frame.epsg, geoid_offset);
}

Eigen::Vector3d SitePlacement::world_of(const Eigen::Vector3d& local) const {
  return transform_ ? transform_->to_ecef(anchor_ + local) : local;
}

Eigen::Affine3d SitePlacement::world_from_local(const Eigen::AlignedBox3d& box) const {
  if (!transform_) return Eigen::Affine3d::Identity();
  // Of the corners of a box, the least squares are means and differences.
  const Eigen::Vector3d center = box.center(), half = box.sizes() / 2;
  Eigen::Vector3d world_center = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d side(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    const Eigen::Vector3d world = world_of(center + side.cwiseProduct(half));
    world_center += world / 8;
    axes += world * side.cwiseQuotient(half).transpose() / 8;
  }
  Eigen::Affine3d world_from_local;
  world_from_local.linear() = axes;
  world_from_local.translation() = world_center - axes * center;
  return world_from_local;
}

}  // namespace vdbmap

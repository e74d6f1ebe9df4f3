// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/geodesy/geodetic_transform.h"

#include <cmath>
#include <memory>
#include <stdexcept>

#include "vdbmap/io/file/module.h"
#include "vdbmap/io/geodesy/projection_module.h"

namespace vdbmap {

const ProjectionModule& projection_module() {
  static const ProjectionModule& module = *load_module<ProjectionModule>(
      "vdbmap_projections.so", "vdbmap_projection_module", "what knows coordinate systems");
  return module;
}

GeodeticTransform::GeodeticTransform(int epsg, double geoid_offset) : geoid_offset_(geoid_offset) {
  if (!std::isfinite(geoid_offset)) throw std::invalid_argument("the geoid offset is not finite");
  projection_ = projection_module().make(epsg);
}

GeodeticTransform::~GeodeticTransform() = default;
GeodeticTransform::GeodeticTransform(GeodeticTransform&&) noexcept = default;
GeodeticTransform& GeodeticTransform::operator=(GeodeticTransform&&) noexcept = default;

Eigen::Vector3d GeodeticTransform::to_wgs84(const Eigen::Vector3d& original) const {
  const Eigen::Vector2d degrees = projection_->to_degrees(original);
  return {degrees.x(), degrees.y(), original.z() * projection_->height_unit() + geoid_offset_};
}

Eigen::Vector3d GeodeticTransform::from_wgs84(const Eigen::Vector3d& lon_lat_height) const {
  // Shifts of the datum in two dimensions and back miss by some mm; what is missed is added once.
  Eigen::Vector3d aim = lon_lat_height;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  place.head<2>() = projection_->from_degrees(aim);
  aim.head<2>() += lon_lat_height.head<2>() - projection_->to_degrees(place);
  place.head<2>() = projection_->from_degrees(aim);
  return {place.x(), place.y(), (lon_lat_height.z() - geoid_offset_) / projection_->height_unit()};
}

Eigen::Vector3d GeodeticTransform::to_ecef(const Eigen::Vector3d& original) const {
  return projection_->to_ecef(to_wgs84(original));
}

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/exchange/geo_frame.h"

#include <cmath>

namespace vdbmap::parking {
namespace {

using Json = nlohmann::ordered_json;

double rounded(double value, double steps) { return std::round(value * steps) / steps; }

}  // namespace

GeoFrame::GeoFrame(const MapFrame& frame, const GeoOptions& options) : frame_(frame) {
  if (options.coordinates == GeoCoordinates::kWgs84 && frame.epsg)
    transform_.emplace(*frame.epsg, options.geoid_offset);
}

Json GeoFrame::position(const Eigen::Vector3d& local) const {
  constexpr double kDegreeSteps = 1e9, kMetreSteps = 1e4;  // 0.1 mm both
  const Eigen::Vector3d original = local + frame_.anchor;
  const Eigen::Vector3d place = transform_ ? transform_->to_wgs84(original) : original;
  const double steps = transform_ ? kDegreeSteps : kMetreSteps;
  return {rounded(place.x(), steps), rounded(place.y(), steps), rounded(place.z(), kMetreSteps)};
}

Json GeoFrame::polygon(std::span<const Eigen::Vector2d> outline, const std::optional<double>& ground) const {
  Json ring = Json::array();
  for (const Eigen::Vector2d& corner : outline) {
    Json place = position({corner.x(), corner.y(), ground.value_or(0)});
    if (!ground) place.erase(2);
    ring.push_back(std::move(place));
  }
  ring.push_back(ring.front());
  return {{"type", "Polygon"}, {"coordinates", Json::array({ring})}};
}

std::optional<Json> GeoFrame::crs() const {
  if (transform_ || !frame_.epsg) return std::nullopt;
  return Json{{"type", "name"}, {"properties", {{"name", "urn:ogc:def:crs:EPSG::" + std::to_string(*frame_.epsg)}}}};
}

}  // namespace vdbmap::parking

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/geodesy/geodetic_transform.h"

#include <cmath>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include <proj.h>

namespace vdbmap {
namespace {

// Plain functions destroy: types of ours in this namespace could not be members of GeodeticTransform::Proj.
using Context = std::unique_ptr<PJ_CONTEXT, PJ_CONTEXT* (*)(PJ_CONTEXT*)>;
using Pj = std::unique_ptr<PJ, PJ* (*)(PJ*)>;

Pj own(PJ* pj) { return {pj, &proj_destroy}; }

Context make_context() {
  Context context(proj_context_create(), &proj_context_destroy);
  if (!context) throw std::bad_alloc();
  proj_log_level(context.get(), PJ_LOG_NONE);
  proj_context_set_enable_network(context.get(), 0);
  return context;
}

std::string name_of(int epsg) { return "EPSG:" + std::to_string(epsg); }

[[noreturn]] void refuse(int epsg, const std::string& reason) { throw std::invalid_argument(name_of(epsg) + reason); }

Pj find_system(PJ_CONTEXT* context, int epsg) {
  const std::string code = std::to_string(epsg);
  Pj system = own(proj_create_from_database(context, "EPSG", code.c_str(), PJ_CATEGORY_CRS, 0, nullptr));
  if (!system) refuse(epsg, " is no coordinate system that PROJ knows");
  return system;
}

bool is_compound(const PJ* system) { return proj_get_type(system) == PJ_TYPE_COMPOUND_CRS; }

// Without heights, which are those of the map.
Pj horizontal_part(PJ_CONTEXT* context, const PJ* system, int epsg) {
  Pj horizontal = own(is_compound(system) ? proj_crs_get_sub_crs(context, system, 0) : proj_clone(context, system));
  if (!horizontal || proj_get_type(horizontal.get()) != PJ_TYPE_PROJECTED_CRS) {
    refuse(epsg, " is no projected coordinate system, expected one of eastings and northings");
  }
  return horizontal;
}

// Metres in the unit of an axis of a system.
double axis_unit(PJ_CONTEXT* context, const PJ* system, int axis) {
  const Pj axes = own(proj_crs_get_coordinate_system(context, system));
  double metres = 1;
  if (axes)
    proj_cs_get_axis_info(context, axes.get(), axis, nullptr, nullptr, nullptr, &metres, nullptr, nullptr, nullptr);
  return metres;
}

// Heights of a system that says nothing of them have the unit of its eastings.
double height_unit(PJ_CONTEXT* context, const PJ* system, const PJ* horizontal) {
  if (!is_compound(system)) return axis_unit(context, horizontal, 0);
  const Pj vertical = own(proj_crs_get_sub_crs(context, system, 1));
  return vertical ? axis_unit(context, vertical.get(), 0) : 1;
}

Pj degrees_from_system(PJ_CONTEXT* context, const PJ* horizontal, int epsg) {
  constexpr int kWgs84 = 4326;
  const Pj degrees = find_system(context, kWgs84);
  const Pj transform = own(proj_create_crs_to_crs_from_pj(context, horizontal, degrees.get(), nullptr, nullptr));
  // East before north, whatever order the system's own axes have.
  Pj ordered = own(transform ? proj_normalize_for_visualization(context, transform.get()) : nullptr);
  if (!ordered) refuse(epsg, " cannot be transformed to WGS 84");
  return ordered;
}

std::string text_of(const Eigen::Vector3d& place) {
  return "(" + std::to_string(place.x()) + ", " + std::to_string(place.y()) + ", " + std::to_string(place.z()) + ")";
}

}  // namespace

struct GeodeticTransform::Proj {
  int epsg;
  double geoid_offset;  // [m]
  Context context;
  double height_unit;  // [m]
  Pj degrees_from_system;
  Pj ecef_from_degrees;

  // The height is not PROJ's concern: a shift of the datum would take it along.
  Eigen::Vector2d run(PJ_DIRECTION direction, const Eigen::Vector3d& place) const {
    PJ* const transform = degrees_from_system.get();
    proj_errno_reset(transform);
    const PJ_COORD from = proj_coord(place.x(), place.y(), 0, HUGE_VAL);
    const PJ_COORD to = proj_trans(transform, direction, from);
    if (!place.allFinite() || !std::isfinite(to.xy.x) || !std::isfinite(to.xy.y)) {
      throw std::invalid_argument(text_of(place) + " is beyond the reach of " + name_of(epsg));
    }
    return {to.xy.x, to.xy.y};
  }
};

GeodeticTransform::GeodeticTransform(int epsg, double geoid_offset) {
  if (!std::isfinite(geoid_offset)) throw std::invalid_argument("the geoid offset is not finite");
  Context context = make_context();
  const Pj system = find_system(context.get(), epsg);
  const Pj horizontal = horizontal_part(context.get(), system.get(), epsg);
  const double unit = height_unit(context.get(), system.get(), horizontal.get());
  Pj to_degrees = degrees_from_system(context.get(), horizontal.get(), epsg);
  Pj to_ecef = own(proj_create(context.get(),
                               "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad "
                               "+step +proj=cart +ellps=WGS84"));
  if (!to_ecef) refuse(epsg, " cannot be transformed to WGS 84");
  proj_ = std::make_unique<Proj>(
      Proj{epsg, geoid_offset, std::move(context), unit, std::move(to_degrees), std::move(to_ecef)});
}

GeodeticTransform::~GeodeticTransform() = default;
GeodeticTransform::GeodeticTransform(GeodeticTransform&&) noexcept = default;
GeodeticTransform& GeodeticTransform::operator=(GeodeticTransform&&) noexcept = default;

Eigen::Vector3d GeodeticTransform::to_wgs84(const Eigen::Vector3d& original) const {
  const Eigen::Vector2d degrees = proj_->run(PJ_FWD, original);
  return {degrees.x(), degrees.y(), original.z() * proj_->height_unit + proj_->geoid_offset};
}

Eigen::Vector3d GeodeticTransform::from_wgs84(const Eigen::Vector3d& lon_lat_height) const {
  // Shifts of the datum in two dimensions and back miss by some mm; what is missed is added once.
  Eigen::Vector3d aim = lon_lat_height;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  place.head<2>() = proj_->run(PJ_INV, aim);
  aim.head<2>() += lon_lat_height.head<2>() - proj_->run(PJ_FWD, place);
  place.head<2>() = proj_->run(PJ_INV, aim);
  return {place.x(), place.y(), (lon_lat_height.z() - proj_->geoid_offset) / proj_->height_unit};
}

Eigen::Vector3d GeodeticTransform::to_ecef(const Eigen::Vector3d& original) const {
  const Eigen::Vector3d degrees = to_wgs84(original);
  const PJ_COORD ecef =
      proj_trans(proj_->ecef_from_degrees.get(), PJ_FWD, proj_coord(degrees.x(), degrees.y(), degrees.z(), HUGE_VAL));
  return {ecef.xyz.x, ecef.xyz.y, ecef.xyz.z};
}

}  // namespace vdbmap

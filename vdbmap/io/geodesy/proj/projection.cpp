// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include <proj.h>

#include "vdbmap/io/geodesy/projection_module.h"

namespace vdbmap {
namespace {

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
double height_unit_of(PJ_CONTEXT* context, const PJ* system, const PJ* horizontal) {
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

class ProjProjection final : public Projection {
 public:
  explicit ProjProjection(int epsg)
      : epsg_(epsg), context_(make_context()), to_degrees_(own(nullptr)), to_ecef_(own(nullptr)) {
    const Pj system = find_system(context_.get(), epsg);
    const Pj horizontal = horizontal_part(context_.get(), system.get(), epsg);
    height_unit_ = height_unit_of(context_.get(), system.get(), horizontal.get());
    to_degrees_ = degrees_from_system(context_.get(), horizontal.get(), epsg);
    to_ecef_ = own(proj_create(context_.get(),
                               "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad "
                               "+step +proj=cart +ellps=WGS84"));
    if (!to_ecef_) refuse(epsg, " cannot be transformed to WGS 84");
  }

  double height_unit() const override { return height_unit_; }
  Eigen::Vector2d to_degrees(const Eigen::Vector3d& place) const override { return run(PJ_FWD, place); }
  Eigen::Vector2d from_degrees(const Eigen::Vector3d& place) const override { return run(PJ_INV, place); }

  Eigen::Vector3d to_ecef(const Eigen::Vector3d& degrees) const override {
    const PJ_COORD place = proj_coord(degrees.x(), degrees.y(), degrees.z(), HUGE_VAL);
    const PJ_COORD ecef = proj_trans(to_ecef_.get(), PJ_FWD, place);
    return {ecef.xyz.x, ecef.xyz.y, ecef.xyz.z};
  }

 private:
  // The height is not PROJ's concern: a shift of the datum would take it along.
  Eigen::Vector2d run(PJ_DIRECTION direction, const Eigen::Vector3d& place) const {
    proj_errno_reset(to_degrees_.get());
    const PJ_COORD from = proj_coord(place.x(), place.y(), 0, HUGE_VAL);
    const PJ_COORD to = proj_trans(to_degrees_.get(), direction, from);
    if (!place.allFinite() || !std::isfinite(to.xy.x) || !std::isfinite(to.xy.y)) {
      throw std::invalid_argument(text_of(place) + " is beyond the reach of " + name_of(epsg_));
    }
    return {to.xy.x, to.xy.y};
  }

  int epsg_;
  Context context_;
  double height_unit_ = 1;  // [m]
  Pj to_degrees_;
  Pj to_ecef_;
};

}  // namespace
}  // namespace vdbmap

extern "C" __attribute__((visibility("default"))) const vdbmap::ProjectionModule* vdbmap_projection_module() {
  static const vdbmap::ProjectionModule module{
      [](int epsg) -> std::unique_ptr<vdbmap::Projection> { return std::make_unique<vdbmap::ProjProjection>(epsg); }};
  return &module;
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/street_json.h"

#include <array>
#include <numbers>
#include <span>

#include <nlohmann/json.hpp>

#include "tools/simulator/label_names.h"

namespace vdbmap::simulator {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json json_of(const Eigen::Isometry3d& transform) {
  Json rows = Json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) rows.push_back(transform.matrix()(row, column));
  }
  return rows;
}

Json json_of_options(const StreetOptions& options) {
  Json json = {{"seed", options.seed},         {"length", options.length},       {"margin", options.margin},
               {"epochs", options.num_epochs}, {"occupancy", options.occupancy}, {"turnover", options.turnover}};
  if (options.is_quarter()) json["quarter"] = {options.quarter_columns, options.quarter_rows};
  return json;
}

Json json_of_axis(const StreetAxis& axis) {
  return {{"origin", json_of(axis.origin)},        {"heading", axis.heading},
          {"bend_amplitude", axis.bend_amplitude}, {"bend_length", axis.bend_length},
          {"bend_phase", axis.bend_phase},         {"slope", axis.slope},
          {"sag_amplitude", axis.sag_amplitude},   {"sag_length", axis.sag_length}};
}

Json json_of_house_type(const HouseType& type) {
  constexpr std::array<const char*, 3> kRoofs = {"along", "across", "flat"};
  return {{"width", type.width},
          {"depth", type.depth},
          {"storeys", type.num_storeys},
          {"storey_height", type.storey_height},
          {"plinth", type.plinth},
          {"roof", kRoofs[static_cast<std::size_t>(type.roof)]},
          {"roof_slope", type.roof_slope},
          {"axes", type.num_axes},
          {"door_axis", type.door_axis},
          {"window_width", type.window_width},
          {"window_height", type.window_height},
          {"sill", type.sill},
          {"recess", type.recess},
          {"bay_axis", type.bay_axis},
          {"balcony_axis", type.balcony_axis},
          {"brick", type.has_brick},
          {"dormers", type.has_dormers},
          {"stand_back", type.stand_back}};
}

Json json_of_lot(const Lot& lot) {
  Json json = {{"kind", name_of(lot.kind)}, {"begin", lot.along.begin}, {"end", lot.along.end}, {"seed", lot.seed}};
  if (lot.kind == LotKind::kHouse) json["house_type"] = lot.house_type;
  return json;
}

Json json_of_side(const SideLayout& side) {
  constexpr std::array<const char*, 3> kHousing = {"terraced", "block", "detached"};
  Json types = Json::array();
  for (const HouseType& type : side.house_types) types.push_back(json_of_house_type(type));
  Json lots = Json::array();
  for (const Lot& lot : side.lots) lots.push_back(json_of_lot(lot));
  return {{"side", side.sign > 0 ? "left" : "right"},
          {"parking", name_of(side.parking)},
          {"housing", kHousing[static_cast<std::size_t>(side.housing)]},
          {"lane_width", side.lane_width},
          {"parking_width", side.parking_width},
          {"pavement_width", side.pavement_width},
          {"garden_depth", side.garden_depth},
          {"house_types", types},
          {"lots", lots}};
}

Json json_of_objects(const Street& street) {
  Json objects = Json::array();
  for (std::size_t i = 0; i < street.world.objects().size(); ++i) {
    const SceneObject& object = street.world.objects()[i];
    Json json = {{"id", i}, {"kind", object.kind}};
    json["position"] = json_of(street.origin() + object.position);
    if (object.epoch >= 0) json["epoch"] = object.epoch;
    if (object.moves) json["moves"] = true;
    objects.push_back(json);
  }
  return objects;
}

Json json_of_pulse(const PulseModel& pulse) {
  return {{"nearest", pulse.nearest},
          {"farthest", pulse.farthest},
          {"range_noise", pulse.range_noise},
          {"divergence", pulse.divergence},
          {"half_range", pulse.half_range},
          {"random_loss", pulse.random_loss},
          {"merging_distance", pulse.merging_distance}};
}

Json json_of_errors(const LidarModel& lidar) {
  Json biases = Json::array(), elevations = Json::array();
  for (const Laser& laser : lidar.lasers) {
    biases.push_back(laser.range_bias);
    elevations.push_back(laser.elevation_error * 180 / std::numbers::pi);
  }
  return {{"range_bias", biases},
          {"elevation_deg", elevations},
          {"clock", lidar.clock_error},
          {"blooming", lidar.blooming},
          {"specks", lidar.pulse.specks}};
}

Json json_of_waves(std::span<const MapperError::Wave> waves) {
  Json json = Json::array();
  for (const MapperError::Wave& wave : waves) {
    json.push_back({{"amplitude", wave.amplitude}, {"length", wave.length}, {"phase", wave.phase}});
  }
  return json;
}

Json json_of_layout(const StreetLayout& layout) {
  Json sides = Json::array();
  for (const SideLayout& side : layout.sides) sides.push_back(json_of_side(side));
  return {{"axis", json_of_axis(layout.axis)}, {"sides", sides}};
}

Json json_of_quarter(const Street& street) {
  Json streets = Json::array();
  for (const StreetLayout& layout : street.layouts) streets.push_back(json_of_layout(layout));
  Json crossings = Json::array();
  for (const Crossing& crossing : street.crossings) {
    crossings.push_back({{"streets", {crossing.row_street, crossing.column_street}},
                         {"stations", {crossing.row_station, crossing.column_station}}});
  }
  Json tour = Json::array();
  for (const Leg& leg : street.tour) tour.push_back({{"street", leg.street}, {"from", leg.from}, {"to", leg.to}});
  return {{"streets", streets}, {"crossings", crossings}, {"tour", tour}};
}

}  // namespace

Json json_of_street(const Street& street) {
  Json classes = Json::array();
  for (const auto& [label, name] : label_names(street.options.is_ideal)) {
    classes.push_back({{"label", static_cast<int>(label)}, {"name", name}});
  }
  Json json = {{"options", json_of_options(street.options)}, {"epsg", 25832}};
  if (street.options.is_quarter()) {
    json.update(json_of_quarter(street));
  } else {
    json.update(json_of_layout(street.layouts.front()));
  }
  json.update({{"classes", classes}, {"objects", json_of_objects(street)}});
  return json;
}

Json json_of_lidar(const LidarModel& lidar) {
  Json elevations = Json::array();
  for (const Laser& laser : lidar.lasers) elevations.push_back(laser.elevation * 180 / std::numbers::pi);
  Json json = {{"firings_per_turn", lidar.num_firings},
               {"turn_time", lidar.turn_time},
               {"elevations_deg", elevations},
               {"vehicle_from_scanner", json_of(lidar.vehicle_from_scanner)},
               {"pulse", json_of_pulse(lidar.pulse)}};
  if (lidar.blooming > 0) json["errors"] = json_of_errors(lidar);
  return json;
}

Json json_of_mapper(const MapperModel& mapper) {
  Json mountings = Json::array();
  for (const Eigen::Isometry3d& mounting : mapper.vehicle_from_scanner) mountings.push_back(json_of(mounting));
  return {{"pulses_per_line", mapper.pulses_per_line},
          {"line_rate", mapper.line_rate},
          {"vehicle_from_scanner", mountings},
          {"pulse", json_of_pulse(mapper.pulse)}};
}

Json json_of_drive(const DriveOptions& drive) {
  return {{"from", drive.from},
          {"to", drive.to},
          {"speed", drive.speed},
          {"start_time", drive.start_time},
          {"seed", drive.seed}};
}

Json json_of_mapper_error(const MapperError& error) {
  Json drift = Json::array(), boresight = Json::array(), lever_arm = Json::array();
  for (const auto& axis : error.drift) drift.push_back(json_of_waves(axis));
  for (const Eigen::Vector3d& angles : error.boresight) boresight.push_back(json_of(angles));
  for (const Eigen::Vector3d& arm : error.lever_arm) lever_arm.push_back(json_of(arm));
  return {{"drift", drift},
          {"attitude", json_of_waves(error.attitude)},
          {"boresight", boresight},
          {"lever_arm", lever_arm},
          {"intensity_gain", error.intensity_gain},
          {"color_gain", json_of(error.color_gain)},
          {"camera_blunders", error.has_camera_blunders}};
}

}  // namespace vdbmap::simulator

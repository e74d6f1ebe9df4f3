// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/exchange/occupancy_files.h"

#include <cmath>
#include <sstream>

#include <nlohmann/json.hpp>

#include "parking/exchange/geo_frame.h"
#include "parking/exchange/space_properties.h"

namespace vdbmap::parking {
namespace {

using Json = nlohmann::ordered_json;

template <typename Value>
Json value_or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json previous_of(const SpaceOccupancy& state) {
  return state.previous ? Json(text_of(*state.previous)) : Json(nullptr);
}

Json occupant_of(const SpaceOccupancy& state) {
  return state.occupant ? Json(text_of(*state.occupant)) : Json(nullptr);
}

Json vehicle_of(const Vehicle& vehicle, const Eigen::Vector3d& anchor) {
  const Eigen::Vector3d center = vehicle.box.center + anchor;
  return {{"center", {to_millimetres(center.x()), to_millimetres(center.y()), to_millimetres(center.z())}},
          {"length", to_millimetres(vehicle.box.length)},
          {"width", to_millimetres(vehicle.box.width)},
          {"height", to_millimetres(vehicle.box.height)},
          {"heading", to_millionths(vehicle.box.heading)},
          {"points", vehicle.num_points},
          {"is_completed", vehicle.is_completed},
          {"doubt", text_or_null(vehicle.doubt)}};
}

Json state_of(const OccupancyRecord& record, std::size_t i) {
  const ParkingSpace& space = record.spaces[i];
  const SpaceOccupancy& state = record.states[i];
  const SpaceEvidence& evidence = state.evidence;
  Json json = {{"id", space.id},
               {"state", text_of(state.state)},
               {"previous_state", previous_of(state)},
               {"confidence", to_millimetres(state.confidence)},
               {"reason", text_or_null(state.reason)},
               {"occupied_by", occupant_of(state)},
               {"vehicle_points", evidence.vehicle_points - evidence.neighbor_points},
               {"neighbor_points", evidence.neighbor_points},
               {"thing_points", evidence.thing_points},
               {"thing_height", to_millimetres(evidence.thing_height)},
               {"rays_through", evidence.rays_through},
               {"columns", evidence.num_columns},
               {"columns_passed", evidence.num_passed},
               {"columns_passed_low", evidence.num_passed_low},
               {"columns_with_vehicle", evidence.num_with_vehicle},
               {"columns_with_other", evidence.num_with_other},
               {"inner_columns_with_thing", evidence.num_with_thing},
               {"days_in_state", value_or_null(days_in_state(space, state.state, record.date))},
               {"vehicle", nullptr}};
  if (evidence.vehicle) json["vehicle"] = vehicle_of(record.vehicles[*evidence.vehicle], record.frame.anchor);
  Json own = properties_of(space);
  own.erase("id");
  json.update(own);
  return json;
}

Json turnover_of(const OccupancyRecord& record) {
  const StreetTurnover change = turnover(record.spaces, record.states, record.date);
  return {{"known_in_both", change.num_known},
          {"became_vacant", change.num_left},
          {"became_occupied", change.num_came},
          {"share", to_millimetres(change.share())},
          {"days", value_or_null(change.days)}};
}

// A field of a table; in quotes where it needs them.
std::string cell(std::string text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  for (std::size_t i = 0; (i = text.find('"', i)) != std::string::npos; i += 2) text.insert(i, 1, '"');
  return '"' + text + '"';
}

std::string cell(const Json& value) { return value.is_null() ? "" : value.dump(); }

}  // namespace

Json json_of(const OccupancyRecord& record) {
  const StreetOccupancy street = street_occupancy(record.spaces, record.states);
  Json spaces = Json::array();
  std::size_t num_candidates = 0;
  for (std::size_t i = 0; i < record.spaces.size(); ++i) {
    num_candidates += record.spaces[i].is_candidate ? 1 : 0;
    spaces.push_back(state_of(record, i));
  }
  return {{"place", record.place},
          {"map", record.map_name},
          {"date", text_or_null(record.date)},
          {"rule", record.rule.as_paper ? "paper" : "rays"},
          {"spaces_counted", street.num_spaces()},
          {"candidates", num_candidates},
          {"occupied", street.num_occupied},
          {"vacant", street.num_vacant},
          {"unknown", street.num_unknown},
          {"occupancy", {{"known", value_or_null(street.known())}, {"low", street.low()}, {"high", street.high()}}},
          {"turnover", turnover_of(record)},
          {"spaces", spaces}};
}

std::string geojson_of(const OccupancyRecord& record, const GeoOptions& options) {
  const GeoFrame geo(record.frame, options);
  Json features = Json::array();
  for (std::size_t i = 0; i < record.spaces.size(); ++i) {
    ParkingSpace space = record.spaces[i];
    const SpaceOccupancy& state = record.states[i];
    space.history.push_back({record.date, state.state});
    Json properties = {{"id", space.id},
                       {"state", text_of(state.state)},
                       {"previous_state", previous_of(state)},
                       {"confidence", to_millimetres(state.confidence)},
                       {"occupied_by", occupant_of(state)},
                       {"vehicle_points", state.evidence.vehicle_points - state.evidence.neighbor_points},
                       {"thing_points", state.evidence.thing_points},
                       {"rays_through", state.evidence.rays_through},
                       {"date", text_or_null(record.date)},
                       {"reason", text_or_null(state.reason)}};
    properties.update(properties_of(space));
    features.push_back({{"type", "Feature"},
                        {"geometry", geo.polygon(space.outline, space.ground)},
                        {"properties", std::move(properties)}});
  }
  return text_of_collection(std::move(features), geo);
}

std::string csv_of(const OccupancyRecord& record, const GeoOptions& options) {
  const GeoFrame globe(record.frame, options), metres(record.frame, {.coordinates = GeoCoordinates::kMap});
  std::string text =
      "id,state,previous_state,confidence,vehicle_points,rays_through,columns,columns_passed,kerb_side,angle,candidate,"
      "length,width,heading,x,y,longitude,latitude,date,days_in_state,reason,occupied_by,thing_points\r\n";
  for (std::size_t i = 0; i < record.spaces.size(); ++i) {
    const ParkingSpace& space = record.spaces[i];
    const SpaceOccupancy& state = record.states[i];
    const Eigen::Vector3d middle = box_of(space).center;
    const Json place = metres.position(middle);
    const Json on_globe = globe.is_wgs84() ? globe.position(middle) : Json::array({nullptr, nullptr});
    const std::string previous = state.previous ? std::string(text_of(*state.previous)) : "";
    const std::string fields[] = {cell(space.id),
                                  std::string(text_of(state.state)),
                                  previous,
                                  cell(Json(to_millimetres(state.confidence))),
                                  cell(Json(state.evidence.vehicle_points - state.evidence.neighbor_points)),
                                  cell(Json(state.evidence.rays_through)),
                                  cell(Json(state.evidence.num_columns)),
                                  cell(Json(state.evidence.num_passed)),
                                  cell(space.kerb_side),
                                  std::string(text_of(space.angle)),
                                  space.is_candidate ? "true" : "false",
                                  cell(Json(to_millimetres(space.length))),
                                  cell(Json(to_millimetres(space.width))),
                                  cell(Json(to_millionths(space.heading))),
                                  cell(place[0]),
                                  cell(place[1]),
                                  cell(on_globe[0]),
                                  cell(on_globe[1]),
                                  cell(record.date),
                                  cell(value_or_null(days_in_state(space, state.state, record.date))),
                                  cell(state.reason),
                                  state.occupant ? std::string(text_of(*state.occupant)) : "",
                                  cell(Json(state.evidence.thing_points))};
    bool is_first = true;
    for (const std::string& field : fields) {
      if (!is_first) text += ',';
      is_first = false;
      text += field;
    }
    text += "\r\n";
  }
  return text;
}

}  // namespace vdbmap::parking

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/site_spaces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>
#include <utility>

#include <nlohmann/json.hpp>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/file/text.h"
#include "vdbmap/io/geodesy/geodetic_transform.h"

namespace vdbmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kReach = 100;        // [m] from the map, that a space of it may lie
constexpr double kShownHeight = 1.5;  // [m] of the boxes that are shown
constexpr std::size_t kFewestCorners = 3;

// A reason why a file cannot be used, without its name.
[[noreturn]] void fail(const std::string& reason) { throw std::invalid_argument(reason); }

// Coordinates of a file as places of the map.
class FilePlaces {
 public:
  FilePlaces(const Json& collection, const SpacesPlace& place) : place_(place) {
    if (!place.frame.epsg) return;
    const std::string code = std::to_string(*place.frame.epsg);
    if (!collection.contains("crs")) {
      transform_.emplace(*place.frame.epsg, place.geoid_offset);
      return;
    }
    const std::string name = collection.at("crs").at("properties").at("name").get<std::string>();
    const std::size_t colon = name.rfind(':');
    if (colon != std::string::npos && name.substr(colon + 1) == code) return;
    fail("is in " + vdbmap::quoted(name) + ", expected WGS 84 or EPSG:" + code);
  }

  Eigen::Vector3d local(const Json& position) const {
    Eigen::Vector3d point(position.at(0).get<double>(), position.at(1).get<double>(), 0);
    if (position.size() > 2) point.z() = position.at(2).get<double>();
    if (!point.allFinite()) fail("has a corner that is not finite");
    if (transform_) point = transform_->from_wgs84(point);
    Eigen::Vector3d local = point - place_.frame.anchor;
    if (position.size() < 3) local.z() = place_.bounds.min().z();
    return local;
  }

 private:
  const SpacesPlace& place_;
  std::optional<GeodeticTransform> transform_;
};

double area_of(const std::vector<Eigen::Vector3d>& outline) {
  double twice = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector3d& a = outline[i];
    const Eigen::Vector3d& b = outline[(i + 1) % outline.size()];
    twice += a.x() * b.y() - b.x() * a.y();
  }
  return twice / 2;
}

std::vector<Eigen::Vector3d> outline_of(const Json& geometry, const FilePlaces& places) {
  if (geometry.at("type") != "Polygon") fail("is no polygon");
  std::vector<Eigen::Vector3d> outline;
  for (const Json& position : geometry.at("coordinates").at(0)) outline.push_back(places.local(position));
  if (outline.size() > 1 && (outline.front() - outline.back()).head<2>().norm() < 1e-6) outline.pop_back();
  if (outline.size() < kFewestCorners) fail("has an outline of less than three corners");
  if (area_of(outline) < 0) std::ranges::reverse(outline);
  return outline;
}

std::string id_of(const Json& properties) {
  const Json& id = properties.at("id");
  return id.is_string() ? id.get<std::string>() : id.dump();
}

std::string checked_state(const Json& state) {
  const std::string text = state.get<std::string>();
  if (text != "occupied" && text != "vacant" && text != "unknown") {
    fail("has the state " + vdbmap::quoted(text) + ", expected occupied, vacant or unknown");
  }
  return text;
}

bool has(const Json& properties, const char* name) { return properties.contains(name) && !properties[name].is_null(); }

double number_or_zero(const Json& properties, const char* name) {
  return has(properties, name) ? properties[name].get<double>() : 0;
}

SpaceState state_of(const Json& properties) {
  SpaceState state{"unknown", std::nullopt, number_or_zero(properties, "confidence"),
                   number_or_zero(properties, "vehicle_points"), number_or_zero(properties, "rays_through")};
  if (has(properties, "state")) {
    state.state = checked_state(properties["state"]);
  } else if (has(properties, "history") && !properties["history"].empty()) {
    state.state = checked_state(properties["history"].back().at("state"));
  }
  if (has(properties, "previous_state")) state.previous_state = checked_state(properties["previous_state"]);
  return state;
}

SiteSpace space_of(const Json& feature, const FilePlaces& places) {
  const Json& properties = feature.at("properties");
  SiteSpace space;
  space.id = id_of(properties);
  space.outline = outline_of(feature.at("geometry"), places);
  space.length = number_or_zero(properties, "length");
  space.width = number_or_zero(properties, "width");
  space.heading_deg = number_or_zero(properties, "heading") * 180 / std::numbers::pi;
  if (has(properties, "kerb_side")) space.kerb_side = properties["kerb_side"].get<std::string>();
  space.is_candidate = has(properties, "candidate") && properties["candidate"].get<bool>();
  space.state = state_of(properties);
  return space;
}

std::string date_of(const Json& feature) {
  const Json& properties = feature.at("properties");
  if (has(properties, "date")) return properties["date"].get<std::string>();
  if (has(properties, "history") && !properties["history"].empty()) {
    const Json& last = properties["history"].back();
    if (has(last, "date")) return last["date"].get<std::string>();
  }
  return "";
}

// [m] in the plan.
double distance_of(const SiteSpace& space, const Eigen::AlignedBox3d& bounds) {
  const Eigen::AlignedBox2d plan(bounds.min().head<2>(), bounds.max().head<2>());
  double distance = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& corner : space.outline) {
    distance = std::min(distance, plan.exteriorDistance(Eigen::Vector2d(corner.head<2>())));
  }
  return distance;
}

void check_place(const std::vector<SiteSpace>& spaces, const Eigen::AlignedBox3d& bounds) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const SiteSpace& space : spaces) nearest = std::min(nearest, distance_of(space, bounds));
  if (spaces.empty() || nearest <= kReach) return;
  fail("has spaces of another place: the nearest is " + std::to_string(std::lround(nearest / 1000)) +
       " km from the map");
}

Json parse(const std::filesystem::path& path) {
  ByteReader file(path);
  Json collection = Json::parse(without_byte_order_mark(file.all()), nullptr, /*allow_exceptions=*/false);
  const bool is_collection = collection.is_object() && collection.contains("type") &&
                             collection["type"] == "FeatureCollection" && collection.contains("features") &&
                             collection["features"].is_array();
  if (!is_collection) throw IoError::malformed(path, "is no GeoJSON of features");
  return collection;
}

EpochSpaces spaces_of(const Json& collection, const SpacesPlace& place) {
  const FilePlaces places(collection, place);
  EpochSpaces epoch;
  std::set<std::string> ids;
  std::size_t number = 0;
  for (const Json& feature : collection["features"]) {
    ++number;
    try {
      epoch.spaces.push_back(space_of(feature, places));
      if (!ids.insert(epoch.spaces.back().id).second) fail("has the id of another");
      if (epoch.date.empty()) epoch.date = date_of(feature);
    } catch (const Json::exception& error) {
      fail("feature " + std::to_string(number) + " is no space: " + error.what());
    } catch (const std::invalid_argument& error) {
      fail("feature " + std::to_string(number) + " " + error.what());
    }
  }
  check_place(epoch.spaces, place.bounds);
  return epoch;
}

Json position_json(const Eigen::Vector3d& point) {
  constexpr double kMillimetres = 1000;
  Json json = Json::array();
  for (const double value : point) json.push_back(std::round(value * kMillimetres) / kMillimetres);
  return json;
}

Json json_of_space(const SiteSpace& space) {
  Json polygon = Json::array();
  for (const Eigen::Vector3d& corner : space.outline) polygon.push_back(position_json(corner));
  Json json = {{"id", space.id},
               {"polygon", std::move(polygon)},
               {"height", kShownHeight},
               {"length", space.length},
               {"width", space.width},
               {"heading_deg", space.heading_deg},
               {"candidate", space.is_candidate}};
  if (!space.kerb_side.empty()) json["kerb_side"] = space.kerb_side;
  json["states"] = Json::array();
  return json;
}

Json json_of_state(const SpaceState& state, const std::string& epoch) {
  Json json = {{"epoch", epoch},
               {"state", state.state},
               {"confidence", state.confidence},
               {"vehicle_points", state.vehicle_points},
               {"rays_through", state.rays_through}};
  if (state.previous_state) json["previous_state"] = *state.previous_state;
  return json;
}

}  // namespace

EpochSpaces read_site_spaces(const std::filesystem::path& path, const SpacesPlace& place) {
  const Json collection = parse(path);
  try {
    return spaces_of(collection, place);
  } catch (const Json::exception& error) {
    throw IoError::malformed(path, std::string("is no GeoJSON of spaces: ") + error.what());
  } catch (const std::invalid_argument& error) {
    throw IoError::malformed(path, error.what());
  }
}

std::string spaces_json(const std::vector<std::pair<std::string, EpochSpaces>>& epochs) {
  std::map<std::string, Json> states;
  std::vector<const SiteSpace*> spaces;  // in the order in which they come first, each as it came last
  std::map<std::string, std::size_t> places;
  Json ids = Json::array();
  for (const auto& [id, epoch] : epochs) {
    ids.push_back(id);
    for (const SiteSpace& space : epoch.spaces) {
      const auto [place, is_new] = places.emplace(space.id, spaces.size());
      if (is_new) spaces.push_back(nullptr);
      spaces[place->second] = &space;
      states[space.id].push_back(json_of_state(space.state, id));
    }
  }
  Json list = Json::array();
  for (const SiteSpace* space : spaces) {
    Json json = json_of_space(*space);
    json["states"] = std::move(states[space->id]);
    list.push_back(std::move(json));
  }
  const Json json = {{"epochs", std::move(ids)}, {"spaces", std::move(list)}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace vdbmap

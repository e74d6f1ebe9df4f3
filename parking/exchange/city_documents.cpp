// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/exchange/city_documents.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "parking/exchange/geo_frame.h"
#include "parking/exchange/name_uuid.h"
#include "parking/spaces/iso_date.h"
#include "parking/spaces/kerb_rows.h"
#include "parking/spaces/outline.h"

namespace vdbmap::parking {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kSameZone = 60;  // [m] from a space to the next
constexpr const char* kCurbVersion = "1.0.0";

// Spaces of one kerb side.
struct CurbZone {
  std::vector<std::size_t> spaces;
  std::string id;
};

std::int64_t centimetres(double metres) { return std::llround(metres * 100); }

std::string city_of(const OccupancyRecord& record, const CityOptions& options) {
  return options.city.empty() ? record.place : options.city;
}

std::string uuid_in_city(const std::string& city, const std::string& kind, const std::string& name) {
  return uuid_of_name("urn:vdbmap:" + city + ":" + kind + ":" + name);
}

std::int64_t time_of_epoch(const OccupancyRecord& record) {
  if (const auto time = milliseconds_of(record.date)) return *time;
  throw std::invalid_argument("a Curb Data Specification document needs the date of the epoch");
}

// When a space was first known.
std::int64_t first_time(const ParkingSpace& space, std::int64_t now) {
  for (const PastState& past : space.history) {
    if (const auto time = milliseconds_of(past.date)) return std::min(*time, now);
  }
  return now;
}

// Zones in the order of their first spaces; spaces in each by their place along it.
std::vector<CurbZone> zones_of(const std::vector<ParkingSpace>& spaces, const std::string& city) {
  std::vector<Eigen::Vector2d> middles;
  for (const ParkingSpace& space : spaces) middles.push_back(middle_of(space));
  std::vector<bool> is_placed(spaces.size(), false);
  std::vector<CurbZone> zones;
  for (std::size_t first = 0; first < spaces.size(); ++first) {
    if (is_placed[first] || spaces[first].is_candidate) continue;
    CurbZone zone{{first}, ""};
    is_placed[first] = true;
    for (std::size_t next = 0; next < zone.spaces.size(); ++next) {
      const std::size_t from = zone.spaces[next];
      for (std::size_t i = 0; i < spaces.size(); ++i) {
        if (is_placed[i] || spaces[i].is_candidate || spaces[i].kerb_side != spaces[first].kerb_side) continue;
        if ((middles[i] - middles[from]).norm() > kSameZone) continue;
        zone.spaces.push_back(i);
        is_placed[i] = true;
      }
    }
    std::ranges::sort(zone.spaces);
    zone.id = uuid_in_city(city, "zone", spaces[zone.spaces.front()].id);
    zones.push_back(std::move(zone));
  }
  return zones;
}

std::vector<Eigen::Vector2d> outline_of(const CurbZone& zone, const std::vector<ParkingSpace>& spaces) {
  std::vector<Eigen::Vector2d> corners;
  for (const std::size_t i : zone.spaces) {
    corners.insert(corners.end(), spaces[i].outline.begin(), spaces[i].outline.end());
  }
  return convex_hull(std::move(corners));
}

bool is_compass(const std::string& side) {
  static constexpr std::array kSides = {"N", "NE", "E", "SE", "S", "SW", "W", "NW"};
  return std::ranges::find(kSides, side) != kSides.end();
}

Json json_of_zone(const CurbZone& zone, const OccupancyRecord& record, const GeoFrame& geo, const std::string& city,
                  std::int64_t now) {
  const std::vector<Eigen::Vector2d> outline = outline_of(zone, record.spaces);
  const ParkingSpace around = space_of_outline(outline);
  std::int64_t first = now;
  Json ids = Json::array(), lengths = Json::array();
  bool has_one_angle = true, is_known = true;
  const ParkingSpace& some = record.spaces[zone.spaces.front()];
  for (const std::size_t i : zone.spaces) {
    const ParkingSpace& space = record.spaces[i];
    first = std::min(first, first_time(space, now));
    ids.push_back(uuid_in_city(city, "space", space.id));
    if (record.states[i].state == SpaceState::kVacant) lengths.push_back(centimetres(space.length));
    is_known = is_known && record.states[i].state != SpaceState::kUnknown;
    has_one_angle = has_one_angle && space.angle == some.angle;
  }
  Json json = {{"curb_zone_id", zone.id},
               {"geometry", geo.polygon(outline, std::nullopt)},
               {"curb_policy_ids", Json::array()},
               {"published_date", first},
               {"last_updated_date", now},
               {"start_date", first},
               {"length", centimetres(around.length)},
               {"width", centimetres(around.width)},
               {"num_spaces", zone.spaces.size()},
               {"curb_space_ids", std::move(ids)}};
  if (is_compass(some.kerb_side)) json["street_side"] = some.kerb_side;
  if (has_one_angle && some.angle != ParkingAngle::kUnknown) json["parking_angle"] = text_of(some.angle);
  if (is_known) {
    json["available_space_lengths"] = std::move(lengths);
    json["availability_time"] = now;
  }
  return json;
}

Json json_of_space(std::size_t i, std::size_t number, const CurbZone& zone, const OccupancyRecord& record,
                   const GeoFrame& geo, const std::string& city, std::int64_t now) {
  const ParkingSpace& space = record.spaces[i];
  Json json = {{"curb_space_id", uuid_in_city(city, "space", space.id)},
               {"geometry", geo.polygon(space.outline, std::nullopt)},
               {"name", space.id},
               {"published_date", first_time(space, now)},
               {"last_updated_date", now},
               {"curb_zone_id", zone.id},
               {"space_number", number},
               {"length", centimetres(space.length)},
               {"width", centimetres(space.width)}};
  if (record.states[i].state != SpaceState::kUnknown) {
    json["available"] = record.states[i].state == SpaceState::kVacant;
    json["availability_time"] = now;
  }
  return json;
}

GeoFrame globe_of(const OccupancyRecord& record, const CityOptions& options, const std::string& what) {
  if (!record.frame.epsg) throw std::invalid_argument(what + " needs a map with an EPSG code");
  return {record.frame, {.geoid_offset = options.geoid_offset}};
}

// A part of an id: what may not be in it becomes '_'.
std::string id_part(std::string text) {
  for (char& c : text) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '.' && c != '_') c = '_';
  }
  return text;
}

const char* fiware_status(SpaceState state) {
  switch (state) {
    case SpaceState::kOccupied:
      return "occupied";
    case SpaceState::kVacant:
      return "free";
    case SpaceState::kUnknown:
      break;
  }
  return "unknown";
}

}  // namespace

Json curb_data_of(const OccupancyRecord& record, const CityOptions& options) {
  const GeoFrame geo = globe_of(record, options, "a Curb Data Specification document");
  const std::int64_t now = time_of_epoch(record);
  const std::string city = city_of(record, options);
  Json zones = Json::array(), spaces = Json::array();
  for (const CurbZone& zone : zones_of(record.spaces, city)) {
    zones.push_back(json_of_zone(zone, record, geo, city, now));
    std::size_t number = 0;
    for (const std::size_t i : zone.spaces) spaces.push_back(json_of_space(i, ++number, zone, record, geo, city, now));
  }
  return {{"version", kCurbVersion}, {"time_zone", options.time_zone},
          {"last_updated", now},     {"currency", "EUR"},
          {"author", city},          {"data", {{"zones", std::move(zones)}, {"spaces", std::move(spaces)}}}};
}

Json fiware_of(const OccupancyRecord& record, const CityOptions& options) {
  const GeoFrame geo = globe_of(record, options, "a FIWARE document");
  const std::string city = id_part(city_of(record, options));
  Json entities = Json::array();
  for (std::size_t i = 0; i < record.spaces.size(); ++i) {
    const ParkingSpace& space = record.spaces[i];
    if (space.is_candidate) continue;
    Json entity = {{"id", "urn:ngsi-ld:ParkingSpot:" + city + ":" + id_part(space.id)},
                   {"type", "ParkingSpot"},
                   {"name", space.id},
                   {"category", {"onStreet"}},
                   {"status", fiware_status(record.states[i].state)},
                   {"location", geo.polygon(space.outline, std::nullopt)},
                   {"length", std::round(space.length * 1e3) / 1e3},
                   {"width", std::round(space.width * 1e3) / 1e3},
                   {"refParkingSite", "urn:ngsi-ld:OnStreetParking:" + city}};
    if (const auto time = milliseconds_of(record.date)) entity["TimeInstant"] = date_of_seconds(*time / 1000);
    entity["@context"] = {"https://smartdatamodels.org/context.jsonld",
                          "https://uri.etsi.org/ngsi-ld/v1/ngsi-ld-core-context.jsonld"};
    entities.push_back(std::move(entity));
  }
  return entities;
}

}  // namespace vdbmap::parking

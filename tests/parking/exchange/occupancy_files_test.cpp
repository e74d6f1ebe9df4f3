// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/exchange/occupancy_files.h"

#include <cmath>
#include <fstream>
#include <regex>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "parking/exchange/city_documents.h"
#include "parking/exchange/name_uuid.h"
#include "parking/spaces/outline.h"
#include "tests/support/folders.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/geodesy/geodetic_transform.h"

namespace vdbmap::parking {
namespace {

using Json = nlohmann::ordered_json;
using Outline = std::vector<Eigen::Vector2d>;

const MapFrame kHannover = {{548864, 5804032, 0}, 25832};

// Six spaces on two sides of a road, of all states, one of them a candidate.
OccupancyRecord sample_record() {
  OccupancyRecord record;
  record.place = "Hannover, Nordstadt";
  record.date = "2023-03-02";
  record.frame = kHannover;
  const SpaceState states[] = {SpaceState::kOccupied, SpaceState::kVacant, SpaceState::kUnknown};
  for (int i = 0; i < 6; ++i) {
    const double x = 6.0 * (i % 3), y = i < 3 ? 8 : 0;
    ParkingSpace space = space_of_outline({{x, y}, {x + 5.555, y}, {x + 5.555, y + 2}, {x, y + 2}});
    space.id = i == 5 ? "5,\"b\"" : std::to_string(i);
    space.ground = 54.25;
    space.kerb_side = i < 3 ? "N" : "S";
    space.angle = ParkingAngle::kParallel;
    space.is_candidate = i == 4;
    space.history = {{"2023-03-01", SpaceState::kOccupied}};
    SpaceOccupancy state;
    state.state = states[i % 3];
    state.previous = SpaceState::kOccupied;
    state.confidence = 0.75;
    state.evidence.num_columns = 44;
    state.evidence.vehicle_points = 12;
    state.evidence.neighbor_points = 2;
    state.evidence.rays_through = 7;
    if (i == 0) state.occupant = Occupant::kVehicle;
    if (i == 3) state.occupant = Occupant::kThing;
    state.evidence.thing_points = i == 3 ? 31 : 0;
    record.spaces.push_back(std::move(space));
    record.states.push_back(state);
  }
  return record;
}

std::vector<ParkingSpace> read_text(const std::string& text, const MapFrame& frame = kHannover) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "spaces.geojson";
  std::ofstream(path) << text;
  return read_spaces(path, frame);
}

std::string complaint_about(const std::string& text, const MapFrame& frame = kHannover) {
  try {
    read_text(text, frame);
  } catch (const IoError& error) {
    EXPECT_EQ(error.kind(), IoError::Kind::kMalformed);
    return error.what();
  }
  return "";
}

std::string one_feature(const std::string& geometry, const std::string& crs = "EPSG:25832") {
  return R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":")" + crs +
         R"("}},"features":[{"type":"Feature","properties":{"id":7},"geometry":)" + geometry + "}]}";
}

const std::string kSquare =
    R"({"type":"Polygon","coordinates":[[[548864,5804032],[548869,5804032],[548869,5804034],[548864,5804034],[548864,5804032]]]})";

TEST(SpacesFile, IsReadAsItWasWritten) {
  const OccupancyRecord record = sample_record();
  for (const GeoCoordinates coordinates : {GeoCoordinates::kWgs84, GeoCoordinates::kMap}) {
    const std::vector<ParkingSpace> spaces =
        read_text(geojson_of(record.spaces, kHannover, {.coordinates = coordinates}));
    ASSERT_EQ(spaces.size(), record.spaces.size());
    for (std::size_t i = 0; i < spaces.size(); ++i) {
      const ParkingSpace &read = spaces[i], &written = record.spaces[i];
      EXPECT_EQ(read.id, written.id);
      EXPECT_EQ(read.kerb_side, written.kerb_side);
      EXPECT_EQ(read.angle, written.angle);
      EXPECT_EQ(read.is_candidate, written.is_candidate);
      ASSERT_EQ(read.history.size(), 1U);
      EXPECT_EQ(read.history[0].date, "2023-03-01");
      EXPECT_NEAR(*read.ground, 54.25, 2e-4);
      ASSERT_EQ(read.outline.size(), 4U);
      for (std::size_t k = 0; k < 4; ++k) EXPECT_LT((read.outline[k] - written.outline[k]).norm(), 3e-4);
    }
  }
}

// RFC 7946: longitude first, rings closed and against the clock.
TEST(SpacesFile, PutsSpacesOnTheGlobe) {
  const Json json = Json::parse(geojson_of(sample_record().spaces, kHannover));
  EXPECT_FALSE(json.contains("crs"));
  const Json ring = json["features"][0]["geometry"]["coordinates"][0];
  ASSERT_EQ(ring.size(), 5U);
  EXPECT_EQ(ring.front(), ring.back());
  const Eigen::Vector3d corner = GeodeticTransform(25832).to_wgs84({548864, 5804040, 54.25});
  for (int axis = 0; axis < 2; ++axis) {
    EXPECT_NEAR(ring[0][static_cast<std::size_t>(axis)].get<double>(), corner[axis], 1e-9);
  }
  Outline outline;
  for (const Json& place : ring)
    outline.emplace_back(1e5 * (place[0].get<double>() - 9.7), 1e5 * (place[1].get<double>() - 52.3));
  EXPECT_GT(signed_area(outline), 0);
}

TEST(SpacesFile, TurnsOutlinesAgainstTheClock) {
  const std::string clockwise =
      R"({"type":"Polygon","coordinates":[[[548864,5804032],[548864,5804034],[548869,5804034],[548869,5804032]]]})";
  EXPECT_GT(signed_area(read_text(one_feature(clockwise))[0].outline), 0);
  EXPECT_EQ(read_text(one_feature(clockwise))[0].id, "7");
  EXPECT_FALSE(read_text(one_feature(clockwise))[0].ground);
}

TEST(SpacesFile, SaysWhatIsWrong) {
  const auto polygon = [](const std::string& ring) { return R"({"type":"Polygon","coordinates":[[)" + ring + "]]}"; };
  EXPECT_NE(complaint_about("{").find("is no JSON"), std::string::npos);
  EXPECT_NE(complaint_about("[]").find("FeatureCollection"), std::string::npos);
  EXPECT_NE(complaint_about(R"({"type":"FeatureCollection","features":[3]})").find("feature 1 is no Feature"),
            std::string::npos);
  EXPECT_NE(complaint_about(one_feature("null")).find("without geometry"), std::string::npos);
  EXPECT_NE(complaint_about(one_feature(R"({"type":"Point","coordinates":[1,2]})")).find("a Point, expected a Polygon"),
            std::string::npos);
  EXPECT_NE(complaint_about(one_feature(polygon("[0,0],[4,2],[4,0],[0,2]"))).find("feature 1 ('7') crosses itself"),
            std::string::npos);
  EXPECT_NE(complaint_about(one_feature(polygon("[0,0],[1,1]"))).find("2 different corners"), std::string::npos);
  EXPECT_NE(complaint_about(one_feature(polygon("[0,0],[1,\"a\"],[2,0]"))).find("no list of 2 or 3 numbers"),
            std::string::npos);
  const std::string two = one_feature(kSquare);
  const std::string feature =
      two.substr(two.find("{\"type\":\"Feature\""), two.rfind("]}") - two.find("{\"type\":\"Feature\""));
  EXPECT_NE(complaint_about(two.substr(0, two.rfind("]}")) + "," + feature + "]}").find("has the id of feature 1"),
            std::string::npos);
}

TEST(SpacesFile, RefusesOtherReferenceSystems) {
  EXPECT_EQ(complaint_about(one_feature(kSquare)), "");
  EXPECT_NE(
      complaint_about(one_feature(kSquare, "urn:ogc:def:crs:EPSG::25833")).find("EPSG:25833, the map's in EPSG:25832"),
      std::string::npos);
  EXPECT_NE(complaint_about(one_feature(kSquare, "somewhere")).find("'crs' is 'somewhere'"), std::string::npos);
  std::string without = one_feature(kSquare);
  without.erase(without.find("\"crs\""), without.find("\"features\"") - without.find("\"crs\""));
  EXPECT_NE(complaint_about(without).find("is no longitude and latitude"), std::string::npos);
  EXPECT_EQ(complaint_about(without, {kHannover.anchor, std::nullopt}), "");
  EXPECT_NE(complaint_about(one_feature(kSquare, "urn:ogc:def:crs:OGC:1.3:CRS84"), {kHannover.anchor, std::nullopt})
                .find("no EPSG code"),
            std::string::npos);
}

TEST(OccupancyFiles, GeoJsonHasTheNamesThatProgramsLookFor) {
  const OccupancyRecord record = sample_record();
  const Json json = Json::parse(geojson_of(record));
  ASSERT_EQ(json["features"].size(), 6U);
  const Json properties = json["features"][0]["properties"];
  EXPECT_EQ(properties["id"], "0");
  EXPECT_EQ(properties["state"], "occupied");
  EXPECT_EQ(properties["previous_state"], "occupied");
  EXPECT_EQ(properties["confidence"], 0.75);
  EXPECT_EQ(properties["vehicle_points"], 10);
  EXPECT_EQ(properties["rays_through"], 7);
  EXPECT_EQ(properties["occupied_by"], "vehicle");
  EXPECT_EQ(properties["thing_points"], 0);
  EXPECT_TRUE(json["features"][1]["properties"]["occupied_by"].is_null());
  EXPECT_EQ(json["features"][3]["properties"]["occupied_by"], "thing");
  EXPECT_EQ(json["features"][3]["properties"]["thing_points"], 31);
  EXPECT_EQ(properties["length"], 5.555);
  EXPECT_EQ(properties["width"], 2.0);
  EXPECT_EQ(properties["heading"], 0.0);
  const std::vector<ParkingSpace> next = read_text(geojson_of(record));
  ASSERT_EQ(next[1].history.size(), 2U);
  EXPECT_EQ(next[1].history[1].state, SpaceState::kVacant);
  EXPECT_EQ(next[1].history[1].date, "2023-03-02");
}

TEST(OccupancyFiles, JsonCountsTheStreetWithoutCandidates) {
  const Json json = json_of(sample_record());
  EXPECT_EQ(json["spaces_counted"], 5);
  EXPECT_EQ(json["candidates"], 1);
  EXPECT_EQ(json["occupied"], 2);
  EXPECT_EQ(json["vacant"], 1);
  EXPECT_EQ(json["unknown"], 2);
  EXPECT_DOUBLE_EQ(json["occupancy"]["low"].get<double>(), 0.4);
  EXPECT_DOUBLE_EQ(json["occupancy"]["high"].get<double>(), 0.8);
  EXPECT_EQ(json["spaces"].size(), 6U);
  EXPECT_EQ(json["spaces"][3]["occupied_by"], "thing");
  EXPECT_TRUE(json["spaces"][2]["occupied_by"].is_null());
}

// Fields of a line as RFC 4180 has them.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  bool is_quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && is_quoted && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += line[++i];
    } else if (line[i] == '"') {
      is_quoted = !is_quoted;
    } else if (line[i] == ',' && !is_quoted) {
      fields.emplace_back();
    } else {
      fields.back() += line[i];
    }
  }
  return fields;
}

TEST(OccupancyFiles, TableHasALineASpaceWithAllItsFields) {
  std::istringstream text(csv_of(sample_record()));
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(text, line);) {
    ASSERT_EQ(line.back(), '\r');
    line.pop_back();
    rows.push_back(fields_of(line));
    EXPECT_EQ(rows.back().size(), rows.front().size());
  }
  ASSERT_EQ(rows.size(), 7U);
  EXPECT_EQ(rows[6][0], "5,\"b\"");
  EXPECT_EQ(rows[1][1], "occupied");
  EXPECT_EQ(rows[1][14], "548866.7775");
  EXPECT_EQ(rows[1][15], "5804041.0");
}

// By Python: uuid.uuid5(uuid.NAMESPACE_URL, "urn:vdbmap:Hannover:space:12").
TEST(NameUuid, IsThatOfVersion5) {
  EXPECT_EQ(uuid_of_name("urn:vdbmap:Hannover:space:12"), "1b84432f-d876-51cd-a032-9f1bc05f6b49");
}

const std::regex kUuid5("[0-9a-f]{8}-[0-9a-f]{4}-5[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}");
constexpr std::int64_t kFirstDay = 1677628800000, kSecondDay = 1677715200000;

Outline outline_of(const Json& geometry) {
  EXPECT_EQ(geometry["type"], "Polygon");
  const Json& ring = geometry["coordinates"][0];
  EXPECT_GE(ring.size(), 4U);
  EXPECT_EQ(ring.front(), ring.back());
  Outline outline;
  for (const Json& place : ring) {
    EXPECT_EQ(place.size(), 2U);
    EXPECT_LE(std::abs(place[0].get<double>()), 180);
    EXPECT_LE(std::abs(place[1].get<double>()), 90);
    outline.emplace_back(place[0].get<double>(), place[1].get<double>());
  }
  outline.pop_back();
  EXPECT_GT(signed_area(outline), 0);
  return outline;
}

// Fields that every object must have, of CDS 1.0's table for it, and all that it may have.
void expect_fields(const Json& object, const std::set<std::string>& required, std::set<std::string> allowed) {
  allowed.insert(required.begin(), required.end());
  for (const std::string& name : required) EXPECT_TRUE(object.contains(name)) << name;
  for (const auto& [name, value] : object.items()) EXPECT_TRUE(allowed.contains(name)) << name;
}

TEST(CurbData, FollowsTheSpecification) {
  const Json json = curb_data_of(sample_record(), {.city = "Hannover", .time_zone = "Europe/Berlin"});
  expect_fields(json, {"version", "time_zone", "last_updated", "currency", "data"}, {"author", "license_url"});
  EXPECT_EQ(json["last_updated"], kSecondDay);
  const Json &zones = json["data"]["zones"], &spaces = json["data"]["spaces"];
  ASSERT_EQ(zones.size(), 2U);
  ASSERT_EQ(spaces.size(), 5U);  // no candidate
  std::set<std::string> ids;
  for (const Json& zone : zones) {
    expect_fields(zone,
                  {"curb_zone_id", "geometry", "curb_policy_ids", "published_date", "last_updated_date", "start_date"},
                  {"length", "width", "num_spaces", "curb_space_ids", "street_side", "parking_angle",
                   "available_space_lengths", "availability_time"});
    EXPECT_TRUE(std::regex_match(zone["curb_zone_id"].get<std::string>(), kUuid5));
    EXPECT_TRUE(ids.insert(zone["curb_zone_id"]).second);
    EXPECT_TRUE(zone["curb_policy_ids"].is_array());
    EXPECT_EQ(zone["start_date"], kFirstDay);
    EXPECT_TRUE(zone["length"].is_number_integer() && zone["width"].is_number_integer());
    EXPECT_TRUE(zone["street_side"] == "N" || zone["street_side"] == "S");
    EXPECT_EQ(zone["parking_angle"], "parallel");
    EXPECT_EQ(zone["num_spaces"], zone["curb_space_ids"].size());
  }
  for (const Json& space : spaces) {
    expect_fields(space, {"curb_space_id", "geometry", "published_date", "last_updated_date", "curb_zone_id", "length"},
                  {"name", "space_number", "width", "available", "availability_time"});
    EXPECT_TRUE(std::regex_match(space["curb_space_id"].get<std::string>(), kUuid5));
    EXPECT_TRUE(ids.insert(space["curb_space_id"]).second);
    EXPECT_EQ(space["length"], 556);
    EXPECT_EQ(space["width"], 200);
    EXPECT_GE(space["space_number"].get<int>(), 1);
    const auto zone =
        std::ranges::find_if(zones, [&](const Json& z) { return z["curb_zone_id"] == space["curb_zone_id"]; });
    ASSERT_NE(zone, zones.end());
    EXPECT_EQ(std::ranges::count((*zone)["curb_space_ids"], space["curb_space_id"]), 1);
    const Outline inner = outline_of(space["geometry"]), outer = outline_of((*zone)["geometry"]);
    const Eigen::Vector2d middle = (inner[0] + inner[2]) / 2;
    for (const Eigen::Vector2d& corner : inner) EXPECT_TRUE(contains(outer, middle + 0.999 * (corner - middle)));
  }
  EXPECT_EQ(spaces[0]["available"], false);
  EXPECT_EQ(spaces[1]["available"], true);
  EXPECT_FALSE(spaces[2].contains("available"));  // unknown
}

TEST(CurbData, IdsAreThoseOfCityAndSpace) {
  OccupancyRecord later = sample_record();
  later.date = "2024-01-01";
  const CityOptions here{.city = "Hannover"}, elsewhere{.city = "Bremen"};
  const auto id = [](const Json& json) { return json["data"]["spaces"][1]["curb_space_id"]; };
  EXPECT_EQ(id(curb_data_of(sample_record(), here)), id(curb_data_of(later, here)));
  EXPECT_NE(id(curb_data_of(sample_record(), here)), id(curb_data_of(later, elsewhere)));
}

TEST(CurbData, NeedsAPlaceOnTheGlobeAndADate) {
  OccupancyRecord record = sample_record();
  record.date.clear();
  EXPECT_THROW(curb_data_of(record, {}), std::invalid_argument);
  record = sample_record();
  record.frame.epsg.reset();
  EXPECT_THROW(curb_data_of(record, {}), std::invalid_argument);
  EXPECT_THROW(fiware_of(record, {}), std::invalid_argument);
}

// The rules of the schema of ParkingSpot in Smart Data Models.
TEST(Fiware, FollowsTheSchemaOfParkingSpot) {
  const Json json = fiware_of(sample_record(), {});
  ASSERT_EQ(json.size(), 5U);
  const std::regex id_pattern(R"([\w\-.{}$+*\[\]`|~^@!,:\\]{1,256})");
  std::set<std::string> ids;
  const std::set<std::string> states = {"closed", "free", "occupied", "unknown"};
  for (const Json& spot : json) {
    for (const char* name : {"id", "location", "type", "status", "category", "refParkingSite"}) {
      EXPECT_TRUE(spot.contains(name)) << name;
    }
    EXPECT_EQ(spot["type"], "ParkingSpot");
    EXPECT_TRUE(std::regex_match(spot["id"].get<std::string>(), id_pattern)) << spot["id"];
    EXPECT_TRUE(std::regex_match(spot["refParkingSite"].get<std::string>(), id_pattern));
    EXPECT_TRUE(ids.insert(spot["id"]).second);
    EXPECT_TRUE(states.contains(spot["status"]));
    EXPECT_EQ(spot["category"], Json::array({"onStreet"}));
    EXPECT_GT(spot["length"].get<double>(), 0);
    EXPECT_GT(spot["width"].get<double>(), 0);
    EXPECT_TRUE(
        std::regex_match(spot["TimeInstant"].get<std::string>(), std::regex(R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ)")));
    outline_of(spot["location"]);
  }
  EXPECT_EQ(json[0]["status"], "occupied");
  EXPECT_EQ(json[1]["status"], "free");
  EXPECT_EQ(json[2]["status"], "unknown");
}

}  // namespace
}  // namespace vdbmap::parking

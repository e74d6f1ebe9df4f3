// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/exchange/spaces_file.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include <nlohmann/json.hpp>

#include "parking/exchange/geo_frame.h"
#include "parking/exchange/space_properties.h"
#include "parking/spaces/outline.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/file/text.h"

namespace vdbmap::parking {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kWgs84Code = 4326;
constexpr double kSamePlace = 1e-9;  // of two corners, in units of the file

Json parse(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError::system(path, "cannot open", errno);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (file.bad()) throw IoError::system(path, "cannot read", errno);
  try {
    return Json::parse(without_byte_order_mark(text));
  } catch (const Json::parse_error& error) {
    throw IoError::malformed_at_byte(path, error.byte > 0 ? error.byte - 1 : 0, "is no JSON");
  }
}

std::string text_in(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

// The EPSG code that "crs" names; 4326 stands for WGS 84 by whatever name; nothing without "crs".
std::optional<int> code_of_crs(const Json& collection, const std::filesystem::path& path) {
  const auto crs = collection.find("crs");
  if (crs == collection.end() || crs->is_null()) return std::nullopt;
  const auto properties = crs->is_object() ? crs->find("properties") : crs->end();
  const std::string name =
      crs->is_object() && properties != crs->end() && properties->is_object() ? text_in(*properties, "name") : "";
  if (name.ends_with("CRS84")) return kWgs84Code;
  const std::size_t colon = name.find_last_of(':');
  const auto code = name.find("EPSG") == std::string::npos || colon == std::string::npos
                        ? std::nullopt
                        : parse_count(std::string_view(name).substr(colon + 1));
  if (!code || *code > 1'000'000) {
    throw IoError::malformed(path, "its 'crs' is " + vdbmap::quoted(name) + ", expected a name with an EPSG code");
  }
  return static_cast<int>(*code);
}

// Places corners in the map's local frame.
class CornerFrame {
 public:
  CornerFrame(const Json& collection, const std::filesystem::path& path, const MapFrame& frame,
              const GeoOptions& options)
      : path_(path), anchor_(frame.anchor) {
    const std::optional<int> code = code_of_crs(collection, path);
    const bool is_maps_own = code ? code == frame.epsg : !frame.epsg;
    if (is_maps_own) return;
    if (code.value_or(kWgs84Code) != kWgs84Code) {
      throw IoError::malformed(path, "its coordinates are in EPSG:" + std::to_string(*code) + ", the map's in " +
                                         (frame.epsg ? "EPSG:" + std::to_string(*frame.epsg) : "no known system"));
    }
    if (!frame.epsg) {
      throw IoError::malformed(path, "its coordinates are in WGS 84, and the map has no EPSG code to place them by");
    }
    transform_.emplace(*frame.epsg, options.geoid_offset);
  }

  Eigen::Vector3d local_of(const Eigen::Vector3d& corner, const std::string& feature) const {
    if (!transform_) return corner - anchor_;
    if (std::abs(corner.x()) > 180 || std::abs(corner.y()) > 90) {
      throw IoError::malformed(path_, feature + ": " + std::to_string(corner.x()) + ", " + std::to_string(corner.y()) +
                                          " is no longitude and latitude, and no 'crs' says what else it is");
    }
    try {
      return transform_->from_wgs84(corner) - anchor_;
    } catch (const std::invalid_argument& error) {
      throw IoError::malformed(path_, feature + ": " + error.what());
    }
  }

 private:
  std::filesystem::path path_;
  Eigen::Vector3d anchor_;
  std::optional<GeodeticTransform> transform_;
};

std::string id_of(const Json& feature, const Json& properties, std::size_t number) {
  for (const Json* object : {&properties, &feature}) {
    const auto found = object->find("id");
    if (found == object->end()) continue;
    if (found->is_string() && !found->get<std::string>().empty()) return found->get<std::string>();
    if (found->is_number_integer()) return std::to_string(found->get<std::int64_t>());
  }
  return std::to_string(number);
}

// Reads one feature.
class FeatureReader {
 public:
  FeatureReader(const std::filesystem::path& path, const CornerFrame& frame) : path_(path), frame_(frame) {}

  ParkingSpace read(const Json& feature, std::size_t number) {
    name_ = "feature " + std::to_string(number);
    if (!feature.is_object() || text_in(feature, "type") != "Feature") fail("is no Feature");
    static const Json kNothing = Json::object();
    const auto found = feature.find("properties");
    const Json& properties = found != feature.end() && found->is_object() ? *found : kNothing;
    const std::string id = id_of(feature, properties, number);
    name_ += " (" + vdbmap::quoted(id) + ")";
    ParkingSpace space = outline_of(feature);
    space.id = id;
    read_properties(properties, space);
    return space;
  }

  [[noreturn]] void fail(const std::string& reason) const { throw IoError::malformed(path_, name_ + " " + reason); }

 private:
  ParkingSpace outline_of(const Json& feature) {
    const auto geometry = feature.find("geometry");
    const std::string type = geometry != feature.end() && geometry->is_object() ? text_in(*geometry, "type") : "";
    if (type != "Polygon")
      fail("is " + (type.empty() ? "without geometry" : "a " + printable(type)) + ", expected a Polygon");
    const auto rings = geometry->find("coordinates");
    if (rings == geometry->end() || !rings->is_array() || rings->empty() || !rings->front().is_array()) {
      fail("has no coordinates");
    }
    if (rings->size() > 1) fail("has holes");
    const std::vector<Eigen::Vector3d> corners = corners_of(rings->front());
    std::vector<Eigen::Vector2d> outline;
    double height = 0;
    for (const Eigen::Vector3d& corner : corners) {
      const Eigen::Vector3d local = frame_.local_of(corner, name_);
      outline.emplace_back(local.head<2>());
      height += local.z() / static_cast<double>(corners.size());
    }
    const std::string problem = problem_of_outline(outline);
    if (!problem.empty()) fail(problem);
    if (signed_area(outline) < 0) std::ranges::reverse(outline);
    ParkingSpace space = space_of_outline(std::move(outline));
    if (has_heights_) space.ground = height;
    return space;
  }

  // Without the last where it is the first again, as it should be.
  std::vector<Eigen::Vector3d> corners_of(const Json& ring) {
    std::vector<Eigen::Vector3d> corners;
    has_heights_ = true;
    for (const Json& place : ring) {
      const bool is_place = place.is_array() && (place.size() == 2 || place.size() == 3) &&
                            std::ranges::all_of(place, [](const Json& value) { return value.is_number(); });
      if (!is_place) fail("has a corner that is no list of 2 or 3 numbers");
      has_heights_ = has_heights_ && place.size() == 3;
      corners.emplace_back(place[0].get<double>(), place[1].get<double>(),
                           place.size() == 3 ? place[2].get<double>() : 0);
      if (!corners.back().allFinite()) fail("has a corner that is not finite");
    }
    const bool is_closed =
        corners.size() > 1 && (corners.front() - corners.back()).head<2>().cwiseAbs().maxCoeff() <= kSamePlace;
    if (is_closed) corners.pop_back();
    return corners;
  }

  void read_properties(const Json& properties, ParkingSpace& space) const {
    for (const char* key : {"kerb_side", "side"}) {
      if (space.kerb_side.empty()) space.kerb_side = text_in(properties, key);
    }
    for (const char* key : {"angle", "kind"}) {
      if (space.angle != ParkingAngle::kUnknown) continue;
      space.angle = parking_angle_of(text_in(properties, key)).value_or(ParkingAngle::kUnknown);
    }
    const auto candidate = properties.find("candidate");
    space.is_candidate = candidate != properties.end() && candidate->is_boolean() && candidate->get<bool>();
    const auto history = properties.find("history");
    if (history == properties.end() || history->is_null()) return;
    if (!history->is_array()) fail("has a history that is no list");
    for (const Json& past : *history) {
      const auto state = past.is_object() ? space_state_of(text_in(past, "state")) : std::nullopt;
      if (!state) fail("has a history with a state that is none of occupied, vacant, unknown");
      space.history.push_back({text_in(past, "date"), *state});
    }
  }

  const std::filesystem::path& path_;
  const CornerFrame& frame_;
  std::string name_;
  bool has_heights_ = false;
};

}  // namespace

std::vector<ParkingSpace> read_spaces(const std::filesystem::path& path, const MapFrame& frame,
                                      const GeoOptions& options) {
  const Json json = parse(path);
  const auto features = json.is_object() ? json.find("features") : json.end();
  if (!json.is_object() || text_in(json, "type") != "FeatureCollection" || features == json.end() ||
      !features->is_array()) {
    throw IoError::malformed(path, "is no GeoJSON FeatureCollection");
  }
  const CornerFrame corners(json, path, frame, options);
  FeatureReader reader(path, corners);
  std::vector<ParkingSpace> spaces;
  std::map<std::string, std::size_t> numbers;
  for (const Json& feature : *features) {
    spaces.push_back(reader.read(feature, spaces.size() + 1));
    const auto [first, is_new] = numbers.emplace(spaces.back().id, spaces.size());
    if (!is_new) reader.fail("has the id of feature " + std::to_string(first->second));
  }
  return spaces;
}

std::string geojson_of(std::span<const ParkingSpace> spaces, const MapFrame& frame, const GeoOptions& options) {
  const GeoFrame geo(frame, options);
  Json features = Json::array();
  for (const ParkingSpace& space : spaces) {
    features.push_back({{"type", "Feature"},
                        {"geometry", geo.polygon(space.outline, space.ground)},
                        {"properties", properties_of(space)}});
  }
  return text_of_collection(std::move(features), geo);
}

}  // namespace vdbmap::parking

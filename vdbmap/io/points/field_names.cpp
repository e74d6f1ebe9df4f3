// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/points/field_names.h"

#include <cctype>
#include <string>
#include <unordered_map>

#include "vdbmap/io/file/text.h"

namespace vdbmap {
namespace {

constexpr auto kPoints = CoordinateNames::kPoints;
constexpr auto kEasting = CoordinateNames::kEasting;
constexpr auto kEast = CoordinateNames::kEast;

// By letters and digits alone.
const std::unordered_map<std::string, KnownName>& known_names() {
  static const std::unordered_map<std::string, KnownName> kNames = {
      {"x", {FieldRole::kX}},
      {"y", {FieldRole::kY}},
      {"z", {FieldRole::kZ}},
      {"xcoord", {FieldRole::kX}},
      {"ycoord", {FieldRole::kY}},
      {"zcoord", {FieldRole::kZ}},
      {"xcoordinate", {FieldRole::kX}},
      {"ycoordinate", {FieldRole::kY}},
      {"zcoordinate", {FieldRole::kZ}},
      {"posx", {FieldRole::kX}},
      {"posy", {FieldRole::kY}},
      {"posz", {FieldRole::kZ}},
      {"positionx", {FieldRole::kX}},
      {"positiony", {FieldRole::kY}},
      {"positionz", {FieldRole::kZ}},
      {"pointsmxyz0", {FieldRole::kX, kPoints}},  // VeloView
      {"pointsmxyz1", {FieldRole::kY, kPoints}},
      {"pointsmxyz2", {FieldRole::kZ, kPoints}},
      {"points0", {FieldRole::kX, kPoints}},  // ParaView
      {"points1", {FieldRole::kY, kPoints}},
      {"points2", {FieldRole::kZ, kPoints}},
      {"easting", {FieldRole::kX, kEasting}},
      {"northing", {FieldRole::kY, kEasting}},
      {"elevation", {FieldRole::kZ, kEasting}},
      {"height", {FieldRole::kZ, kEasting}},
      {"altitude", {FieldRole::kZ, kEasting}},
      {"east", {FieldRole::kX, kEast}},
      {"north", {FieldRole::kY, kEast}},
      {"up", {FieldRole::kZ, kEast}},
      {"red", {FieldRole::kRed}},
      {"green", {FieldRole::kGreen}},
      {"blue", {FieldRole::kBlue}},
      {"r", {FieldRole::kRed}},
      {"g", {FieldRole::kGreen}},
      {"b", {FieldRole::kBlue}},
      {"diffusered", {FieldRole::kRed}},
      {"diffusegreen", {FieldRole::kGreen}},
      {"diffuseblue", {FieldRole::kBlue}},
      {"rf", {FieldRole::kRed}},  // CloudCompare, of floats
      {"gf", {FieldRole::kGreen}},
      {"bf", {FieldRole::kBlue}},
      {"r16", {.role = FieldRole::kRed, .states_16_bits = true}},
      {"g16", {.role = FieldRole::kGreen, .states_16_bits = true}},
      {"b16", {.role = FieldRole::kBlue, .states_16_bits = true}},
      {"rgb", {FieldRole::kPackedRgb}},
      {"rgba", {FieldRole::kPackedRgb}},
      {"intensity", {FieldRole::kIntensity}},
      {"i", {FieldRole::kIntensity}},
      {"reflectance", {FieldRole::kIntensity}},
      {"reflectivity", {FieldRole::kIntensity}},
      {"remission", {FieldRole::kIntensity}},
      {"amplitude", {FieldRole::kIntensity}},
      {"time", {.role = FieldRole::kTime, .states_seconds = true}},
      {"gpstime", {.role = FieldRole::kTime, .states_seconds = true}},
      {"timestamp", {FieldRole::kTime}},
      {"t", {FieldRole::kTime}},
      {"ring", {FieldRole::kRing}},
      {"ringid", {FieldRole::kRing}},
      {"ringindex", {FieldRole::kRing}},
      {"channel", {FieldRole::kRing}},
      {"laser", {FieldRole::kRing}},
      {"laserid", {FieldRole::kRing}},
      {"lasernumber", {FieldRole::kRing}},
      {"beam", {FieldRole::kRing}},
      {"beamid", {FieldRole::kRing}},
      {"label", {FieldRole::kLabel}},
      {"classification", {FieldRole::kLabel}},
      {"class", {FieldRole::kLabel}},
      {"classid", {FieldRole::kLabel}},
      {"semantic", {FieldRole::kLabel}},
      {"semanticlabel", {FieldRole::kLabel}},
  };
  return kNames;
}

std::optional<double> metres_of(const std::string& unit) {
  static const std::unordered_map<std::string, double> kUnits = {
      {"m", 1.0},   {"metre", 1.0}, {"metres", 1.0}, {"meter", 1.0}, {"meters", 1.0},
      {"mm", 1e-3}, {"cm", 1e-2},   {"km", 1e3},     {"ft", 0.3048}, {"feet", 0.3048}};
  const auto found = kUnits.find(unit);
  return found == kUnits.end() ? std::nullopt : std::optional(found->second);
}

std::optional<double> seconds_of(const std::string& unit) {
  static const std::unordered_map<std::string, double> kUnits = {
      {"s", 1.0},   {"sec", 1.0}, {"seconds", 1.0},    {"ms", 1e-3},
      {"us", 1e-6}, {"ns", 1e-9}, {"\xc2\xb5s", 1e-6}, {"\xce\xbcs", 1e-6},
  };
  const auto found = kUnits.find(unit);
  return found == kUnits.end() ? std::nullopt : std::optional(found->second);
}

// The unit in brackets behind a name, cut off it; empty where there is none.
std::string cut_unit(std::string& name) {
  const std::size_t open = name.find_first_of("[({");
  if (open == std::string::npos) return "";
  const std::size_t close = name.find_first_of("])}", open);
  std::string unit = name.substr(open + 1, close == std::string::npos ? close : close - open - 1);
  std::erase(unit, ' ');
  name.resize(open);
  return unit;
}

std::string letters_and_digits(std::string_view name) {
  std::string kept;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c))) kept += c;
  }
  return kept;
}

// A name that a unit makes one of a time: an offset alone may be of anything.
bool is_time_with_unit(const std::string& name) {
  return name == "offset" || name == "offsettime" || name == "timeoffset" || name == "adjustedtime";
}

std::optional<KnownName> with_unit(const std::string& name, const std::string& unit) {
  const auto found = known_names().find(name);
  std::optional<KnownName> known;
  if (found != known_names().end()) known = found->second;
  if (!known && is_time_with_unit(name)) known = KnownName{FieldRole::kTime};
  if (!known || (!is_coordinate(known->role) && known->role != FieldRole::kTime)) return known;
  const auto size = known->role == FieldRole::kTime ? seconds_of(unit) : metres_of(unit);
  if (!size) return std::nullopt;
  known->unit = *size;
  known->states_unit = true;
  return known;
}

}  // namespace

bool is_coordinate(FieldRole role) { return role == FieldRole::kX || role == FieldRole::kY || role == FieldRole::kZ; }

bool is_color_channel(FieldRole role) {
  return role == FieldRole::kRed || role == FieldRole::kGreen || role == FieldRole::kBlue;
}

std::optional<KnownName> find_name(std::string_view name) {
  std::string lower = lower_case(name);
  if (lower.starts_with("scalar_")) lower.erase(0, 7);
  const std::string unit = cut_unit(lower);
  const std::string letters = letters_and_digits(lower);
  if (!unit.empty()) return with_unit(letters, unit);
  const auto found = known_names().find(letters);
  if (found != known_names().end()) return found->second;

  const std::size_t bar = lower.rfind('_');
  if (bar == std::string::npos) return std::nullopt;
  const std::string suffix = lower.substr(bar + 1);
  if (!metres_of(suffix) && !seconds_of(suffix)) return std::nullopt;
  return with_unit(letters_and_digits(lower.substr(0, bar)), suffix);
}

bool is_geographic_name(std::string_view name) {
  std::string lower = lower_case(name);
  cut_unit(lower);
  const std::string letters = letters_and_digits(lower);
  return letters == "lat" || letters == "latitude" || letters == "lon" || letters == "lng" || letters == "long" ||
         letters == "longitude";
}

}  // namespace vdbmap

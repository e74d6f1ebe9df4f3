// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/las/las_reference_system.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/las/geodetic_codes.h"
#include "vdbmap/io/las/wkt.h"

namespace vdbmap {
namespace {

constexpr std::string_view kProjectionUser = "LASF_Projection";
constexpr unsigned kGeoKeysId = 34735;
constexpr unsigned kWktId = 2112;

// GeoTIFF 1.8.2, section 6.2.
constexpr unsigned kModelTypeKey = 1024;
constexpr unsigned kGeographicTypeKey = 2048;
constexpr unsigned kProjectedTypeKey = 3072;
constexpr unsigned kProjectedUnitKey = 3076;
constexpr unsigned kModelIsProjected = 1;
constexpr unsigned kModelIsGeographic = 2;
constexpr unsigned kModelIsGeocentric = 3;

constexpr double kFoot = 0.3048;                // [m]
constexpr double kUsSurveyFoot = 1200. / 3937;  // [m]

using GeoKeys = std::map<unsigned, unsigned>;

// Whether the directory holds all the keys that it counts; the first of its rows is its header.
bool has_all_geo_keys(std::string_view data) {
  return data.size() >= 8 && load<std::uint16_t>(data.data() + 6) <= data.size() / 8 - 1;
}

// The keys of a whole directory whose value stands in the directory itself.
GeoKeys parse_geo_keys(std::string_view data) {
  const auto number = [data](std::size_t index) { return load<std::uint16_t>(data.data() + 2 * index); };
  GeoKeys keys;
  for (std::size_t i = 4; i < 4 * (std::size_t{1} + number(3)); i += 4) {
    if (number(i + 1) == 0) keys[number(i)] = number(i + 3);
  }
  return keys;
}

std::optional<unsigned> find_key(const GeoKeys& keys, unsigned key) {
  const auto found = keys.find(key);
  return found == keys.end() ? std::nullopt : std::optional(found->second);
}

// 0 is undefined, 32767 defined by the user.
std::optional<int> epsg_code(std::optional<unsigned> value) {
  if (!value || *value < 1024 || *value > 32766) return std::nullopt;
  return static_cast<int>(*value);
}

// A projected system that is defined by the user has no code: that of its geographic base would be a lie.
std::optional<int> epsg_of(const GeoKeys& keys) {
  const auto projected = find_key(keys, kProjectedTypeKey);
  if (projected || find_key(keys, kModelTypeKey) == kModelIsProjected) return epsg_code(projected);
  return epsg_code(find_key(keys, kGeographicTypeKey));
}

// The unit that the codes of the U.S. state planes on NAD83 imply; files in feet name the code and often no unit. Other
// codes would need the EPSG database.
std::optional<double> metres_per_unit_of(std::optional<int> epsg) {
  if (!epsg || *epsg < 2222 || *epsg > 2289) return std::nullopt;
  constexpr std::array kInternationalFeet = {2222, 2223, 2224, 2251, 2252, 2253, 2256, 2265,
                                             2266, 2269, 2270, 2273, 2280, 2281, 2282};
  return std::ranges::count(kInternationalFeet, *epsg) > 0 ? kFoot : kUsSurveyFoot;
}

std::optional<double> metres_per_unit_of(const GeoKeys& keys) {
  const auto unit = find_key(keys, kProjectedUnitKey);
  if (unit == 9001u) return 1.0;
  if (unit == 9002u) return kFoot;
  if (unit == 9003u) return kUsSurveyFoot;
  return std::nullopt;
}

// A model of degrees may stand beside a projected code, and the code of degrees where that of a projection belongs.
CoordinateKind kind_of_keys(const GeoKeys& keys) {
  const auto model = find_key(keys, kModelTypeKey);
  const auto projected = find_key(keys, kProjectedTypeKey);
  if (model == kModelIsGeocentric) return CoordinateKind::kGeocentric;
  if (projected && is_geodetic_epsg(static_cast<int>(*projected))) return CoordinateKind::kGeographic;
  if (model == kModelIsGeographic) return CoordinateKind::kGeographic;
  if (model == kModelIsProjected || projected) return CoordinateKind::kProjected;
  return find_key(keys, kGeographicTypeKey) ? CoordinateKind::kGeographic : CoordinateKind::kUnknown;
}

LasReferenceSystem read_geo_keys(std::string_view data) {
  if (!has_all_geo_keys(data)) return {{}, {}, {}, {{"the GeoTIFF keys are cut off and not used", 0, "", true}}};
  const GeoKeys keys = parse_geo_keys(data);
  return {epsg_of(keys), metres_per_unit_of(keys), kind_of_keys(keys), {}};
}

LasReferenceSystem read_wkt(std::string_view data) {
  const WktReferenceSystem parsed = parse_wkt(data);
  if (is_whole_wkt(data)) return {parsed.epsg, parsed.metres_per_unit, parsed.kind, {}};
  return {{}, {}, parsed.kind, {{"the WKT of the reference system is damaged and not used", 0, "", true}}};
}

// What one record says, filled up by what the other says.
LasReferenceSystem join_systems(LasReferenceSystem system, const LasReferenceSystem& other) {
  if (!system.epsg) system.epsg = other.epsg;
  if (!system.metres_per_unit) system.metres_per_unit = other.metres_per_unit;
  if (system.kind == CoordinateKind::kUnknown) system.kind = other.kind;
  for (const ReadFinding& finding : other.findings) add_finding(system.findings, finding);
  return system;
}

}  // namespace

LasReferenceSystem find_reference_system(const LasHeader& header, const std::vector<LasRecord>& records) {
  LasReferenceSystem geotiff;
  LasReferenceSystem wkt;
  for (const LasRecord& record : records) {
    if (record.user != kProjectionUser) continue;
    if (record.id == kGeoKeysId) geotiff = read_geo_keys(record.data);
    if (record.id == kWktId) wkt = read_wkt(record.data);
  }
  LasReferenceSystem system = header.prefers_wkt ? join_systems(wkt, geotiff) : join_systems(geotiff, wkt);
  if (!system.metres_per_unit) system.metres_per_unit = metres_per_unit_of(system.epsg);
  return system;
}

}  // namespace vdbmap

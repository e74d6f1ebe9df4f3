// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/las_reference_system.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "vdbmap/core/error.h"
#include "vdbmap/io/wkt.h"

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

constexpr double kFoot = 0.3048;                // [m]
constexpr double kUsSurveyFoot = 1200. / 3937;  // [m]

using GeoKeys = std::map<unsigned, unsigned>;

// The keys whose value stands in the directory itself.
GeoKeys parse_geo_keys(const std::filesystem::path& path, std::string_view data) {
  const auto number = [data](std::size_t index) { return load<std::uint16_t>(data.data() + 2 * index); };
  const std::size_t num_held = data.size() / 8;  // the first is the directory's header
  if (num_held == 0 || number(3) > num_held - 1) throw IoError::malformed(path, "the GeoTIFF keys are cut off");

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

}  // namespace

LasReferenceSystem find_reference_system(const std::filesystem::path& path, const LasHeader& header,
                                         const std::vector<LasRecord>& records) {
  LasReferenceSystem geotiff;
  LasReferenceSystem wkt;
  for (const LasRecord& record : records) {
    if (record.user != kProjectionUser) continue;
    if (record.id == kGeoKeysId) {
      const GeoKeys keys = parse_geo_keys(path, record.data);
      geotiff = {epsg_of(keys), metres_per_unit_of(keys)};
    }
    if (record.id == kWktId) {
      const WktReferenceSystem parsed = parse_wkt(record.data);
      wkt = {parsed.epsg, parsed.metres_per_unit};
    }
  }

  LasReferenceSystem system = header.prefers_wkt ? wkt : geotiff;
  const LasReferenceSystem& other = header.prefers_wkt ? geotiff : wkt;
  if (!system.epsg) system.epsg = other.epsg;
  if (!system.metres_per_unit) system.metres_per_unit = other.metres_per_unit;
  if (!system.metres_per_unit) system.metres_per_unit = metres_per_unit_of(system.epsg);
  return system;
}

}  // namespace vdbmap

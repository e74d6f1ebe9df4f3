// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/geo_output.h"

#include <cmath>
#include <optional>

#include <CLI/Option.hpp>

#include "parking/spaces/iso_date.h"
#include "vdbmap/io/file/text.h"

namespace vdbmap::cli {
namespace {

std::string check_offset(const std::string& text) {
  const std::optional<double> offset = parse_number(text);
  return offset && std::isfinite(*offset) ? "" : "is '" + text + "', expected metres";
}

std::string check_date(const std::string& text) {
  if (parking::milliseconds_of(text)) return "";
  return "is '" + text + "', expected a date like 2023-03-01 or 2023-03-01T10:20:30+01:00";
}

}  // namespace

void add_geo_options(CLI::App& app, parking::GeoOptions& options) {
  app.add_flag_function(
      "--map-coordinates", [&options](auto) { options.coordinates = parking::GeoCoordinates::kMap; },
      "Write GeoJSON in the map's own coordinates instead of WGS 84 (RFC 7946)");
  app.add_option("--geoid-offset", options.geoid_offset,
                 "Ellipsoidal heights minus the map's heights [m], for positions in WGS 84, [0]")
      ->check(check_offset)
      ->type_name("M");
}

void add_date(CLI::App& app, std::string& date, const std::string& what) {
  app.add_option("--date", date, "Date of " + what + " (ISO 8601)")->check(check_date)->type_name("DATE");
}

}  // namespace vdbmap::cli

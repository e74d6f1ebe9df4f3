// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/geo_output.h"

#include <cmath>
#include <optional>

#include <CLI/Option.hpp>

#include "vdbmap/io/file/text.h"

namespace vdbmap::cli {
namespace {

std::string check_offset(const std::string& text) {
  const std::optional<double> offset = parse_number(text);
  return offset && std::isfinite(*offset) ? "" : "is '" + text + "', expected metres";
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

}  // namespace vdbmap::cli

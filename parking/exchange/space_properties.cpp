// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/exchange/space_properties.h"

#include <cmath>

namespace vdbmap::parking {

double to_millimetres(double value) { return std::round(value * 1e3) / 1e3; }

double to_millionths(double value) { return std::round(value * 1e6) / 1e6; }

nlohmann::ordered_json text_or_null(std::string_view text) {
  return text.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(text);
}

nlohmann::ordered_json properties_of(const ParkingSpace& space) {
  nlohmann::ordered_json history = nlohmann::ordered_json::array();
  for (const PastState& past : space.history) {
    history.push_back({{"date", text_or_null(past.date)}, {"state", text_of(past.state)}});
  }
  return {{"id", space.id},
          {"kerb_side", text_or_null(space.kerb_side)},
          {"angle", text_or_null(text_of(space.angle))},
          {"candidate", space.is_candidate},
          {"length", to_millimetres(space.length)},
          {"width", to_millimetres(space.width)},
          {"heading", to_millionths(space.heading)},
          {"history", history}};
}

std::string text_of_collection(nlohmann::ordered_json features, const GeoFrame& geo) {
  // Names in foreign files need not be UTF-8: what is not becomes U+FFFD.
  const auto dump = [](const nlohmann::ordered_json& json) {
    return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  };
  std::string text = "{\n\"type\": \"FeatureCollection\",\n";
  if (const auto crs = geo.crs()) text += "\"crs\": " + dump(*crs) + ",\n";
  text += "\"features\": [";
  for (const nlohmann::ordered_json& feature : features)
    text += (&feature == &features.front() ? "\n" : ",\n") + dump(feature);
  return text + "\n]\n}\n";
}

}  // namespace vdbmap::parking

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "parking/exchange/geo_frame.h"
#include "parking/spaces/parking_space.h"

namespace vdbmap::parking {

/// A length [m] to the millimetre, an angle to 1e-6.
double to_millimetres(double value);
double to_millionths(double value);

/// A text, or null where it is empty.
nlohmann::ordered_json text_or_null(std::string_view text);

/// What is known of a space itself: id, kerb_side, angle, candidate, length, width, heading, history.
nlohmann::ordered_json properties_of(const ParkingSpace& space);

/// A FeatureCollection, a feature a line, with a newline at its end.
std::string text_of_collection(nlohmann::ordered_json features, const GeoFrame& geo);

}  // namespace vdbmap::parking

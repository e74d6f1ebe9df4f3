// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tools/simulator/lidar.h"
#include "tools/simulator/mapper.h"
#include "tools/simulator/street.h"

namespace vdbmap::simulator {

/// What a simulation's street.json says of itself, so that a later run knows that it may replace it.
inline constexpr const char* kGenerator = "vdbmap simulate";

/// All parameters of a street: options, axis, sides with their lots and houses, classes, objects.
nlohmann::ordered_json json_of_street(const Street& street);

nlohmann::ordered_json json_of_lidar(const LidarModel& lidar);
nlohmann::ordered_json json_of_mapper(const MapperModel& mapper);
nlohmann::ordered_json json_of_mapper_error(const MapperError& error);
nlohmann::ordered_json json_of_drive(const DriveOptions& drive);

}  // namespace vdbmap::simulator

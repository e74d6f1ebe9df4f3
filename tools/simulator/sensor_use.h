// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/simulator/lidar.h"

namespace vdbmap::simulator {

/// What drives up the street: the mobile mapper, or a turning scanner.
struct Sensor {
  std::string name;                 ///< as files and folders have it: "mapper", "vlp16", ...
  std::optional<LidarModel> lidar;  ///< nothing: the mapper

  bool is_mapper() const { return !lidar; }
};

/// Which sensor drives up the street in which epoch.
struct SensorUse {
  Sensor sensor;
  std::optional<int> epoch;  ///< every one where none is given
};

/// The sensors that have a name: mapper, vlp16, hdl64, hdl32, os1-128.
const std::vector<Sensor>& named_sensors();

/// Throws std::invalid_argument naming those that there are.
Sensor sensor_of_name(const std::string& name);

/// Reads "NAME,NAME@EPOCH,...". Throws std::invalid_argument.
std::vector<SensorUse> parse_sensors(const std::string& text);

/// The sensors of an epoch, each once: named ones in the order of their table, then others in that of their use. Where
/// nothing is given, the mapper in epoch 0 and the VLP-16 in every later one.
std::vector<Sensor> sensors_of_epoch(const std::vector<SensorUse>& uses, int epoch);

}  // namespace vdbmap::simulator

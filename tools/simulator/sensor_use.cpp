// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/sensor_use.h"

#include <algorithm>
#include <stdexcept>

#include <spdlog/fmt/fmt.h>

#include "vdbmap/io/file/text.h"

namespace vdbmap::simulator {
namespace {

SensorUse parse_sensor_use(const std::string& text) {
  const std::size_t at = text.find('@');
  const Sensor sensor = sensor_of_name(text.substr(0, at));
  if (at == std::string::npos) return {sensor, std::nullopt};
  const std::optional<std::uint64_t> epoch = parse_count(text.substr(at + 1));
  if (!epoch || *epoch > 1000) {
    throw std::invalid_argument("epoch " + vdbmap::quoted(text.substr(at + 1)) + " of a sensor is not a number");
  }
  return {sensor, static_cast<int>(*epoch)};
}

// Where a sensor stands among those that have a name; behind them where it has none.
std::size_t rank(const Sensor& sensor) {
  const auto& named = named_sensors();
  return static_cast<std::size_t>(std::ranges::find(named, sensor.name, &Sensor::name) - named.begin());
}

}  // namespace

const std::vector<Sensor>& named_sensors() {
  static const std::vector<Sensor> kSensors = {
      {"mapper", std::nullopt}, {"vlp16", vlp16()}, {"hdl64", hdl64()}, {"hdl32", hdl32()}, {"os1-128", os1_128()}};
  return kSensors;
}

Sensor sensor_of_name(const std::string& name) {
  std::string allowed;
  for (const Sensor& sensor : named_sensors()) {
    if (sensor.name == name) return sensor;
    allowed += (allowed.empty() ? "" : ", ") + sensor.name;
  }
  throw std::invalid_argument("unknown sensor " + vdbmap::quoted(name) + ", allowed are " + allowed);
}

std::vector<SensorUse> parse_sensors(const std::string& text) {
  std::vector<SensorUse> uses;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    uses.push_back(parse_sensor_use(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return uses;
}

std::vector<Sensor> sensors_of_epoch(const std::vector<SensorUse>& uses, int epoch) {
  if (uses.empty()) return {sensor_of_name(epoch == 0 ? "mapper" : "vlp16")};
  std::vector<Sensor> sensors;
  for (const SensorUse& use : uses) {
    const bool is_used = use.epoch.value_or(epoch) == epoch;
    if (is_used && std::ranges::find(sensors, use.sensor.name, &Sensor::name) == sensors.end()) {
      sensors.push_back(use.sensor);
    }
  }
  std::ranges::stable_sort(sensors, {}, rank);
  return sensors;
}

}  // namespace vdbmap::simulator

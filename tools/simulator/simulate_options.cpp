// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/simulate_options.h"

#include <stdexcept>

#include <spdlog/fmt/fmt.h>

namespace vdbmap::simulator {
namespace {

void check_sensor_use(const SensorUse& use, int num_epochs) {
  if (!use.epoch || (*use.epoch >= 0 && *use.epoch < num_epochs)) return;
  throw std::invalid_argument(
      fmt::format("sensor {} in epoch {}, there are epochs 0 to {}", use.sensor.name, *use.epoch, num_epochs - 1));
}

}  // namespace

std::size_t SimulateOptions::num_steps() const {
  std::size_t count = 0;
  for (int epoch = 0; epoch < street.num_epochs; ++epoch) {
    for (const Sensor& sensor : sensors_of_epoch(sensors, epoch)) {
      count += sensor.is_mapper() || street.is_quarter() ? 1 : static_cast<std::size_t>(num_scans.value_or(kNumScans));
    }
  }
  return count;
}

void SimulateOptions::check() const {
  street.check();
  if (num_scans && (*num_scans < 1 || *num_scans > 5000)) {
    throw std::invalid_argument(fmt::format("number of scans {}, allowed are 1 to 5000", *num_scans));
  }
  if (!(rain >= 0 && rain <= 50))
    throw std::invalid_argument(fmt::format("rain {} mm/h, allowed are 0 to 50 mm/h", rain));
  if (rain > 0 && street.is_ideal) throw std::invalid_argument("on an ideal street no rain falls");
  for (const SensorUse& use : sensors) check_sensor_use(use, street.num_epochs);
}

}  // namespace vdbmap::simulator

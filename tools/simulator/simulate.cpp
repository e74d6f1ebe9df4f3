// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/simulate.h"

#include <algorithm>
#include <stdexcept>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "tools/simulator/epoch_writer.h"
#include "tools/simulator/output_folder.h"
#include "tools/simulator/street_json.h"
#include "tools/simulator/truth_files.h"
#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/file/atomic_folder.h"
#include "vdbmap/io/file/text.h"

namespace vdbmap::simulator {
namespace {

Sensor parse_sensor(const std::string& name) {
  for (const Sensor sensor : {Sensor::kMapper, Sensor::kVlp16, Sensor::kHdl64}) {
    if (name == name_of(sensor)) return sensor;
  }
  throw std::invalid_argument("unknown sensor " + vdbmap::quoted(name) + ", allowed are mapper, vlp16 and hdl64");
}

void check_sensor_use(const SensorUse& use, int num_epochs) {
  if (!use.epoch || (*use.epoch >= 0 && *use.epoch < num_epochs)) return;
  throw std::invalid_argument(
      fmt::format("sensor {} in epoch {}, there are epochs 0 to {}", name_of(use.sensor), *use.epoch, num_epochs - 1));
}

SensorUse parse_sensor_use(const std::string& text) {
  const std::size_t at = text.find('@');
  const Sensor sensor = parse_sensor(text.substr(0, at));
  if (at == std::string::npos) return {sensor, std::nullopt};
  const std::optional<std::uint64_t> epoch = parse_count(text.substr(at + 1));
  if (!epoch || *epoch > 1000) {
    throw std::invalid_argument("epoch " + vdbmap::quoted(text.substr(at + 1)) + " of a sensor is not a number");
  }
  return {sensor, static_cast<int>(*epoch)};
}

}  // namespace

std::vector<SensorUse> parse_sensors(const std::string& text) {
  std::vector<SensorUse> uses;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    uses.push_back(parse_sensor_use(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return uses;
}

std::size_t SimulateOptions::num_steps() const {
  std::size_t count = 0;
  for (int epoch = 0; epoch < street.num_epochs; ++epoch) {
    for (const Sensor sensor : sensors_of_epoch(*this, epoch)) {
      count += sensor == Sensor::kMapper ? 1 : static_cast<std::size_t>(num_scans);
    }
  }
  return count;
}

void SimulateOptions::check() const {
  street.check();
  if (num_scans < 1 || num_scans > 5000) {
    throw std::invalid_argument(fmt::format("number of scans {}, allowed are 1 to 5000", num_scans));
  }
  for (const SensorUse& use : sensors) check_sensor_use(use, street.num_epochs);
}

SimulateResult simulate(const std::filesystem::path& out, const SimulateOptions& options) {
  options.check();
  check_output_folder(out);
  AtomicFolder folder(out);
  const std::filesystem::path& inside = folder.temporary_path();
  const Street street = make_street(options.street);

  SimulateResult result;
  nlohmann::ordered_json drives = nlohmann::ordered_json::array();
  for (int epoch = 0; epoch < options.street.num_epochs; ++epoch) {
    result.epochs.push_back(write_epoch(inside / fmt::format("epoch{}", epoch), street, epoch, options, drives));
  }
  write_spaces(inside / "spaces.geojson", street);
  result.num_spaces = street.parking.spaces.size();
  result.num_changed_voxels = write_changes(inside / "changes.csv", street);

  nlohmann::ordered_json json = {{"generator", kGenerator}};
  json.update(json_of_street(street));
  json["surveys"] = drives;
  write_file(inside / "street.json", json.dump(1) + "\n");
  folder.commit();
  return result;
}

}  // namespace vdbmap::simulator

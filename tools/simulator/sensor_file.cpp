// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/sensor_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <numbers>
#include <stdexcept>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/text.h"

namespace vdbmap::simulator {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr std::size_t kMostBeams = 256;
constexpr const char* kMapper = "mapper";
constexpr auto kKeys =
    std::to_array<const char*>({"name", "model", "epoch", "beams", "lowest_deg", "highest_deg", "elevations_deg",
                                "rate", "firings", "range", "noise", "height", "tilt_deg"});

// One sensor of the file; every message names it.
class SensorReader {
 public:
  SensorReader(const std::filesystem::path& path, const nlohmann::json& json, std::size_t index)
      : path_(path), json_(json), where_(fmt::format("sensor {}", index)) {}

  SensorUse read() {
    if (!json_.is_object()) fail("is no object");
    for (const auto& [key, value] : json_.items()) {
      if (std::ranges::find(kKeys, key) == kKeys.end()) fail("has an unknown key " + vdbmap::quoted(key));
    }
    const std::string name = text("name");
    if (name.empty() ||
        !std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; })) {
      fail("wants a name of letters, digits, - and _");
    }
    where_ = "sensor " + vdbmap::quoted(name);
    SensorUse use{name == kMapper ? read_mapper() : Sensor{name, read_lidar()}, std::nullopt};
    if (json_.contains("epoch")) use.epoch = static_cast<int>(number("epoch", 0, 0, 1000));
    return use;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw IoError::malformed(path_, where_ + " " + what); }

  std::string text(const char* key) const {
    if (!json_.contains(key) || !json_[key].is_string()) fail(fmt::format("wants a text \"{}\"", key));
    return json_[key];
  }

  double number(const char* key, double otherwise, double low, double high) const {
    if (!json_.contains(key)) return otherwise;
    if (!json_[key].is_number()) fail(fmt::format("wants a number \"{}\"", key));
    const double value = json_[key];
    if (!(value >= low && value <= high))
      fail(fmt::format("has \"{}\" {}, allowed are {} to {}", key, value, low, high));
    return value;
  }

  LidarModel model() const {
    if (!json_.contains("model")) return vlp16();
    try {
      const Sensor sensor = sensor_of_name(text("model"));
      if (sensor.lidar) return *sensor.lidar;
    } catch (const std::invalid_argument& error) {
      fail(std::string("has an ") + error.what());
    }
    fail("has a model that is no turning scanner");
  }

  std::vector<double> elevations_deg() const {
    std::vector<double> elevations;
    if (json_.contains("elevations_deg")) {
      if (!json_["elevations_deg"].is_array()) fail("wants an array \"elevations_deg\"");
      for (const nlohmann::json& value : json_["elevations_deg"]) {
        if (!value.is_number() || !(std::abs(value.get<double>()) <= 90))
          fail("has an elevation that is none from -90 to 90");
        elevations.push_back(value);
      }
      if (elevations.empty() || elevations.size() > kMostBeams) fail("wants 1 to 256 elevations");
    } else if (json_.contains("beams")) {
      const auto beams = static_cast<int>(number("beams", 0, 1, kMostBeams));
      const double low = number("lowest_deg", -15, -90, 90), high = number("highest_deg", 15, -90, 90);
      for (int i = 0; i < beams; ++i) elevations.push_back(beams == 1 ? low : low + (high - low) * i / (beams - 1));
    }
    std::ranges::sort(elevations);
    return elevations;
  }

  // The mobile mapper is as it is.
  Sensor read_mapper() const {
    for (const auto& [key, value] : json_.items()) {
      if (key != "name" && key != "epoch") fail("is the mobile mapper, which has no " + vdbmap::quoted(key));
    }
    return sensor_of_name(kMapper);
  }

  LidarModel read_lidar() const {
    LidarModel lidar = model();
    const std::vector<double> elevations = elevations_deg();
    if (!elevations.empty()) {
      lidar.lasers.clear();
      for (std::size_t i = 0; i < elevations.size(); ++i) {
        lidar.lasers.push_back({elevations[i] * kDegree, 0, static_cast<std::uint16_t>(i)});
      }
    }
    lidar.turn_time = 1 / number("rate", 1 / lidar.turn_time, 1, 50);
    lidar.num_firings = static_cast<int>(number("firings", lidar.num_firings, 36, 4096));
    lidar.pulse.farthest = number("range", lidar.pulse.farthest, 5, 300);
    lidar.pulse.range_noise = number("noise", lidar.pulse.range_noise, 0, 0.2);
    const double height = number("height", lidar.vehicle_from_scanner.translation().z(), 0.3, 5);
    lidar.vehicle_from_scanner = Eigen::Translation3d(0, 0, height) *
                                 Eigen::AngleAxisd(number("tilt_deg", 0, -45, 45) * kDegree, Eigen::Vector3d::UnitY());
    return lidar;
  }

  const std::filesystem::path& path_;
  const nlohmann::json& json_;
  std::string where_;
};

}  // namespace

std::vector<SensorUse> read_sensors(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw IoError::system(path, "cannot open", errno);
  const nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
  if (!json.is_array() || json.empty()) throw IoError::malformed(path, "is no JSON array of sensors");
  std::vector<SensorUse> uses;
  for (std::size_t i = 0; i < json.size(); ++i) uses.push_back(SensorReader(path, json[i], i).read());
  return uses;
}

}  // namespace vdbmap::simulator

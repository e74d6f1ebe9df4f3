// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/simulator/street_options.h"

namespace vdbmap::simulator {

enum class Sensor {
  kMapper,  ///< mobile mapper: cloud.las
  kVlp16,   ///< sparse scans: scans/, poses.txt
  kHdl64,   ///< dense scans: scans_hdl64/, poses_hdl64.txt
};

/// Which scanner drives up the street in which epoch.
struct SensorUse {
  Sensor sensor;
  std::optional<int> epoch;  ///< every one where none is given
};

/// Reads "NAME,NAME@EPOCH,..." with the names mapper, vlp16 and hdl64. Throws std::invalid_argument.
std::vector<SensorUse> parse_sensors(const std::string& text);

/// What a simulation makes.
struct SimulateOptions {
  StreetOptions street;
  std::vector<SensorUse> sensors;  ///< empty: the mapper in epoch 0, the VLP-16 in every later one
  int num_scans = 101;             ///< 1..5000 turns in an epoch
  /// Called once for each of num_steps() steps, by any thread.
  std::function<void()> on_step = [] {};

  std::size_t num_steps() const;

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
};

/// What an epoch holds.
struct EpochResult {
  std::size_t num_vehicles = 0;
  std::size_t num_cloud_points = 0;
  std::size_t num_scans = 0;
  std::size_t num_scan_points = 0;
};

struct SimulateResult {
  std::vector<EpochResult> epochs;
  std::size_t num_spaces = 0;
  std::size_t num_changed_voxels = 0;
};

/// Makes a street and writes its surveys and their truth into the folder `out`, which appears whole or not at all. A
/// folder that is there already is replaced if it is empty or an earlier simulation; else IoError (malformed) says what
/// is in it. The same options give the same bytes for any number of threads. Throws IoError and std::invalid_argument.
SimulateResult simulate(const std::filesystem::path& out, const SimulateOptions& options);

}  // namespace vdbmap::simulator

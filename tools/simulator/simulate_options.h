// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "tools/simulator/sensor_use.h"
#include "tools/simulator/street_options.h"

namespace vdbmap::simulator {

/// Turns of a scanner in an epoch on one street.
inline constexpr int kNumScans = 101;

/// What a simulation makes.
struct SimulateOptions {
  StreetOptions street;
  std::vector<SensorUse> sensors;  ///< empty: the mapper in epoch 0, the VLP-16 in every later one
  /// 1..5000 turns in an epoch, one after the other; where nothing is given kNumScans, in a quarter all that its tour
  /// takes.
  std::optional<int> num_scans = std::nullopt;
  double rain = 0;  ///< [mm/h] 0..50 that fall during the surveys, not on an ideal street
  /// Called once for each of num_steps() steps, by any thread: a scan, a mapper's drive, in a quarter any drive.
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

}  // namespace vdbmap::simulator

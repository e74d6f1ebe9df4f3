// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "tools/simulator/sensor_use.h"
#include "tools/simulator/street_options.h"

namespace vdbmap::simulator {

/// What a simulation makes.
struct SimulateOptions {
  StreetOptions street;
  std::vector<SensorUse> sensors;  ///< empty: the mapper in epoch 0, the VLP-16 in every later one
  int num_scans = 101;             ///< 1..5000 turns in an epoch
  double rain = 0;                 ///< [mm/h] 0..50 that fall during the surveys, not on an ideal street
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

}  // namespace vdbmap::simulator

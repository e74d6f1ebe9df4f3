// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace vdbmap::simulator {

/// Which street, and how often it is visited.
struct StreetOptions {
  std::uint64_t seed = 1;  ///< another seed, another street
  double length = 175;     ///< [m] 30..1000
  double margin = 60;      ///< [m] 0..200 that the houses go on before and after, so that nobody looks into the void
  int num_epochs = 2;      ///< 1..20 days on which the street is visited
  double occupancy = 0.7;  ///< share of the parking spaces that is taken, 0..1
  double turnover = 0.3;   ///< share of the parked cars that is gone by the next epoch, 0..1
  /// Nothing moves, hedges are neat, surveys have no errors: streets as they were made at first, byte for byte.
  bool is_ideal = false;
  /// 0: one street; 1..6 blocks that streets of a quarter enclose, along its rows and along its columns. Length and
  /// margin do not matter then.
  int quarter_columns = 0;
  int quarter_rows = 0;

  bool is_quarter() const { return quarter_columns > 0; }

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
};

}  // namespace vdbmap::simulator

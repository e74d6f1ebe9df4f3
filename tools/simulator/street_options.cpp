// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/street_options.h"

#include <stdexcept>

#include <spdlog/fmt/fmt.h>

namespace vdbmap::simulator {
namespace {

// Written so that NaN fails too.
void check_range(const char* name, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return;
  throw std::invalid_argument(fmt::format("{} {}{}, allowed are {} to {}{}", name, value, unit, low, high, unit));
}

}  // namespace

void StreetOptions::check() const {
  check_range("street length", length, 30, 1000, " m");
  check_range("margin", margin, 0, 200, " m");
  check_range("number of epochs", num_epochs, 1, 20, "");
  check_range("occupancy", occupancy, 0, 1, "");
  check_range("turnover", turnover, 0, 1, "");
  if (quarter_columns == 0 && quarter_rows == 0) return;
  check_range("columns of the quarter", quarter_columns, 1, 6, "");
  check_range("rows of the quarter", quarter_rows, 1, 6, "");
  if (is_ideal) throw std::invalid_argument("a quarter is never ideal");
}

}  // namespace vdbmap::simulator

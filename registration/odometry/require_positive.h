// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

namespace vdbmap::registration {

/// Throws std::invalid_argument naming the length [m] where it is not finite and above zero.
inline void require_positive(const char* name, double length) {
  if (length > 0 && std::isfinite(length)) return;
  throw std::invalid_argument(std::string(name) + " is " + std::to_string(length) + ", expected more than 0 m");
}

}  // namespace vdbmap::registration

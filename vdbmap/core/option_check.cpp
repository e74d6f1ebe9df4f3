// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/option_check.h"

#include <sstream>
#include <stdexcept>

namespace vdbmap {

void require(bool condition, std::string_view name, double value, std::string_view allowed) {
  if (condition) return;
  std::ostringstream message;
  message << name << " is " << value << ", expected " << allowed;
  throw std::invalid_argument(message.str());
}

}  // namespace vdbmap

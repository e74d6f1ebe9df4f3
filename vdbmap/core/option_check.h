// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace vdbmap {

/// For the check() of options: throws std::invalid_argument "NAME is VALUE, expected ALLOWED" unless `condition` holds.
void require(bool condition, std::string_view name, double value, std::string_view allowed);

}  // namespace vdbmap

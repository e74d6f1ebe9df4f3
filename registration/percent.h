// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <string>

namespace vdbmap::registration {

/// A share in whole percent: "57 %".
inline std::string percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

}  // namespace vdbmap::registration

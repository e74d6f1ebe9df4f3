// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "tools/simulator/material.h"

namespace vdbmap::simulator {

/// All classes with SemanticKITTI's names, in the order of their numbers.
const std::vector<std::pair<SurfaceClass, std::string_view>>& label_names();

}  // namespace vdbmap::simulator

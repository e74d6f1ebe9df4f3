// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tools/simulator/material.h"

namespace vdbmap::simulator {

/// All classes with SemanticKITTI's names, in the order of their numbers.
std::vector<std::pair<SurfaceClass, std::string>> label_names();

}  // namespace vdbmap::simulator

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tools/simulator/material.h"

namespace vdbmap::simulator {

/// The classes of a street, with SemanticKITTI's names, in the order of their numbers; an ideal one lacks some.
std::vector<std::pair<SurfaceClass, std::string>> label_names(bool is_ideal);

}  // namespace vdbmap::simulator

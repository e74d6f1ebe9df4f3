// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "vdbmap/core/label_scheme.h"
#include "vdbmap/render/image.h"

namespace vdbmap {

/// The colour of a class in pictures: near what one expects of it (vegetation is green) and apart from that of other
/// classes which lie beside it. Labels without a name in their scheme get one that their number chooses.
Rgb8 label_color(LabelScheme scheme, std::int32_t label);

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include "vdbmap/core/label_scheme.h"

namespace vdbmap {

/// A label in one byte, for tiles; 0 is kNoLabel.
using LabelCode = std::uint8_t;

/// The code of labels that have none of their own.
inline constexpr LabelCode kOtherLabelCode = 255;

/// The code of a label: the label itself up to 254, but 252 to 259 of SemanticKITTI, what moves, from 240 on, where
/// that scheme has nothing.
LabelCode code_of_label(LabelScheme scheme, std::int32_t label);

/// The label of a code; nothing for kOtherLabelCode.
std::optional<std::int32_t> label_of_code(LabelScheme scheme, LabelCode code);

}  // namespace vdbmap

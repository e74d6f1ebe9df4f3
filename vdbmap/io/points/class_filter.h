// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vdbmap/core/label_scheme.h"
#include "vdbmap/io/points/point_reader.h"

namespace vdbmap {

/// Drops the points of classes, by the names of their scheme, those that move included; returns their number. `scheme`
/// counts instead of what the file says. Throws std::invalid_argument naming the file where its points have no classes,
/// where nobody knows whose numbers they are, and where the scheme has no such class: what shall not come into a map
/// does not come into it because nobody could tell.
std::size_t drop_classes(const std::filesystem::path& file, ReadResult& read, const std::vector<std::string>& names,
                         std::optional<LabelScheme> scheme);

}  // namespace vdbmap

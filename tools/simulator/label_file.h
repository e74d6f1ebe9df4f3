// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "tools/simulator/survey.h"

namespace vdbmap::simulator {

/// Writes SemanticKITTI's .label format: 32 bits a point, little endian, class below and object above. Throws IoError.
void write_labels(const std::filesystem::path& path, const std::vector<PointTruth>& truth);

/// Reads it. Throws IoError.
std::vector<PointTruth> read_labels(const std::filesystem::path& path);

}  // namespace vdbmap::simulator

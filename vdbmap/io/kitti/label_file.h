// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "vdbmap/io/points/point_reader.h"

namespace vdbmap {

/// What a point of a scan was measured on.
struct PointLabel {
  std::uint16_t label;   ///< class
  std::uint16_t object;  ///< one number for all points of one thing; 0: none

  bool operator==(const PointLabel&) const = default;
};

/// Reads SemanticKITTI's .label format: 32 bits a point in the order of the points, little endian, class below and
/// object above. Throws IoError.
std::vector<PointLabel> read_labels(const std::filesystem::path& path);

/// Gives the points of a file their labels from a .label file, which has one for every point, dropped ones included.
/// Throws IoError naming both counts where it has not.
void attach_labels(ReadResult& read, const std::filesystem::path& path);

/// Writes the same format. Throws IoError.
void write_labels(const std::filesystem::path& path, const std::vector<PointLabel>& labels);

}  // namespace vdbmap

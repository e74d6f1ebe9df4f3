// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/points/point_fields.h"

namespace vdbmap {

/// A field of a file to be written.
struct OutputField {
  std::string name;
  PointField field;
};

/// The fields "intensity", "time", "ring" and "label" of the attributes that `cloud` has.
std::vector<OutputField> scalar_fields(const PointCloud& cloud);

/// Whether 8 bits a channel keep all colours.
bool has_8_bit_colors(const PointCloud& cloud);

/// The number of a point's field as the file holds it: the inverse of store_numbers().
double number_of_point(const PointCloud& cloud, const PointField& field, std::size_t point);

/// Writes point after point, little endian, without gaps.
void write_binary_points(AtomicFile& file, const PointCloud& cloud, const std::vector<OutputField>& fields);

/// Writes a line a point, in the fewest characters that read back the same.
void write_text_points(AtomicFile& file, const PointCloud& cloud, const std::vector<OutputField>& fields);

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vdbmap/core/point_cloud.h"
#include "vdbmap/io/scalar_type.h"

namespace vdbmap {

/// What a field of a point means to a PointCloud.
enum class FieldRole { kX, kY, kZ, kRed, kGreen, kBlue, kPackedRgb, kIntensity, kTime, kRing, kLabel };

/// A field as a file declares it.
struct NamedField {
  std::string name;
  ScalarType type;
};

/// A field that has a place in a PointCloud.
struct PointField {
  FieldRole role;
  ScalarType type;     ///< in the file
  double scale = 1.0;  ///< the cloud's number = scale * the file's number
};

/// For each field of a file its place in a PointCloud, or nothing. The first of several fields of one role wins.
/// Names are compared without case and without CloudCompare's "scalar_". Colours: integers of 8 bits are multiplied by
/// 257, floats run from 0 to 1. Times: floats are seconds; of the integers, whose unit no file states, only Ouster's
/// "t" is taken, as nanoseconds.
std::vector<std::optional<PointField>> choose_point_fields(const std::vector<NamedField>& fields);

/// The first of "x", "y", "z" that none of `fields` provides.
std::optional<std::string> missing_coordinate(const std::vector<std::optional<PointField>>& fields);

/// An empty-handed cloud of `count` points, with the attributes that `fields` provide.
PointCloud make_cloud(const std::vector<std::optional<PointField>>& fields, std::size_t count);

/// Stores a field's numbers, as they stand in the file, into the points from `first` on. Packed colours are their bits
/// as an unsigned number.
void store_numbers(PointCloud& cloud, const PointField& field, std::size_t first, std::span<const double> numbers);

/// A field together with its numbers of all points.
struct PointColumn {
  PointField field;
  StridedNumbers numbers;
};

/// Stores cloud.size() numbers of each column.
void store_columns(PointCloud& cloud, const std::vector<PointColumn>& columns);

/// The type under which to load a field: packed colours in a float are bits, and a NaN among them would not survive as
/// a number.
ScalarType type_to_load(const PointField& field);

/// A number of a text as store_numbers() takes it: packed colours printed as a float become their bits.
double number_from_text(const PointField& field, double number);

}  // namespace vdbmap

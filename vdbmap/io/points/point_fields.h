// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vdbmap/core/point_cloud.h"
#include "vdbmap/io/file/scalar_type.h"
#include "vdbmap/io/points/field_names.h"

namespace vdbmap {

/// A field as a file declares it.
struct NamedField {
  std::string name;
  ScalarType type;
};

/// A field that has a place in a PointCloud.
struct PointField {
  FieldRole role;
  ScalarType type;             ///< in the file
  double scale = 1.0;          ///< the cloud's number = scale * the file's number
  bool scale_is_known = true;  ///< else a colour, whose scale all of the file's colours say: see ColorRange
};

/// For each field of a file its place in a PointCloud, or nothing. The first of several fields of one role wins; the
/// coordinates are those of one set of names, if one is whole: x y z before easting northing height. find_name() says
/// what a name means. Colours: integers of 8 bits are multiplied by 257, r16 g16 b16 taken as they are, the scale of
/// others is not known yet. Times: floats are seconds unless the name says otherwise; of integers without a unit only
/// Ouster's "t" is taken, as nanoseconds.
std::vector<std::optional<PointField>> choose_point_fields(const std::vector<NamedField>& fields);

/// The first of "x", "y", "z" that none of `fields` provides.
std::optional<std::string> missing_coordinate(const std::vector<std::optional<PointField>>& fields);

/// Throws std::invalid_argument for a name of a column that nothing is known of, and where x, y or z is missing; no
/// names at all are fine. "-", "_", "skip", "nx", "ny" and "nz" are columns that are passed over.
void check_columns(const std::vector<std::string>& columns);

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

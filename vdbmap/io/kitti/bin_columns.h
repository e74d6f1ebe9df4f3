// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "vdbmap/io/file/scalar_type.h"

namespace vdbmap {

/// A sample of the numbers of a file without header, from places where a point begins whether it has 3, 4, 5 or 6 of
/// them. The same for the same bytes.
std::vector<double> sample_numbers(std::string_view bytes, ScalarType type);

/// Share of the numbers that a point cloud can hold: not finite, zero, or neither tiny nor huge.
double share_of_likely_numbers(const std::vector<double>& numbers);

/// The numbers of one column, if there are `num_columns`.
std::vector<double> column_of(const std::vector<double>& numbers, std::size_t num_columns, std::size_t column);

/// How well each of `nums_of_columns` parts the numbers into columns each of which is alike, from about 0 (not at all)
/// to 1: the adjusted share of their variance that lies between columns (R^2 of a one-way analysis of variance), of the
/// numbers with and without sign, on a scale on which 0.1 and 100 both count. 0 where there are fewer than two points.
std::vector<double> separations(const std::vector<double>& numbers, std::span<const std::size_t> nums_of_columns);

}  // namespace vdbmap

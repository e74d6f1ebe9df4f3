// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vdbmap {

/// Which columns of a table hold a pose.
struct PoseLayout {
  bool is_matrix = false;                    ///< rows of [R t] one after another, 12 or with the last row 16 columns
  std::size_t num_columns = 0;               ///< of every line
  std::optional<std::size_t> time;           ///< column
  std::array<std::size_t, 7> columns{};      ///< without a matrix: of x y z qx qy qz qw
  std::optional<double> seconds_per_unit{};  ///< of the times, where a header says so
  bool is_named = false;                     ///< by a header
};

/// What separates the numbers of a line: ';', ',', a tab, or ' ' for any white space.
char pose_separator(std::string_view line);

/// The fields between separators, without the white space and quotes around them.
std::vector<std::string_view> split_fields(std::string_view line, char separator);

/// The layout that a header names, with the separator of the data or white space: a time and x y z qx qy qz qw in any
/// order and among other columns, by the names of TUM, EuRoC, ROS and evo, or the elements of a matrix row by row.
/// Nothing for other text.
std::optional<PoseLayout> layout_of_header(const std::string& header, char separator);

/// The layout of columns without names: KITTI, the same with its last row, or TUM; nothing for other numbers of them.
std::optional<PoseLayout> layout_of_columns(std::size_t num_columns);

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vdbmap/io/points/point_fields.h"
#include "vdbmap/io/table/table_sample.h"

namespace vdbmap {

/// What the columns of a text file of points are; nothing for a column without a place in a PointCloud.
struct XyzLayout {
  std::vector<std::optional<PointField>> columns;
  std::vector<std::string> names;
  std::string note = {};  ///< what was taken for granted; empty where nothing was
};

/// The layout of columns with these names. Numbers of `sample` tell colours of whole numbers from fractions.
XyzLayout layout_of_names(const std::vector<std::string>& names, const TableSample& sample);

/// Leaves out times whose name states no unit and which are whole numbers all through the sample: nobody says whether
/// they are seconds or nanoseconds. "time" and "gps_time" are seconds by convention.
void leave_out_times_of_no_unit(XyzLayout& layout, const TableSample& sample);

/// The layout of a file without names, by the orders in which programs write: 3 columns are x y z, 4 x y z intensity, 6
/// x y z and a colour or a normal, 7 x y z intensity r g b (Leica) or x y z r g b and a number (CloudCompare), more of
/// them x y z r g b and numbers, or x y z intensity r g b and a normal. Which one is decided by what the numbers can
/// be: colours are whole numbers up to 255 or 65535, normals have length 1. Nothing where that leaves a choice.
/// `is_leica`: a .pts file, whose colours come behind the intensity.
std::optional<XyzLayout> layout_of_values(const TableSample& sample, bool is_leica);

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vdbmap/io/points/point_fields.h"

namespace vdbmap {

/// The record of a point in a file without header: numbers of one type, without gaps.
struct BinLayout {
  std::vector<std::optional<PointField>> columns;  ///< nothing for a number without a place in a PointCloud
  ScalarType type = ScalarType::kFloat32;

  std::size_t point_size() const { return columns.size() * size_of(type); }  ///< [bytes]
  bool is_kitti() const;                                                     ///< float32 x, y, z, intensity
};

/// The layout of columns with these names, as check_columns() knows them.
BinLayout bin_layout_of_names(const std::vector<std::string>& names, ScalarType type);

/// What layout the bytes have, from what a sample of the numbers can be: KITTI's x y z intensity; x y z; x y z
/// intensity ring (nuScenes), with other numbers behind the ring; x y z and a normal; in float32 or float64. Numbers of
/// one column are alike and those of different columns are not: the right number of columns parts them best. Where that
/// says too little, as in files of a few points, they have to be what only one layout allows. Nothing where none or
/// several fit.
std::optional<BinLayout> guess_bin_layout(std::string_view bytes, std::optional<ScalarType> stated_type = std::nullopt);

/// The names in a layout, for messages: "x, y, z, intensity, ring".
std::string text_of(const BinLayout& layout);

}  // namespace vdbmap

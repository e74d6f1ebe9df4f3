// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string_view>

namespace vdbmap {

/// What a field of a point means to a PointCloud.
enum class FieldRole { kX, kY, kZ, kRed, kGreen, kBlue, kPackedRgb, kIntensity, kTime, kRing, kLabel };

bool is_coordinate(FieldRole role);
bool is_color_channel(FieldRole role);

/// Names that programs use together for the three coordinates.
enum class CoordinateNames { kXyz, kPoints, kEasting, kEast };

/// What the name of a field says.
struct KnownName {
  FieldRole role;
  CoordinateNames coordinates = CoordinateNames::kXyz;  ///< of a coordinate
  double unit = 1.0;                                    ///< [m] or [s] that 1 in the file stands for
  bool states_unit = false;                             ///< the name says the unit: "x [mm]", "offset_ns"
  bool states_seconds = false;                          ///< by convention: "time", "gps_time"
  bool states_16_bits = false;                          ///< "r16", "g16", "b16"
};

/// What a name means: case, blanks, punctuation, quotes and CloudCompare's "scalar_" do not matter. Nothing for a name
/// that is not known, or whose unit is none of its kind ("x [deg]").
std::optional<KnownName> find_name(std::string_view name);

/// Whether a name is that of an angle on the globe, which is no coordinate of a map in metres.
bool is_geographic_name(std::string_view name);

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <string_view>

#include <openvdb/Types.h>

#include "vdbmap/core/voxel_record.h"

/// Codes of a record as the float values of channel grids, and back. A decoded value gives its code again, exactly;
/// any other value gives the code that stands for it best.
namespace vdbmap {

/// Whether a value of a channel is a number, and no NaN or infinity.
inline bool is_finite(float value) { return std::isfinite(value); }
inline bool is_finite(std::int32_t /*value*/) { return true; }
inline bool is_finite(const openvdb::Vec3f& value) { return value.isFinite(); }

/// What is wrong with a covariance that a file gives, [m^2] its diagonal and the rest, for a message; empty where
/// nothing is. Other programs round differently, and a variance of 0 may come out of a difference.
std::string_view covariance_problem(const openvdb::Vec3f& diagonal, const openvdb::Vec3f& off_diagonal,
                                    double voxel_size);

/// The mean as offset from the voxel's centre [m].
openvdb::Vec3f mean_offset_of(const VoxelRecord& record, double voxel_size);

/// Stores the voxel's mean, clamped to the voxel.
void set_mean_offset(VoxelRecord& record, const openvdb::Vec3f& offset, double voxel_size);

/// The colour, linear RGB 0..1.
openvdb::Vec3f color_value_of(const VoxelRecord& record);

/// Stores the colour, clamped to 0..1.
void set_color_value(VoxelRecord& record, const openvdb::Vec3f& linear_rgb);

/// The normal.
openvdb::Vec3f normal_value_of(const VoxelRecord& record);

/// Stores the direction of a vector of any length but 0, or its opposite where that is the one with z >= 0.
void set_normal_value(VoxelRecord& record, const openvdb::Vec3f& normal);

/// Planarity 0..1.
float planarity_value_of(const VoxelRecord& record);

/// Stores the planarity, clamped to 0..1.
void set_planarity_value(VoxelRecord& record, float planarity);

}  // namespace vdbmap

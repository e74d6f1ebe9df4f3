// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap::test {

/// Some hundred voxels of 10 cm and their 1 m level on both sides of every axis, several points each, with colour,
/// intensity and epochs, anchored in UTM zone 32.
VoxelMap sample_map();

/// The same points without anything but positions.
VoxelMap sample_map_without_attributes();

/// What differs first between two maps, down to the bits of every record; empty where they are equal.
std::string difference(const VoxelMap& a, const VoxelMap& b);

}  // namespace vdbmap::test

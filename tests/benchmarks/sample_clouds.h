// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "vdbmap/core/point_cloud.h"

namespace vdbmap::benchmarks {

/// Size of the clouds below.
inline constexpr std::size_t kNumPoints = 4'340'000;

/// A cloud that is made at its first use; nullptr where its data is missing.
using CloudSource = const PointCloud* (*)();

/// The first points of kitti_drive5 in the order of its scans, put together by its poses. KITTI has no colours: these
/// are made of height and intensity, so that the work is that of a coloured cloud.
const PointCloud* drive_cloud();

/// make_street(): as dense as mobile mapping, needs no data.
const PointCloud* street_cloud();

/// The cloud without its colours.
PointCloud without_colors(const PointCloud& cloud);

}  // namespace vdbmap::benchmarks

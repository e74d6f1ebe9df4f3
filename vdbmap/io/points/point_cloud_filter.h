// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "vdbmap/core/range_limits.h"
#include "vdbmap/io/points/point_reader.h"

namespace vdbmap {

/// Removes the points with a NaN or infinite coordinate, together with their attributes; returns their places.
std::vector<std::size_t> drop_non_finite(PointCloud& cloud);

/// Removes the points at these places of the cloud, which rise, with their attributes.
void remove_points(PointCloud& cloud, std::span<const std::size_t> places);

/// As above, and keeps their places in the file.
void drop_points(ReadResult& read, std::span<const std::size_t> places);

/// As above, and notes why where there are any.
void drop_points(ReadResult& read, std::span<const std::size_t> places, const ReadFinding& finding);

/// Drops what is no measurement but how drivers write a beam without a return: points where the sensor is itself. Those
/// of a scan in the frame of its sensor lie within a centimetre, nearer than any LiDAR measures; in another frame they
/// are two and more that lie exactly at the origin, as a single one may be meant, the corner of a model. Throws IoError
/// where no other point is left.
void drop_points_at_origin(const std::filesystem::path& path, ReadResult& read, bool is_in_sensor_frame);

/// Drops the points beyond the limits of the origin; returns their number.
std::size_t drop_out_of_range(ReadResult& read, const RangeLimits& limits);

/// The last step of every reader: drops and counts the points that are not finite. `broken` are the places, rising and
/// among all points of the file, of those that could not be read at all. Throws IoError where no point is left.
ReadResult finish_reading(const std::filesystem::path& path, PointCloud cloud,
                          const std::vector<std::size_t>& broken = {}, std::vector<ReadFinding> findings = {});

}  // namespace vdbmap

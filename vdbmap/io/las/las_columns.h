// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "vdbmap/core/point_cloud.h"
#include "vdbmap/io/las/las_header.h"

namespace vdbmap {

/// What a LAS or LAZ file holds beside its header and its records.
struct LasPoints {
  PointCloud cloud;                   ///< as finish_las_cloud() leaves it
  std::vector<std::size_t> withheld;  ///< places in the file, rising
  std::vector<std::size_t> lost;      ///< places of points that could not be read and are not in the cloud, rising
  std::vector<ReadFinding> findings;
};

/// A cloud of `count` points with the attributes that the point format has; for store_las_points().
PointCloud make_las_cloud(const LasHeader& header, std::size_t count);

/// Stores point records, as they stand in a file that is not compressed, into the points from `first` on. Different
/// points may be stored at the same time.
void store_las_points(PointCloud& cloud, std::size_t first, const char* records, std::size_t count,
                      const LasHeader& header);

/// Appends the places of records that are withheld, of which the first has the place `first`.
void append_withheld(std::vector<std::size_t>& places, std::size_t first, const char* records, std::size_t count,
                     const LasHeader& header);

/// Once all points are stored: scales the colours, and takes attributes that are 0 in every point for unknown.
void finish_las_cloud(PointCloud& cloud);

}  // namespace vdbmap

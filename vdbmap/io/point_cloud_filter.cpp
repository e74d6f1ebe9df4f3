// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/point_cloud_filter.h"

#include <string>
#include <utility>
#include <vector>

#include "vdbmap/core/error.h"

namespace vdbmap {
namespace {

std::vector<std::size_t> places_of_non_finite(const std::vector<Eigen::Vector3d>& positions) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!positions[i].allFinite()) places.push_back(i);
  }
  return places;
}

// Keeps the values whose point is finite; an attribute that the cloud does not have stays empty.
template <typename T>
void keep_finite(std::vector<T>& values, const std::vector<Eigen::Vector3d>& positions) {
  if (values.empty()) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (positions[i].allFinite()) values[kept++] = values[i];
  }
  values.resize(kept);
}

}  // namespace

std::vector<std::size_t> drop_non_finite(PointCloud& cloud) {
  std::vector<std::size_t> dropped = places_of_non_finite(cloud.positions);
  if (dropped.empty()) return dropped;

  keep_finite(cloud.colors, cloud.positions);
  keep_finite(cloud.intensities, cloud.positions);
  keep_finite(cloud.times, cloud.positions);
  keep_finite(cloud.rings, cloud.positions);
  keep_finite(cloud.labels, cloud.positions);
  std::erase_if(cloud.positions, [](const Eigen::Vector3d& position) { return !position.allFinite(); });
  return dropped;
}

ReadResult finish_reading(const std::filesystem::path& path, PointCloud cloud) {
  ReadResult result;
  result.dropped = drop_non_finite(cloud);
  if (cloud.empty()) {
    const std::string dropped = std::to_string(result.dropped.size());
    throw IoError::malformed(
        path, result.dropped.empty() ? "the file holds no points" : "none of the " + dropped + " points is finite");
  }
  result.cloud = std::move(cloud);
  return result;
}

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/point_cloud_filter.h"

#include <string>
#include <utility>
#include <vector>

#include "vdbmap/core/error.h"

namespace vdbmap {
namespace {

std::size_t count_finite(const std::vector<Eigen::Vector3d>& positions) {
  std::size_t count = 0;
  for (const Eigen::Vector3d& position : positions) count += position.allFinite() ? 1 : 0;
  return count;
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

std::size_t drop_non_finite(PointCloud& cloud) {
  const std::size_t num_dropped = cloud.size() - count_finite(cloud.positions);
  if (num_dropped == 0) return 0;

  keep_finite(cloud.colors, cloud.positions);
  keep_finite(cloud.intensities, cloud.positions);
  keep_finite(cloud.times, cloud.positions);
  keep_finite(cloud.rings, cloud.positions);
  keep_finite(cloud.labels, cloud.positions);
  std::erase_if(cloud.positions, [](const Eigen::Vector3d& position) { return !position.allFinite(); });
  return num_dropped;
}

ReadResult finish_reading(const std::filesystem::path& path, PointCloud cloud) {
  ReadResult result;
  result.num_dropped = drop_non_finite(cloud);
  if (cloud.empty()) {
    const std::string dropped = std::to_string(result.num_dropped);
    throw IoError::malformed(
        path, result.num_dropped == 0 ? "the file holds no points" : "none of the " + dropped + " points is finite");
  }
  result.cloud = std::move(cloud);
  return result;
}

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/cloud_append.h"

#include <vector>

namespace vdbmap {
namespace {

template <typename T>
void append_attribute(std::vector<T>& values, const std::vector<T>& part, bool is_first) {
  if (!is_first && (values.empty() || part.empty())) {
    values.clear();
    return;
  }
  values.insert(values.end(), part.begin(), part.end());
}

}  // namespace

void append_cloud(PointCloud& cloud, const PointCloud& part, const Eigen::Isometry3d& cloud_from_part) {
  if (part.empty()) return;
  const bool is_first = cloud.empty();
  append_attribute(cloud.colors, part.colors, is_first);
  append_attribute(cloud.intensities, part.intensities, is_first);
  append_attribute(cloud.times, part.times, is_first);
  append_attribute(cloud.rings, part.rings, is_first);
  append_attribute(cloud.labels, part.labels, is_first);
  for (const Eigen::Vector3d& position : part.positions) cloud.positions.push_back(cloud_from_part * position);
}

}  // namespace vdbmap

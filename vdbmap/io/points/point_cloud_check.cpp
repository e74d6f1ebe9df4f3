// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/points/point_cloud_check.h"

#include <cstddef>
#include <stdexcept>
#include <string>

namespace vdbmap {
namespace {

void check_length(const char* attribute, std::size_t length, std::size_t num_points) {
  if (length == 0 || length == num_points) return;
  throw std::invalid_argument("point cloud has " + std::to_string(length) + " " + attribute + " for " +
                              std::to_string(num_points) + " points, expected none or as many");
}

}  // namespace

void check_writable_cloud(const PointCloud& cloud) {
  if (cloud.empty()) throw std::invalid_argument("point cloud has no points to write");
  check_length("colors", cloud.colors.size(), cloud.size());
  check_length("intensities", cloud.intensities.size(), cloud.size());
  check_length("times", cloud.times.size(), cloud.size());
  check_length("rings", cloud.rings.size(), cloud.size());
  check_length("labels", cloud.labels.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.positions[i].allFinite()) {
      throw std::invalid_argument("point " + std::to_string(i) + " has a coordinate that is not finite");
    }
  }
}

}  // namespace vdbmap

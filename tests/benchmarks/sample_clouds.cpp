// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/benchmarks/sample_clouds.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/benchmarks/drive.h"
#include "tests/benchmarks/street.h"

namespace vdbmap::benchmarks {
namespace {

std::uint16_t code_of_share(double share) {
  return static_cast<std::uint16_t>(257 * std::lround(255 * std::clamp(share, 0.0, 1.0)));
}

Rgb16 made_up_color(double height, double intensity) {
  const double level = (height + 3) / 12;
  return {code_of_share(level), code_of_share(intensity), code_of_share(1 - level)};
}

std::optional<PointCloud> combine_drive() {
  const Drive* drive = kitti_drive();
  if (!drive) return std::nullopt;
  PointCloud combined;
  for (std::size_t s = 0; s < drive->scans.size(); ++s) {
    const PointCloud& scan = drive->scans[s];
    for (std::size_t i = 0; i < scan.size() && combined.size() < kNumPoints; ++i) {
      const Eigen::Vector3d point = drive->map_from_scan[s] * scan.positions[i];
      combined.positions.push_back(point);
      combined.colors.push_back(made_up_color(point.z(), scan.intensities[i]));
    }
  }
  return combined;
}

}  // namespace

const PointCloud* drive_cloud() {
  static const std::optional<PointCloud> cloud = combine_drive();
  return cloud ? &*cloud : nullptr;
}

const PointCloud* street_cloud() {
  static const PointCloud cloud = make_street(kNumPoints);
  return &cloud;
}

PointCloud without_colors(const PointCloud& cloud) {
  PointCloud plain = cloud;
  plain.colors.clear();
  return plain;
}

}  // namespace vdbmap::benchmarks

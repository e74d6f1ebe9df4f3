// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/posed_cloud.h"

#include <stdexcept>
#include <string>

namespace vdbmap {

std::vector<MeasuredRay> rays_of(const PosedCloud& posed, const Eigen::Vector3d& anchor) {
  const std::size_t num_points = posed.cloud.size();
  const std::size_t num_origins = posed.origins_in_cloud.size();
  if (num_origins != 1 && num_origins != num_points) {
    throw std::invalid_argument("rays of " + std::to_string(num_points) + " points have " +
                                std::to_string(num_origins) + " origins, expected one or one a point");
  }
  Eigen::Isometry3d local_from_cloud = posed.map_from_cloud;
  local_from_cloud.translation() -= anchor;
  std::vector<MeasuredRay> rays(num_points);
  for (std::size_t i = 0; i < num_points; ++i) {
    const Eigen::Vector3d& origin = posed.origins_in_cloud[num_origins == 1 ? 0 : i];
    rays[i] = {local_from_cloud * origin, local_from_cloud * posed.cloud.positions[i]};
  }
  return rays;
}

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/unreachable_points.h"

#include <sstream>
#include <stdexcept>

namespace vdbmap {

void check_reached(const UnreachablePoints& unreachable, std::size_t num_points) {
  if (2 * unreachable.count < num_points || unreachable.count == 0) return;
  const Eigen::Vector3d& point = unreachable.first;
  std::ostringstream message;
  message.precision(10);
  message << "point " << point.x() << ", " << point.y() << ", " << point.z() << " is more than " << unreachable.reach
          << " m from the anchor, the farthest that voxel ids reach";
  if (num_points > 1) message << ", as are " << unreachable.count << " of " << num_points << " points";
  throw std::out_of_range(message.str());
}

}  // namespace vdbmap

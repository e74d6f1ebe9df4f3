// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/shuffle.h"

#include <cstdint>
#include <utility>

namespace vdbmap::registration {

std::vector<Eigen::Vector3d> shuffled(std::span<const Eigen::Vector3d> points) {
  std::vector<Eigen::Vector3d> order(points.begin(), points.end());
  std::uint64_t state = 1;
  for (std::size_t i = order.size(); i > 1; --i) {
    state = state * 6364136223846793005u + 1442695040888963407u;  // Knuth, MMIX
    const std::size_t other = (state >> 32) * i >> 32;            // below i, for fewer than 2^32 points
    std::swap(order[i - 1], order[other]);
  }
  return order;
}

}  // namespace vdbmap::registration

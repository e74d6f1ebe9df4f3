// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_map.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace vdbmap {

const VoxelLevel* find_level(const VoxelMap& map, double voxel_size) {
  for (const VoxelLevel& level : map.levels) {
    if (std::abs(level.voxel_size() - voxel_size) < 1e-9) return &level;
  }
  return nullptr;
}

std::size_t num_points(const VoxelLevel& level) {
  std::size_t count = 0;
  for (const VoxelRecord& record : level.records()) count += record.count;
  return count;
}

std::size_t memory_bytes(const VoxelMap& map) {
  std::size_t bytes = 0;
  for (const VoxelLevel& level : map.levels) bytes += level.memory_bytes();
  return bytes;
}

std::optional<Extent> extent(const VoxelMap& map) {
  if (map.levels.empty() || map.finest().size() == 0) return std::nullopt;
  const openvdb::CoordBBox box = map.finest().tree().voxel_box();
  const double size = map.finest().voxel_size();
  return Extent{map.frame.anchor + corner_of_voxel(box.min(), size),
                map.frame.anchor + corner_of_voxel(box.max().offsetBy(1), size)};
}

bool is_anchor(const Eigen::Vector3d& anchor) {
  const Eigen::Vector3d tiles = anchor / kTileSize;
  const bool whole = anchor.allFinite() && (tiles.array().round() == tiles.array()).all();
  return whole && anchor.cwiseAbs().maxCoeff() < 1e9;
}

void check_anchor(const Eigen::Vector3d& anchor) {
  if (is_anchor(anchor)) return;
  std::ostringstream message;
  message << "anchor is " << anchor.x() << ", " << anchor.y() << ", " << anchor.z() << ", expected whole multiples of "
          << kTileSize << " m below 1e9 m";
  throw std::invalid_argument(message.str());
}

Eigen::Vector3d choose_anchor(const Eigen::Vector3d& point) {
  constexpr double kSpacing = 16 * kTileSize;
  const Eigen::Array3d steps = (point.array() / kSpacing).round();
  return steps * kSpacing + 0.0;  // + 0.0 turns -0 into 0
}

}  // namespace vdbmap

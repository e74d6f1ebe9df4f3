// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_map.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace vdbmap {
namespace {

constexpr int kMostDecimals = 9;

// `middle` with the fewest decimals with which it is in the same of the equal steps from `anchor` on. A point's step is
// computed as map building does: the product is rounded before the difference, also where the compiler could fuse them.
double with_fewest_decimals(double middle, double anchor, double voxels_per_metre) {
  const auto step_of = [&](double coordinate) {
    const double scaled = std::fma(coordinate, voxels_per_metre, 0.0);
    return std::floor((scaled - anchor * voxels_per_metre) * kMeanSteps);  // that product is whole
  };
  const double step = step_of(middle);
  double scale = 1;
  for (int decimals = 0; decimals <= kMostDecimals; ++decimals, scale *= 10) {
    const double rounded = std::round(middle * scale) / scale;
    if (step_of(rounded) == step) return rounded;
  }
  return middle;
}

}  // namespace

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
  // Sums of tenths are not the tenths themselves: 7.300000000000001 is none of a user's coordinates.
  const auto in_micrometres = [](const Eigen::Vector3d& point) -> Eigen::Vector3d {
    return (point.array() * 1e6).round() / 1e6;
  };
  return Extent{in_micrometres(map.frame.anchor + corner_of_voxel(box.min(), size)),
                in_micrometres(map.frame.anchor + corner_of_voxel(box.max().offsetBy(1), size))};
}

Eigen::Vector3d mean_in_original_system(const MapFrame& frame, const VoxelRecord& record, const VoxelIndex& voxel,
                                        double voxel_size) {
  Eigen::Vector3d mean = frame.anchor + mean_of(record, voxel, voxel_size);
  const double per_metre = voxels_per_metre(voxel_size);
  for (int axis = 0; axis < 3; ++axis) {
    mean[axis] = with_fewest_decimals(mean[axis], frame.anchor[axis], per_metre) + 0.0;  // + 0.0 turns -0 into 0
  }
  return mean;
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/local_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "vdbmap/core/option_check.h"

namespace vdbmap::registration {
namespace {

constexpr float kNowhere = 1e9F;  // [m] a coordinate no point has; its square is still a float

// The voxels before, at and after a point's along one axis, its own first.
constexpr std::array kSteps = {0, -1, 1};

// Their squared distances from the point.
std::array<float, 3> squared_gaps(float in_voxel, float voxel_size) {
  const float before = std::max(in_voxel, 0.0F);
  const float after = std::max(voxel_size - in_voxel, 0.0F);
  return {0, before * before, after * after};
}

}  // namespace

struct LocalMap::Nearest {
  float squared_distance;
  std::uint32_t block = CellTable::kNone;
  int place = 0;
};

void LocalMapOptions::check() const {
  require(voxel_size >= 0.01 && voxel_size <= 100, "voxel_size", voxel_size, "0.01 to 100 m");
  require(points_per_voxel >= 1 && points_per_voxel <= LocalMap::kCapacity, "points_per_voxel", points_per_voxel,
          "1 to " + std::to_string(LocalMap::kCapacity));
  require(max_distance > 0 && std::isfinite(max_distance), "max_distance", max_distance, "more than 0 m");
}

LocalMap::Block::Block() {
  x.fill(kNowhere);
  y.fill(kNowhere);
  z.fill(kNowhere);
}

LocalMap::LocalMap(const LocalMapOptions& options)
    : options_(options),
      voxels_per_metre_(1 / options.voxel_size),
      squared_spacing_(static_cast<float>(options.voxel_size * options.voxel_size / options.points_per_voxel)) {
  options.check();
}

void LocalMap::insert(std::span<const Eigen::Vector3d> points) {
  for (const Eigen::Vector3d& point : points) {
    if (!is_addressable(point, voxels_per_metre_)) continue;
    const VoxelIndex voxel = voxel_of_point(point, voxels_per_metre_);
    const std::uint32_t number = table_.find_or_insert(id_of_voxel(voxel), static_cast<std::uint32_t>(blocks_.size()));
    if (number == blocks_.size()) {
      blocks_.emplace_back();
      cells_.push_back(id_of_voxel(voxel));
    }
    add((point - corner_of_voxel(voxel, options_.voxel_size)).cast<float>(), blocks_[number]);
  }
}

void LocalMap::add(const Eigen::Vector3f& point_in_block, Block& block) const {
  if (block.count == options_.points_per_voxel) return;
  Nearest too_near{squared_spacing_};
  search(block, point_in_block, 0, too_near);
  if (too_near.block != CellTable::kNone) return;

  const auto place = static_cast<std::size_t>(block.count++);
  block.x[place] = point_in_block.x();
  block.y[place] = point_in_block.y();
  block.z[place] = point_in_block.z();
}

void LocalMap::forget_far(const Eigen::Vector3d& sensor) {
  const double limit = options_.max_distance * options_.max_distance;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const Eigen::Vector3d center = center_of_voxel(voxel_of_id(cells_[i]), options_.voxel_size);
    if ((center - sensor).squaredNorm() > limit) continue;
    if (kept != i) {
      cells_[kept] = cells_[i];
      blocks_[kept] = blocks_[i];
    }
    ++kept;
  }
  if (kept == cells_.size()) return;
  cells_.resize(kept);
  blocks_.resize(kept);
  table_.clear();
  for (std::size_t i = 0; i < kept; ++i) table_.find_or_insert(cells_[i], static_cast<std::uint32_t>(i));
}

void LocalMap::search(const Block& block, const Eigen::Vector3f& point_in_block, std::uint32_t number,
                      Nearest& nearest) {
  // The bits of floats that are not negative are in the order of their values, and a minimum of integers is vectorized.
  std::array<std::int32_t, kCapacity> distances;
  std::int32_t least = std::bit_cast<std::int32_t>(nearest.squared_distance);
  for (std::size_t i = 0; i < kCapacity; ++i) {
    const float x = block.x[i] - point_in_block.x();
    const float y = block.y[i] - point_in_block.y();
    const float z = block.z[i] - point_in_block.z();
    distances[i] = std::bit_cast<std::int32_t>(x * x + y * y + z * z);
  }
  std::int32_t nearest_here = distances[0];
  for (std::size_t i = 1; i < kCapacity; ++i) nearest_here = std::min(nearest_here, distances[i]);
  if (nearest_here >= least) return;
  int place = 0;
  while (distances[static_cast<std::size_t>(place)] != nearest_here) ++place;
  nearest = {std::bit_cast<float>(nearest_here), number, place};
}

Eigen::Vector3d LocalMap::point_of(std::uint32_t block, int place) const {
  const Block& points = blocks_[block];
  const auto i = static_cast<std::size_t>(place);
  return corner_of_voxel(voxel_of_id(cells_[block]), options_.voxel_size) +
         Eigen::Vector3d(points.x[i], points.y[i], points.z[i]);
}

std::optional<Eigen::Vector3d> LocalMap::nearest(const Eigen::Vector3d& point, double max_distance) const {
  if (!is_addressable(point, voxels_per_metre_)) return std::nullopt;
  const VoxelIndex voxel = voxel_of_point(point, voxels_per_metre_);
  const VoxelId cell = id_of_voxel(voxel);
  const auto size = static_cast<float>(options_.voxel_size);
  const Eigen::Vector3f in_voxel = (point - corner_of_voxel(voxel, options_.voxel_size)).cast<float>();
  const std::array gaps = {squared_gaps(in_voxel.x(), size), squared_gaps(in_voxel.y(), size),
                           squared_gaps(in_voxel.z(), size)};

  // Voxels that begin farther away than the nearest point so far are passed over, whole rows and slices of them.
  Nearest nearest{static_cast<float>(max_distance * max_distance)};
  for (std::size_t i = 0; i < 3; ++i) {
    if (gaps[0][i] >= nearest.squared_distance) continue;
    for (std::size_t j = 0; j < 3; ++j) {
      if (gaps[0][i] + gaps[1][j] >= nearest.squared_distance) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        if (gaps[0][i] + gaps[1][j] + gaps[2][k] >= nearest.squared_distance) continue;
        const std::uint32_t number = table_.find(id_beside(cell, kSteps[i], kSteps[j], kSteps[k]));
        if (number == CellTable::kNone) continue;
        const Eigen::Vector3f corner(kSteps[i], kSteps[j], kSteps[k]);
        search(blocks_[number], in_voxel - size * corner, number, nearest);
      }
    }
  }
  if (nearest.block == CellTable::kNone) return std::nullopt;
  return point_of(nearest.block, nearest.place);
}

std::size_t LocalMap::num_points() const {
  std::size_t count = 0;
  for (const Block& block : blocks_) count += static_cast<std::size_t>(block.count);
  return count;
}

std::vector<Eigen::Vector3d> LocalMap::points() const {
  std::vector<Eigen::Vector3d> points;
  for (std::uint32_t block = 0; block < blocks_.size(); ++block) {
    for (int place = 0; place < blocks_[block].count; ++place) points.push_back(point_of(block, place));
  }
  return points;
}

}  // namespace vdbmap::registration

// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/local_map.h"

#include <bit>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace vdbmap::registration {
namespace {

constexpr float kNowhere = 1e9F;  // [m] a coordinate no point has; its square is still a float

// A neighbour of a voxel: how far along each axis, and what leads there in a table of cells.
struct Neighbor {
  std::array<std::int8_t, 3> offset;
  Cell step;
};

// The voxel itself, then its neighbours across faces, edges and corners: the nearest mostly come first.
constexpr std::array<Neighbor, 27> neighbors_by_distance() {
  std::array<Neighbor, 27> neighbors{};
  std::size_t count = 0;
  for (int num_axes = 0; num_axes <= 3; ++num_axes) {
    for (int i = 0; i < 27; ++i) {
      const int x = i / 9 - 1;
      const int y = i / 3 % 3 - 1;
      const int z = i % 3 - 1;
      if (x * x + y * y + z * z != num_axes) continue;
      neighbors[count++] = {{static_cast<std::int8_t>(x), static_cast<std::int8_t>(y), static_cast<std::int8_t>(z)},
                            cell_step(x, y, z)};
    }
  }
  return neighbors;
}
constexpr std::array<Neighbor, 27> kNeighbors = neighbors_by_distance();

// The squared distance of a point in a voxel from the voxels before, at and after it, along one axis.
std::array<float, 3> squared_gaps(float in_voxel, float voxel_size) {
  const float before = std::max(in_voxel, 0.0F);
  const float after = std::max(voxel_size - in_voxel, 0.0F);
  return {before * before, 0, after * after};
}

}  // namespace

struct LocalMap::Nearest {
  float squared_distance;
  std::uint32_t block = CellTable::kNone;
  int place = 0;
};

void LocalMapOptions::check() const {
  const auto require = [](bool condition, const char* name, double value, const std::string& allowed) {
    if (condition) return;
    std::ostringstream message;
    message << name << " is " << value << ", expected " << allowed;
    throw std::invalid_argument(message.str());
  };
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

LocalMap::LocalMap(const LocalMapOptions& options) : options_(options), voxels_per_metre_(1 / options.voxel_size) {
  options.check();
}

void LocalMap::insert(std::span<const Eigen::Vector3d> points) {
  for (const Eigen::Vector3d& point : points) {
    if (!is_addressable(point, voxels_per_metre_)) continue;
    const VoxelIndex voxel = voxel_of_point(point, voxels_per_metre_);
    const std::uint32_t number = table_.find_or_insert(cell_of(voxel), static_cast<std::uint32_t>(blocks_.size()));
    if (number == blocks_.size()) {
      blocks_.emplace_back();
      cells_.push_back(cell_of(voxel));
    }
    Block& block = blocks_[number];
    if (block.count == options_.points_per_voxel) continue;
    const Eigen::Vector3f in_block = (point - corner_of_voxel(voxel, options_.voxel_size)).cast<float>();
    const auto place = static_cast<std::size_t>(block.count++);
    block.x[place] = in_block.x();
    block.y[place] = in_block.y();
    block.z[place] = in_block.z();
  }
}

void LocalMap::forget_far(const Eigen::Vector3d& sensor) {
  const double limit = options_.max_distance * options_.max_distance;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const Eigen::Vector3d center = center_of_voxel(voxel_of_cell(cells_[i]), options_.voxel_size);
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
  return corner_of_voxel(voxel_of_cell(cells_[block]), options_.voxel_size) +
         Eigen::Vector3d(points.x[i], points.y[i], points.z[i]);
}

std::optional<Eigen::Vector3d> LocalMap::nearest(const Eigen::Vector3d& point, double max_distance) const {
  if (!is_addressable(point, voxels_per_metre_)) return std::nullopt;
  const VoxelIndex voxel = voxel_of_point(point, voxels_per_metre_);
  const auto size = static_cast<float>(options_.voxel_size);
  const Eigen::Vector3f in_voxel = (point - corner_of_voxel(voxel, options_.voxel_size)).cast<float>();
  const std::array<float, 3> x_gaps = squared_gaps(in_voxel.x(), size);
  const std::array<float, 3> y_gaps = squared_gaps(in_voxel.y(), size);
  const std::array<float, 3> z_gaps = squared_gaps(in_voxel.z(), size);

  const Cell cell = cell_of(voxel);
  Nearest nearest{static_cast<float>(max_distance * max_distance)};
  for (const Neighbor& neighbor : kNeighbors) {
    const auto& offset = neighbor.offset;
    const float gap = x_gaps[static_cast<std::size_t>(offset[0] + 1)] +
                      y_gaps[static_cast<std::size_t>(offset[1] + 1)] + z_gaps[static_cast<std::size_t>(offset[2] + 1)];
    if (gap >= nearest.squared_distance) continue;
    const std::uint32_t number = table_.find(cell + neighbor.step);
    if (number == CellTable::kNone) continue;
    search(blocks_[number], in_voxel - size * Eigen::Vector3f(offset[0], offset[1], offset[2]), number, nearest);
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

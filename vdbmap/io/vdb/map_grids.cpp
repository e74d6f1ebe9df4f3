// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/map_grids.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>

namespace vdbmap {

std::string level_suffix(double voxel_size, bool is_finest) {
  if (is_finest) return "";
  const long millimetres = std::lround(voxel_size * 1000);
  if (millimetres % 1000 == 0) return "_" + std::to_string(millimetres / 1000) + "m";
  return "_" + std::to_string(millimetres) + "mm";
}

openvdb::math::Transform::Ptr transform_of_level(double voxel_size) {
  auto transform = openvdb::math::Transform::createLinearTransform(voxel_size);
  transform->postTranslate(openvdb::Vec3d(0.5 * voxel_size));
  return transform;
}

std::string problem_of_level_transform(const openvdb::math::Transform& transform, double voxel_size) {
  const auto expected = transform_of_level(voxel_size);
  const std::array corners = {openvdb::Vec3d(0, 0, 0), openvdb::Vec3d(1, 1, 1), openvdb::Vec3d(1, 2, 3)};
  const bool is_expected = transform.isLinear() && std::ranges::all_of(corners, [&](const openvdb::Vec3d& corner) {
                             const openvdb::Vec3d shift =
                                 transform.indexToWorld(corner) - expected->indexToWorld(corner);
                             return shift.length() <= 1e-5 * voxel_size;  // false for NaN
                           });
  if (is_expected) return "";
  return "has a transform other than the level's: expected uniform scale " + std::to_string(voxel_size) +
         " and translation " + std::to_string(0.5 * voxel_size) + " on each axis";
}

std::optional<double> exact_voxel_size(double stated) {
  if (!(stated > 0)) return std::nullopt;
  const double size = kTileSize / std::round(kTileSize / stated);
  const bool is_near = std::abs(stated - size) <= 1e-6 * size;
  try {
    voxels_per_metre(size);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
  return is_near ? std::optional(size) : std::nullopt;
}

openvdb::FloatGrid::Ptr make_density_grid(const VoxelLevel& level, float density) {
  const auto grid = make_channel_grid<openvdb::FloatGrid>(level, [density](std::size_t /*number*/) { return density; });
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->setSaveFloatAsHalf(true);
  return grid;
}

openvdb::Vec3SGrid::Ptr make_color_grid(const VoxelLevel& level) {
  const auto grid = make_channel_grid<openvdb::Vec3SGrid>(level, [&](std::size_t number) {
    const Eigen::Vector3d color = color_of(level.records()[number]);
    return openvdb::Vec3f(color.cast<float>().eval().data());
  });
  grid->setVectorType(openvdb::VEC_INVARIANT);
  return grid;  // not as half floats: the two zero bytes of a short float compress better than a half's mantissa
}

}  // namespace vdbmap

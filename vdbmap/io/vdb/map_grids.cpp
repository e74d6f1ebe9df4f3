// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/map_grids.h"

#include <cmath>
#include <memory>

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

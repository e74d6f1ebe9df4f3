// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <map>

#include "vdbmap/io/vdb/map_rules.h"
#include "vdbmap/io/vdb/standard_grids.h"
#include "vdbmap/io/vdb/voxel_grid.h"

namespace vdbmap {
namespace {

using openvdb::BoolGrid;
using openvdb::FloatGrid;
using openvdb::GridBase;
using openvdb::Int32Grid;
using openvdb::Vec3SGrid;
using openvdb::points::PointDataGrid;

constexpr double kMaxTranslation = 8000;  // [m] up to which single precision keeps half a millimetre

std::string named(const GridBase& grid) { return "grid '" + grid.getName() + "' "; }

// Runs a check on every grid; one that returns a text found a problem.
template <typename Check>
Finding check_each(const CheckedFile& file, const Check& check) {
  Finding finding;
  for (const auto& grid : file.grids) {
    const std::string problem = check(*grid);
    if (!problem.empty()) finding.problems.push_back(named(*grid) + problem);
  }
  return finding;
}

bool is_whole_number_channel(const std::string& channel) {
  return channel == "count" || channel == "label" || channel == "first_epoch" || channel == "last_epoch" ||
         channel == "hits" || channel == "passes";
}

bool is_vector_channel(const std::string& channel) {
  return channel == "color" || channel == "mean" || channel == "cov_diag" || channel == "cov_offdiag" ||
         channel == "normal";
}

template <typename Grid>
bool has_background(const GridBase& grid, const typename Grid::ValueType& value) {
  return !grid.isType<Grid>() || static_cast<const Grid&>(grid).background() == value;
}

openvdb::CoordBBox active_box(const GridBase& grid) { return grid.evalActiveVoxelBoundingBox(); }

// The map of the level's voxels: a grid of points has larger cells with the same corner.
openvdb::math::Transform::Ptr voxel_transform(const GridBase& grid) {
  const auto transform = grid.transform().copy();
  if (grid.isType<PointDataGrid>()) {
    transform->preScale(1.0 / kVoxelsPerCell);
    transform->preTranslate(openvdb::Vec3d(0.5 - 0.5 * kVoxelsPerCell));
  }
  return transform;
}

bool are_equal(const openvdb::math::Transform& a, const openvdb::math::Transform& b) {
  const openvdb::Vec3d corner(1, 2, 3);
  const double tolerance = 1e-9 * a.voxelSize().x();
  return (a.indexToWorld(openvdb::Vec3d(0)) - b.indexToWorld(openvdb::Vec3d(0))).length() <= tolerance &&
         (a.indexToWorld(corner) - b.indexToWorld(corner)).length() <= tolerance;
}

// Blender keeps transforms as matrices of single precision.
std::string foreign_transform_problem(const GridBase& grid) {
  const openvdb::math::Transform& transform = grid.transform();
  if (!transform.isLinear()) return "has a transform that is not linear";
  const double size = std::abs(transform.voxelSize().x());
  const openvdb::Vec3d origin = transform.indexToWorld(openvdb::Vec3d(0));
  constexpr double kMostVoxels = 1 << 22;  // beyond, the origin is off by a quarter of a voxel and more
  if (origin.length() < kMostVoxels * size) return "";
  return "is moved by " + std::to_string(origin.length()) + ", so many voxels of " + std::to_string(size) +
         " that single precision loses them";
}

std::string transform_problem(const GridBase& grid) {
  const openvdb::math::Transform& transform = grid.transform();
  const openvdb::Vec3d origin = transform.indexToWorld(openvdb::Vec3d(0));
  if (!transform.isLinear() || !transform.hasUniformScale()) return "has a transform that is not uniform and linear";
  const openvdb::Vec3d along_x = transform.indexToWorld(openvdb::Vec3d(1, 0, 0)) - origin;
  const openvdb::Vec3d along_y = transform.indexToWorld(openvdb::Vec3d(0, 1, 0)) - origin;
  const double size = transform.voxelSize().x();
  const openvdb::Vec3d error = (along_x - openvdb::Vec3d(size, 0, 0)) + (along_y - openvdb::Vec3d(0, size, 0));
  if (error.length() > 1e-9 * size) return "has a transform that rotates or mirrors";
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(origin[axis]) >= kMaxTranslation) {
      return "is moved by " + std::to_string(origin[axis]) + " m, expected less than 8000 m";
    }
  }
  const auto stated = grid.getMetadata<openvdb::DoubleMetadata>("voxel_size");
  const double voxel_size = voxel_transform(grid)->voxelSize().x();
  if (stated && std::abs(stated->value() - voxel_size) > 1e-9 * voxel_size) {
    return "has voxels of " + std::to_string(voxel_size) + " m, but says " + std::to_string(stated->value()) + " m";
  }
  return "";
}

}  // namespace

Finding check_grid_types(const CheckedFile& file) {
  return check_each(file, [](const GridBase& grid) -> std::string {
    const bool is_known = grid.isType<FloatGrid>() || grid.isType<Vec3SGrid>() || grid.isType<BoolGrid>() ||
                          grid.isType<Int32Grid>() || grid.isType<PointDataGrid>();
    return is_known ? "" : "is of type " + grid.type() + ", expected float, vec3s, bool, int32 or points";
  });
}

Finding check_channel_types(const CheckedFile& file) {
  return check_each(file, [&](const GridBase& grid) -> std::string {
    const std::string channel = role_of_grid(grid).channel;
    const bool is_bound = channel == "density" || channel == "color";  // by renderers, whoever wrote them
    if (channel.empty() || (!file.is_ours && !is_bound)) return "";
    if (channel == "voxels") return grid.isType<PointDataGrid>() ? "" : "does not hold points";
    if (is_vector_channel(channel)) return grid.isType<Vec3SGrid>() ? "" : "does not hold vectors (vec3s)";
    if (is_whole_number_channel(channel) && grid.isType<Int32Grid>()) return "";
    if (grid.isType<FloatGrid>()) return "";
    return is_whole_number_channel(channel) ? "does not hold whole numbers (int32)" : "does not hold numbers (float)";
  });
}

Finding check_vector_types(const CheckedFile& file) {
  return check_each(file, [](const GridBase& grid) -> std::string {
    const std::string channel = role_of_grid(grid).channel;
    if (!is_vector_channel(channel) || channel == "normal" || grid.getVectorType() == openvdb::VEC_INVARIANT) return "";
    return "has vector type '" + GridBase::vecTypeToString(grid.getVectorType()) + "', expected 'invariant'";
  });
}

Finding check_grid_classes(const CheckedFile& file) {
  return check_each(file, [](const GridBase& grid) -> std::string {
    const bool is_density = role_of_grid(grid).channel == "density";
    const openvdb::GridClass expected = is_density ? openvdb::GRID_FOG_VOLUME : openvdb::GRID_UNKNOWN;
    if (grid.getGridClass() == expected) return "";
    return "has class '" + GridBase::gridClassToString(grid.getGridClass()) + "', expected '" +
           GridBase::gridClassToString(expected) + "'";
  });
}

Finding check_backgrounds(const CheckedFile& file) {
  return check_each(file, [&](const GridBase& grid) -> std::string {
    // Elsewhere a level set has its half width around it, and a temperature that of the air.
    const bool is_fog = grid.getGridClass() == openvdb::GRID_FOG_VOLUME && role_of_grid(grid).channel == "density";
    if (!file.is_ours && !is_fog) return "";
    const bool is_zero = has_background<FloatGrid>(grid, 0) && has_background<Int32Grid>(grid, 0) &&
                         has_background<BoolGrid>(grid, false) && has_background<Vec3SGrid>(grid, openvdb::Vec3f(0));
    return is_zero ? "" : "has a background other than 0";
  });
}

Finding check_half_floats(const CheckedFile& file) {
  return check_each(file, [](const GridBase& grid) -> std::string {
    const std::string channel = role_of_grid(grid).channel;
    if (!grid.saveFloatAsHalf() || channel == "density" || channel == "color") return "";
    return "is stored in half precision";
  });
}

Finding check_statistics(const CheckedFile& file) {
  return check_each(file, [&](const GridBase& grid) -> std::string {
    const auto min = grid.getMetadata<openvdb::Vec3IMetadata>(GridBase::META_FILE_BBOX_MIN);
    const auto max = grid.getMetadata<openvdb::Vec3IMetadata>(GridBase::META_FILE_BBOX_MAX);
    // OpenVDB leaves them out for a grid that shares the tree of another: readers do without them.
    if (!min || !max) return file.is_ours ? "lacks 'file_bbox_min' and 'file_bbox_max'" : "";
    if (grid.empty()) return "";
    const openvdb::CoordBBox box = active_box(grid);
    const bool is_right = min->value() == box.min().asVec3i() && max->value() == box.max().asVec3i();
    return is_right ? "" : "has a bounding box in its metadata that is not the one of its voxels";
  });
}

Finding check_transforms(const CheckedFile& file) {
  if (!file.is_ours) return check_each(file, foreign_transform_problem);
  Finding finding = check_each(file, transform_problem);
  std::map<std::string, openvdb::math::Transform::Ptr> transform_of_suffix;
  for (const auto& grid : file.grids) {
    const GridRole role = role_of_grid(*grid);
    if (role.channel.empty() || !transform_problem(*grid).empty()) continue;
    const auto transform = voxel_transform(*grid);
    const auto [first, is_new] = transform_of_suffix.emplace(role.suffix, transform);
    if (are_equal(*first->second, *transform)) continue;
    finding.problems.push_back(named(*grid) + "has another transform than the first grid of its level");
  }
  return finding;
}

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "vdbmap/io/vdb/channel_codes.h"
#include "vdbmap/io/vdb/map_rules.h"
#include "vdbmap/io/vdb/standard_grids.h"
#include "vdbmap/io/vdb/voxel_attributes.h"

namespace vdbmap {
namespace {

using openvdb::GridBase;
using VoxelGrids = openvdb::TypeList<openvdb::FloatGrid, openvdb::Vec3SGrid, openvdb::Int32Grid, openvdb::BoolGrid>;

constexpr std::int32_t kMaxIndex = 1 << 30;
constexpr double kGigabyte = 1e9;
constexpr double kLargeTexture = 2 * kGigabyte;  // more than many graphics cards can spare

std::string at(const std::string& grid, const openvdb::Coord& voxel) {
  std::ostringstream text;
  text << "grid '" << grid << "', voxel " << voxel << ": ";
  return text.str();
}

template <typename Grid>
void find_infinite(const Grid& grid, Finding& finding) {
  for (auto value = grid.cbeginValueOn(); value; ++value) {
    if (!is_finite(*value)) finding.problems.push_back(at(grid.getName(), value.getCoord()) + "not finite");
  }
}

template <typename Array>
void find_infinite(const openvdb::points::AttributeArray& array, const std::string& place, Finding& finding) {
  const auto [type, codec] = Array::attributeType();
  if (array.valueType() != type || array.codecType() != codec) return;
  const CodeReader<Array> values(array);
  // One value may stand for any number of points, and takes no room for them in the file.
  const openvdb::Index num_values = array.isUniform() ? std::min<openvdb::Index>(array.size(), 1) : array.size();
  for (openvdb::Index i = 0; i < num_values; ++i) {
    if (!is_finite(values[i])) finding.problems.push_back(place + "a point's attribute is not finite");
  }
}

void find_infinite(const openvdb::points::PointDataGrid& grid, Finding& finding) {
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
    const auto& attributes = leaf->attributeSet();
    for (std::size_t i = 0; i < attributes.size(); ++i) {
      find_infinite<FloatArray>(*attributes.getConst(i), at(grid.getName(), leaf->origin()), finding);
      find_infinite<VectorArray>(*attributes.getConst(i), at(grid.getName(), leaf->origin()), finding);
    }
  }
}

template <typename Grid>
void find_empty_leaves(const Grid& grid, Finding& finding) {
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
    if (leaf->isEmpty())
      finding.problems.push_back(at(grid.getName(), leaf->origin()) + "a leaf without active voxels");
  }
}

// In voxels; indices of foreign files may be farther apart than an index can say.
openvdb::Vec3d size_of_box(const GridBase& grid) {
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  return box.max().asVec3d() - box.min().asVec3d() + openvdb::Vec3d(1);
}

double dense_bytes(const GridBase& grid) {
  const openvdb::Vec3d size = size_of_box(grid);
  return size.x() * size.y() * size.z() * sizeof(float);
}

std::string size_text(const GridBase& grid) {
  const openvdb::Vec3d size = size_of_box(grid);
  std::ostringstream text;
  text << "'" << grid.getName() << "' becomes a texture of " << std::llround(size.x()) << " x "
       << std::llround(size.y()) << " x " << std::llround(size.z()) << ", " << std::setprecision(2)
       << dense_bytes(grid) / kGigabyte << " GB, in Blender's viewport";
  if (dense_bytes(grid) > kLargeTexture) text << ": show a coarser level or a smaller part there";
  return text.str();
}

}  // namespace

Finding check_finite_values(const CheckedFile& file) {
  Finding finding;
  for (const auto& grid : file.grids) {
    grid->apply<openvdb::TypeList<openvdb::FloatGrid, openvdb::Vec3SGrid, openvdb::points::PointDataGrid>>(
        [&](const auto& typed) { find_infinite(typed, finding); });
  }
  return finding;
}

Finding check_index_range(const CheckedFile& file) {
  Finding finding;
  for (const auto& grid : file.grids) {
    if (grid->empty()) continue;
    const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
    for (const openvdb::Coord& corner : {box.min(), box.max()}) {
      const openvdb::Coord low = openvdb::Coord::minComponent(corner, openvdb::Coord(0));
      const openvdb::Coord high = openvdb::Coord::maxComponent(corner, openvdb::Coord(0));
      const bool is_inside = low.x() >= -kMaxIndex && low.y() >= -kMaxIndex && low.z() >= -kMaxIndex &&
                             high.x() <= kMaxIndex && high.y() <= kMaxIndex && high.z() <= kMaxIndex;
      if (!is_inside) finding.problems.push_back(at(grid->getName(), corner) + "index beyond 2^30");
    }
  }
  return finding;
}

Finding check_empty_leaves(const CheckedFile& file) {
  Finding finding;
  for (const auto& grid : file.grids) {
    grid->apply<VoxelGrids>([&](const auto& typed) { find_empty_leaves(typed, finding); });
    grid->apply<openvdb::TypeList<openvdb::points::PointDataGrid>>(
        [&](const auto& typed) { find_empty_leaves(typed, finding); });
  }
  return finding;
}

Finding check_mean_offsets(const CheckedFile& file) {
  Finding finding;
  for (const auto& grid : file.grids) {
    if (role_of_grid(*grid).channel != "mean" || !grid->isType<openvdb::Vec3SGrid>()) continue;
    const auto means = openvdb::gridConstPtrCast<openvdb::Vec3SGrid>(openvdb::GridBase::ConstPtr(grid));
    const double limit = 0.5 * grid->voxelSize().x() * (1 + 1e-6);
    for (auto mean = means->cbeginValueOn(); mean; ++mean) {
      const double largest = std::max({std::abs(mean->x()), std::abs(mean->y()), std::abs(mean->z())});
      if (largest > limit) finding.problems.push_back(at(grid->getName(), mean.getCoord()) + "mean leaves the voxel");
    }
  }
  return finding;
}

Finding check_dense_size(const CheckedFile& file) {
  Finding finding;
  for (const auto& grid : file.grids) {
    if (role_of_grid(*grid).channel != "density" || grid->empty()) continue;
    finding.remark += (finding.remark.empty() ? "" : "; ") + size_text(*grid);
  }
  return finding;
}

}  // namespace vdbmap

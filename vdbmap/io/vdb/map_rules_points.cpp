// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "vdbmap/io/vdb/map_rules.h"
#include "vdbmap/io/vdb/standard_grids.h"
#include "vdbmap/io/vdb/voxel_attributes.h"
#include "vdbmap/io/vdb/voxel_grid.h"

namespace vdbmap {
namespace {

namespace points = openvdb::points;

using openvdb::FloatGrid;
using openvdb::GridBase;
using points::PointDataGrid;

// A position code at the end of a cell decodes to its very border, which rounding gives to the next cell.
constexpr double kShrink = 1 - 1e-5;

std::vector<PointDataGrid::ConstPtr> point_grids(const CheckedFile& file) {
  std::vector<PointDataGrid::ConstPtr> grids;
  for (const auto& grid : file.grids) {
    if (!grid->isType<PointDataGrid>()) continue;
    grids.push_back(openvdb::gridConstPtrCast<PointDataGrid>(GridBase::ConstPtr(grid)));
  }
  return grids;
}

const points::AttributeSet::Descriptor* descriptor_of(const PointDataGrid& grid) {
  const auto leaf = grid.tree().cbeginLeaf();
  return leaf ? &leaf->attributeSet().descriptor() : nullptr;
}

bool has_attribute(const PointDataGrid& grid, const std::string& name) {
  const auto* descriptor = descriptor_of(grid);
  return descriptor && descriptor->find(name) != points::AttributeSet::INVALID_POS;
}

std::size_t num_points(const PointDataGrid& grid) {
  std::size_t count = 0;
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) count += leaf->getLastValue();
  return count;
}

void check_attributes(const PointDataGrid& grid, bool file_is_ours, Finding& finding) {
  const auto* descriptor = descriptor_of(grid);
  if (!descriptor) return;
  const std::string place = "grid '" + grid.getName() + "' ";
  if (!has_attribute(grid, "P")) finding.problems.push_back(place + "lacks attribute 'P'");
  for (const auto& [name, position] : descriptor->map()) {
    const bool is_bound = name == "P" || name == "Cd" || name == "N";
    if (is_bound && descriptor->valueType(position) != "vec3s") {
      finding.problems.push_back(place + "has attribute '" + name + "' of type " + descriptor->valueType(position) +
                                 ", expected vec3s");
    }
    const bool has_upper_case = std::ranges::any_of(name, [](char c) { return c >= 'A' && c <= 'Z'; });
    if (file_is_ours && !is_bound && has_upper_case)
      finding.problems.push_back(place + "has attribute '" + name + "' in upper case");
  }
}

// Whether each point of the leaf has a position. Offsets of a broken file may lead anywhere, and promise more points
// than the leaf has voxels.
bool has_positions(const PointLeaf& leaf) {
  constexpr std::uint64_t kMostPoints =
      std::uint64_t{PointLeaf::SIZE} * kVoxelsPerCell * kVoxelsPerCell * kVoxelsPerCell;
  const points::AttributeArray* positions = leaf.attributeSet().getConst("P");
  if (!positions || positions->valueType() != "vec3s" || positions->size() != leaf.getLastValue()) return false;
  openvdb::Index before = 0;
  for (openvdb::Index cell = 0; cell < PointLeaf::SIZE; ++cell) {
    const openvdb::Index end = leaf.getValue(cell);
    if (end < before) return false;
    before = end;
  }
  return before <= kMostPoints;
}

bool is_index(const openvdb::Vec3d& place) {
  constexpr double kLimit = 1 << 30;
  return std::abs(place.x()) < kLimit && std::abs(place.y()) < kLimit && std::abs(place.z()) < kLimit;  // not NaN
}

// Whether the points of a grid and the voxels of its fog are the same places in the world.
class KnownPointCheck {
 public:
  KnownPointCheck(const PointDataGrid& voxels, const FloatGrid& density)
      : voxels_(voxels), density_(density), fog_(density.getConstAccessor()) {}

  void run(Finding& finding) {
    for (auto leaf = voxels_.tree().cbeginLeaf(); leaf; ++leaf) check_leaf(*leaf);
    const std::string place = "grid '" + voxels_.getName() + "' ";
    if (num_outside_ > 0) {
      finding.problems.push_back(place + "has " + std::to_string(num_outside_) + " points outside the voxels of '" +
                                 density_.getName() + "'");
    }
    if (num_points(voxels_) != density_.activeVoxelCount()) {
      finding.problems.push_back(place + "has " + std::to_string(num_points(voxels_)) + " points, '" +
                                 density_.getName() + "' " + std::to_string(density_.activeVoxelCount()) + " voxels");
    }
  }

 private:
  void check_leaf(const PointLeaf& leaf) {
    if (!has_positions(leaf)) {
      ++num_outside_;
      return;
    }
    const points::AttributeHandle<openvdb::Vec3f> positions(leaf.constAttributeArray("P"));
    for (auto point = leaf.beginIndexOn(); point; ++point) {
      const openvdb::Vec3d in_cell = openvdb::Vec3d(positions.get(*point)) * kShrink;
      const openvdb::Vec3d in_world = voxels_.indexToWorld(point.getCoord().asVec3d() + in_cell);
      const openvdb::Vec3d in_fog = density_.worldToIndex(in_world);
      if (!is_index(in_fog) || !fog_.isValueOn(openvdb::Coord::round(in_fog))) ++num_outside_;
    }
  }

  const PointDataGrid& voxels_;
  const FloatGrid& density_;
  FloatGrid::ConstAccessor fog_;
  std::size_t num_outside_ = 0;
};

// The fog of the points' level, or nullptr.
FloatGrid::ConstPtr density_beside(const CheckedFile& file, const PointDataGrid& voxels) {
  const auto grid = find_grid(file, "density" + role_of_grid(voxels).suffix);
  return grid && grid->isType<FloatGrid>() ? openvdb::gridConstPtrCast<FloatGrid>(grid) : nullptr;
}

}  // namespace

Finding check_density_and_color(const CheckedFile& file) {
  Finding finding;
  const auto require = [&](const std::string& name) {
    if (!find_grid(file, name)) finding.problems.push_back("no grid '" + name + "'");
  };
  require("density");
  for (const PointDataGrid::ConstPtr& grid : point_grids(file)) {
    const GridRole role = role_of_grid(*grid);
    if (role.channel != "voxels") continue;
    if (!role.suffix.empty()) require("density" + role.suffix);
    if (has_attribute(*grid, "Cd")) require("color" + role.suffix);
  }
  for (const auto& grid : file.grids) {
    const GridRole role = role_of_grid(*grid);
    const auto density = find_grid(file, "density" + role.suffix);
    if (role.channel != "color" || !density || grid->activeVoxelCount() == density->activeVoxelCount()) continue;
    finding.problems.push_back("grids '" + grid->getName() + "' and '" + density->getName() + "' differ in voxels");
  }
  return finding;
}

Finding check_point_attributes(const CheckedFile& file) {
  Finding finding;
  for (const PointDataGrid::ConstPtr& grid : point_grids(file)) check_attributes(*grid, file.is_ours, finding);
  return finding;
}

Finding check_known_point(const CheckedFile& file) {
  Finding finding;
  std::size_t num_checked = 0;
  for (const PointDataGrid::ConstPtr& voxels : point_grids(file)) {
    const FloatGrid::ConstPtr density = density_beside(file, *voxels);
    if (role_of_grid(*voxels).channel != "voxels" || !density || !has_attribute(*voxels, "P")) continue;
    KnownPointCheck(*voxels, *density).run(finding);
    num_checked += num_points(*voxels);
  }
  const bool has_means = find_grid(file, "mean") != nullptr;
  const openvdb::GridBase::ConstPtr density = find_grid(file, "density");
  const bool has_voxels = !density || density->activeVoxelCount() > 0;
  if (num_checked == 0 && !has_means && has_voxels)
    finding.problems.push_back("no points to compare with the voxels of 'density'");
  finding.remark = num_checked == 0 ? "means, no points" : std::to_string(num_checked) + " points";
  return finding;
}

}  // namespace vdbmap

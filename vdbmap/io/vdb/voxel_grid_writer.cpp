// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <memory>

#include "vdbmap/core/parallel.h"
#include "vdbmap/io/vdb/map_grids.h"
#include "vdbmap/io/vdb/voxel_attributes.h"
#include "vdbmap/io/vdb/voxel_grid.h"

namespace vdbmap {
namespace {

namespace points = openvdb::points;

constexpr int kFineLeavesPerAxis = kVoxelsPerCell;  // a leaf of cells covers as many leaves of voxels along an axis

// A voxel on its way into a leaf of cells.
struct PlacedVoxel {
  std::uint32_t cell;                     // offset in the leaf of cells
  std::array<std::uint16_t, 3> position;  // fixed-point code of the mean within the cell
  std::size_t record;
};

points::AttributeSet::Descriptor::Ptr make_descriptor(const VoxelLevel& level, bool has_color) {
  auto descriptor = points::AttributeSet::Descriptor::create(PositionArray::attributeType());
  const auto append = [&](const char* name, const openvdb::NamePair& type) {
    descriptor = descriptor->duplicateAppend(name, type);
  };
  append("cov_diag", VectorArray::attributeType());
  append("cov_offdiag", VectorArray::attributeType());
  append("count", IntArray::attributeType());
  append("N", NormalArray::attributeType());
  append("planarity", ShareArray::attributeType());
  if (has_color) append("Cd", VectorArray::attributeType());
  for_each_channel([&]<typename Value>(const char* name, std::vector<Value> VoxelChannels::*channel) {
    if (!(level.channels().*channel).empty()) append(name, ChannelArray<Value>::attributeType());
  });
  return descriptor;
}

PlacedVoxel place_voxel(const VoxelIndex& voxel, const VoxelIndex& leaf_of_cells, const VoxelRecord& record,
                        std::size_t number) {
  PlacedVoxel placed{0, {}, number};
  VoxelIndex cell;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t in_leaf = voxel[axis] - leaf_of_cells[axis] * kVoxelsPerCell;
    cell[axis] = in_leaf / kVoxelsPerCell;
    const std::int32_t in_cell = in_leaf % kVoxelsPerCell;
    placed.position[axis] = static_cast<std::uint16_t>(in_cell * kMeanSteps + record.mean_code[axis]);
  }
  placed.cell = static_cast<std::uint32_t>(cell.x() << 6 | cell.y() << 3 | cell.z());
  return placed;
}

// The voxels under one leaf of cells, sorted by cell, within a cell in the order of the records.
std::vector<PlacedVoxel> place_voxels(const VoxelLevel& level, const VoxelIndex& leaf_of_cells) {
  std::vector<PlacedVoxel> placed;
  const VoxelIndex first = first_child_of_voxel(leaf_of_cells, kVoxelsPerCell);
  for (int x = 0; x < kFineLeavesPerAxis; ++x) {
    for (int y = 0; y < kFineLeavesPerAxis; ++y) {
      for (int z = 0; z < kFineLeavesPerAxis; ++z) {
        const VoxelLeaf* leaf = level.tree().find_leaf(first.offsetBy(8 * x, 8 * y, 8 * z));
        if (!leaf) continue;
        for_each_voxel(*leaf, [&](const VoxelIndex& voxel, std::size_t number) {
          placed.push_back(place_voxel(voxel, leaf_of_cells, level.records()[number], number));
        });
      }
    }
  }
  std::sort(placed.begin(), placed.end(), [](const PlacedVoxel& a, const PlacedVoxel& b) {
    return a.cell != b.cell ? a.cell < b.cell : a.record < b.record;
  });
  return placed;
}

std::vector<PointLeaf::ValueType> offsets_of_cells(const std::vector<PlacedVoxel>& voxels) {
  std::vector<PointLeaf::ValueType> offsets(PointLeaf::SIZE);
  std::size_t count = 0;
  for (std::uint32_t cell = 0; cell < PointLeaf::SIZE; ++cell) {
    while (count < voxels.size() && voxels[count].cell == cell) ++count;
    offsets[cell] = PointLeaf::ValueType(static_cast<openvdb::Index32>(count));
  }
  return offsets;
}

void write_records(PointLeaf& leaf, const std::vector<PlacedVoxel>& voxels, std::span<const VoxelRecord> records) {
  CodeWriter<PositionArray> position(leaf, "P");
  CodeWriter<VectorArray> cov_diag(leaf, "cov_diag");
  CodeWriter<VectorArray> cov_offdiag(leaf, "cov_offdiag");
  CodeWriter<IntArray> count(leaf, "count");
  CodeWriter<NormalArray> normal(leaf, "N");
  CodeWriter<ShareArray> planarity(leaf, "planarity");
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    const VoxelRecord& record = records[voxels[i].record];
    const auto& c = record.covariance;
    position[i] = {voxels[i].position[0], voxels[i].position[1], voxels[i].position[2]};
    cov_diag[i] = {c[0], c[1], c[2]};
    cov_offdiag[i] = {c[3], c[4], c[5]};
    count[i] = static_cast<std::int32_t>(record.count);
    normal[i] = record.normal_code;
    planarity[i] = record.planarity_code;
  }
}

void write_colors(PointLeaf& leaf, const std::vector<PlacedVoxel>& voxels, std::span<const VoxelRecord> records) {
  CodeWriter<VectorArray> color(leaf, "Cd");
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    color[i] = openvdb::Vec3f(color_of(records[voxels[i].record]).cast<float>().eval().data());
  }
}

void write_channels(PointLeaf& leaf, const std::vector<PlacedVoxel>& voxels, const VoxelChannels& channels) {
  for_each_channel([&]<typename Value>(const char* name, std::vector<Value> VoxelChannels::*channel) {
    const std::vector<Value>& values = channels.*channel;
    if (values.empty()) return;
    CodeWriter<ChannelArray<Value>> codes(leaf, name);
    for (std::size_t i = 0; i < voxels.size(); ++i) codes[i] = values[voxels[i].record];
  });
}

// Cells that hold a voxel, as a tree whose leaves are then filled.
points::PointDataTree::Ptr make_cell_tree(const VoxelLevel& level) {
  openvdb::MaskTree cells;
  openvdb::tree::ValueAccessor<openvdb::MaskTree, false> accessor(cells);
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t) {
    accessor.setValueOn(parent_of_voxel(voxel, kVoxelsPerCell));
  });
  return std::make_shared<points::PointDataTree>(cells, 0, openvdb::TopologyCopy());
}

}  // namespace

points::PointDataGrid::Ptr make_voxel_grid(const VoxelLevel& level, bool has_color) {
  const points::PointDataTree::Ptr tree = make_cell_tree(level);
  const auto descriptor = make_descriptor(level, has_color);
  std::vector<PointLeaf*> leaves;
  tree->getNodes(leaves);
  parallel_for(leaves.size(), [&](std::size_t i) {
    PointLeaf& leaf = *leaves[i];
    const std::vector<PlacedVoxel> voxels = place_voxels(level, leaf.origin());
    auto attributes = std::make_unique<points::AttributeSet>(descriptor, static_cast<openvdb::Index>(voxels.size()));
    leaf.replaceAttributeSet(attributes.release(), /*allowMismatchingDescriptors=*/true);
    leaf.setOffsets(offsets_of_cells(voxels));
    write_records(leaf, voxels, level.records());
    if (has_color) write_colors(leaf, voxels, level.records());
    write_channels(leaf, voxels, level.channels());
  });
  auto grid = points::PointDataGrid::create(tree);
  grid->setTransform(transform_of_level(level.voxel_size() * kVoxelsPerCell));
  return grid;
}

}  // namespace vdbmap

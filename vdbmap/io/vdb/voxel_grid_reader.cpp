// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "vdbmap/core/error.h"
#include "vdbmap/core/parallel_tasks.h"
#include "vdbmap/core/voxel_assembly.h"
#include "vdbmap/io/vdb/channel_codes.h"
#include "vdbmap/io/vdb/map_grids.h"
#include "vdbmap/io/vdb/voxel_attributes.h"
#include "vdbmap/io/vdb/voxel_grid.h"
#include "vdbmap/io/vdb/voxels_of_file.h"

namespace vdbmap {
namespace {

namespace points = openvdb::points;

constexpr const char* kColor = "Cd";

// A voxel as the file gives it, in the order of the file.
struct ReadVoxel {
  VoxelIndex index;
  VoxelKey key;
  VoxelRecord record;
};

const points::AttributeArray* find_array(const PointLeaf& leaf, const char* name, const openvdb::NamePair& type) {
  const std::size_t position = leaf.attributeSet().find(name);
  if (position == points::AttributeSet::INVALID_POS) return nullptr;
  const points::AttributeArray* array = leaf.attributeSet().getConst(position);
  array->loadData();
  const bool usable = array->type() == type && array->stride() == 1 && array->size() == leaf.getLastValue();
  return usable ? array : nullptr;
}

// The attributes that a leaf has beyond the required ones.
std::vector<std::string> optional_attributes(const PointLeaf& leaf) {
  std::vector<std::string> names;
  if (find_array(leaf, kColor, VectorArray::attributeType())) names.emplace_back(kColor);
  for_each_channel([&]<typename Value>(const char* name, std::vector<Value> VoxelChannels::* /*channel*/) {
    if (find_array(leaf, name, ChannelArray<Value>::attributeType())) names.emplace_back(name);
  });
  return names;
}

// A leaf of the file, which lies in one block of voxels.
struct FileLeaf {
  BlockKey block;
  std::unique_ptr<PointLeaf> leaf;
};

// The voxels of a block.
struct ReadBlock {
  std::vector<ReadVoxel> voxels;
  VoxelChannels channels;            // in the order of the file
  std::vector<std::uint32_t> order;  // of the voxels in the tree
};

// Reads the leaves of one grid, block by block; every refusal names the grid and the attribute. What is read of the
// file is freed on the way: a map and its file would take two to three times the memory of the map.
class GridReader {
 public:
  GridReader(points::PointDataGrid& grid, const std::filesystem::path& path) : grid_(grid), path_(path) {}

  ReadLevel read() {
    check_transform();
    std::vector<FileLeaf> leaves = take_leaves();
    if (!leaves.empty()) optional_ = optional_attributes(*leaves.front().leaf);
    VoxelAssembly assembly(voxel_size_, count_voxels(leaves));
    std::ranges::stable_sort(leaves, {}, &FileLeaf::block);
    std::vector<ReadBlock> blocks(4 * num_threads());
    for (std::span<FileLeaf> rest = leaves; !rest.empty();) {
      std::vector<std::span<FileLeaf>> groups;
      while (!rest.empty() && groups.size() < blocks.size()) groups.push_back(take_block(rest));
      parallel_tasks(groups.size(), [&](std::size_t i) { blocks[i] = read_block(groups[i]); });
      for (std::size_t i = 0; i < groups.size(); ++i) append(assembly, blocks[i]);
    }
    return {assembly.finish(), has_optional(kColor)};
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw IoError::malformed(path_, "grid '" + grid_.getName() + "' " + reason);
  }

  // Another program may have moved, turned or scaled the grid.
  void check_transform() {
    const double found = grid_.voxelSize().x() / kVoxelsPerCell;
    voxel_size_ = exact_voxel_size(found).value_or(0);
    if (voxel_size_ == 0) fail("has voxels of " + std::to_string(found) + " m, " + std::string(kAllowedVoxelSizes));
    const std::string problem = problem_of_level_transform(grid_.transform(), voxel_size_ * kVoxelsPerCell);
    if (!problem.empty()) fail(problem);
    const auto stated = grid_.getMetadata<openvdb::DoubleMetadata>("voxel_size");
    if (!stated || std::abs(stated->value() - voxel_size_) <= 1e-6 * voxel_size_) return;
    fail("has voxels of " + std::to_string(voxel_size_) + " m, but says " + std::to_string(stated->value()) + " m");
  }

  template <typename Array>
  CodeReader<Array> require(const PointLeaf& leaf, const char* name) const {
    const points::AttributeArray* array = find_array(leaf, name, Array::attributeType());
    const auto& [value_type, codec] = Array::attributeType();
    if (!array) fail(std::string("lacks attribute '") + name + "' of type " + value_type + ", codec " + codec);
    return CodeReader<Array>(*array);
  }

  // Those with points, in the order of the file. The grid has none afterwards.
  std::vector<FileLeaf> take_leaves() {
    std::vector<PointLeaf*> stolen;
    grid_.tree().stealNodes(stolen);
    std::vector<std::unique_ptr<PointLeaf>> owned(stolen.begin(), stolen.end());
    std::vector<FileLeaf> leaves;
    for (std::unique_ptr<PointLeaf>& leaf : owned) {
      check_leaf(*leaf);
      if (leaf->getLastValue() == 0) continue;
      const BlockKey block = block_of_voxel(first_child_of_voxel(leaf->origin(), kVoxelsPerCell));
      leaves.push_back({block, std::move(leaf)});
    }
    return leaves;
  }

  // What the leaves promise, before memory is taken for it.
  std::size_t count_voxels(const std::vector<FileLeaf>& leaves) const {
    const std::uint64_t most = most_voxels_of_file(std::filesystem::file_size(path_));
    std::uint64_t count = 0;
    for (const FileLeaf& leaf : leaves) count += leaf.leaf->getLastValue();
    if (count > most) {
      fail("holds " + std::to_string(count) + " voxels, a file of its size at most " + std::to_string(most));
    }
    return count;
  }

  void check_leaf(const PointLeaf& leaf) const {
    constexpr std::uint64_t kMostVoxels =
        std::uint64_t{PointLeaf::SIZE} * kVoxelsPerCell * kVoxelsPerCell * kVoxelsPerCell;
    if (leaf.getLastValue() > kMostVoxels) {
      fail("has a leaf of " + std::to_string(leaf.getLastValue()) + " points, expected at most one for each of its " +
           std::to_string(kMostVoxels) + " voxels");
    }
    constexpr std::int32_t kMostCells = kIndexLimit / kVoxelsPerCell;
    const openvdb::Coord& origin = leaf.origin();
    const bool is_inside = std::min({origin.x(), origin.y(), origin.z()}) >= -kMostCells &&
                           std::max({origin.x(), origin.y(), origin.z()}) < kMostCells;
    if (!is_inside) fail("has a voxel beyond the addressable range");
  }

  // The leaves of the first block.
  static std::span<FileLeaf> take_block(std::span<FileLeaf>& rest) {
    const auto end = std::ranges::find_if(rest, [&](const FileLeaf& leaf) { return leaf.block != rest[0].block; });
    const auto count = static_cast<std::size_t>(end - rest.begin());
    const std::span<FileLeaf> block = rest.first(count);
    rest = rest.subspan(count);
    return block;
  }

  // The leaves are gone afterwards.
  ReadBlock read_block(std::span<FileLeaf> leaves) const {
    ReadBlock block;
    for (FileLeaf& leaf : leaves) {
      read_leaf(*leaf.leaf, block);
      leaf.leaf.reset();
    }
    block.order.resize(block.voxels.size());
    std::iota(block.order.begin(), block.order.end(), 0u);
    std::ranges::sort(block.order, {}, [&](std::uint32_t i) { return block.voxels[i].key; });
    return block;
  }

  void read_leaf(const PointLeaf& leaf, ReadBlock& block) const {
    const std::size_t first = block.voxels.size();
    block.voxels.resize(first + leaf.getLastValue());
    const std::span voxels = std::span(block.voxels).subspan(first);
    read_places(leaf, voxels);
    read_records(leaf, voxels);
    check_same_attributes(leaf);
    if (has_optional(kColor)) read_color(leaf, voxels);
    for_each_channel([&]<typename Value>(const char* name, std::vector<Value> VoxelChannels::*channel) {
      if (!has_optional(name)) return;
      const auto codes = require<ChannelArray<Value>>(leaf, name);
      for (std::size_t i = 0; i < voxels.size(); ++i) {
        if (!is_finite(codes[i])) fail(std::string("has a voxel whose ") + name + " is not finite");
        (block.channels.*channel).push_back(codes[i]);
      }
    });
  }

  bool has_optional(const std::string& name) const { return std::ranges::find(optional_, name) != optional_.end(); }

  // The cell and the fixed-point position in it give the voxel and the mean within it.
  void read_places(const PointLeaf& leaf, std::span<ReadVoxel> voxels) const {
    const auto position = require<PositionArray>(leaf, "P");
    std::size_t i = 0;
    for (openvdb::Index cell = 0; cell < PointLeaf::SIZE; ++cell) {
      const std::size_t end = leaf.getValue(cell);
      if (end < i || end > voxels.size()) fail("has broken point offsets");
      const VoxelIndex first_voxel = first_child_of_voxel(leaf.offsetToGlobalCoord(cell), kVoxelsPerCell);
      for (; i < end; ++i) place(voxels[i], first_voxel, position[i]);
    }
  }

  void place(ReadVoxel& voxel, const VoxelIndex& first_voxel, const openvdb::math::Vec3<std::uint16_t>& code) const {
    for (int axis = 0; axis < 3; ++axis) {
      voxel.index[axis] = first_voxel[axis] + code[axis] / kMeanSteps;
      voxel.record.mean_code[axis] = static_cast<std::uint16_t>(code[axis] % kMeanSteps);
    }
    if (!is_addressable(voxel.index)) fail("has a voxel beyond the addressable range");
    voxel.key = key_of_voxel(voxel.index);
  }

  void read_records(const PointLeaf& leaf, std::span<ReadVoxel> voxels) const {
    const auto cov_diag = require<VectorArray>(leaf, "cov_diag");
    const auto cov_offdiag = require<VectorArray>(leaf, "cov_offdiag");
    const auto count = require<IntArray>(leaf, "count");
    const auto normal = require<NormalArray>(leaf, "N");
    const auto planarity = require<ShareArray>(leaf, "planarity");
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      if (count[i] < 1) fail("has a voxel with count " + std::to_string(count[i]));
      const std::string_view problem = covariance_problem(cov_diag[i], cov_offdiag[i], voxel_size_);
      if (!problem.empty()) fail("has a voxel whose " + std::string(problem));
      VoxelRecord& record = voxels[i].record;
      record.covariance = {cov_diag[i].x(),    cov_diag[i].y(),    cov_diag[i].z(),
                           cov_offdiag[i].x(), cov_offdiag[i].y(), cov_offdiag[i].z()};
      record.count = static_cast<std::uint32_t>(count[i]);
      record.normal_code = normal[i];
      record.planarity_code = planarity[i];
    }
  }

  void check_same_attributes(const PointLeaf& leaf) const {
    if (optional_ != optional_attributes(leaf)) fail("has attributes that only some of its leaves have");
  }

  void read_color(const PointLeaf& leaf, std::span<ReadVoxel> voxels) const {
    const auto color = require<VectorArray>(leaf, kColor);
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      if (!is_finite(color[i])) fail("has a voxel whose colour is not finite");
      set_color(voxels[i].record, {color[i].x(), color[i].y(), color[i].z()});
    }
  }

  // From the order of cells into the order of voxels.
  void append(VoxelAssembly& assembly, const ReadBlock& block) const {
    for (const std::uint32_t i : block.order) {
      if (!assembly.add(block.voxels[i].index, block.voxels[i].record)) fail("holds a voxel twice");
    }
    for_each_channel([&](const char* /*name*/, auto channel) {
      const auto& values = block.channels.*channel;
      if (values.empty()) return;
      for (const std::uint32_t i : block.order) (assembly.channels().*channel).push_back(values[i]);
    });
  }

  points::PointDataGrid& grid_;
  const std::filesystem::path& path_;
  double voxel_size_ = 0;              // [m]
  std::vector<std::string> optional_;  // attributes that all leaves must have alike
};

}  // namespace

ReadLevel read_voxel_grid(points::PointDataGrid& grid, const std::filesystem::path& path) {
  return GridReader(grid, path).read();
}

}  // namespace vdbmap

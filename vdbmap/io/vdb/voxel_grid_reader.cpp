// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "vdbmap/core/error.h"
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

// Reads the leaves of one grid; every refusal names the grid and the attribute.
class GridReader {
 public:
  GridReader(const points::PointDataGrid& grid, const std::filesystem::path& path) : grid_(grid), path_(path) {}

  ReadLevel read() {
    check_transform();
    voxels_.reserve(count_voxels());
    for (auto leaf = grid_.tree().cbeginLeaf(); leaf; ++leaf) {
      if (leaf->getLastValue() > 0) read_leaf(*leaf);
    }
    return {assemble(), has_optional(kColor)};
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

  // What the leaves promise, before memory is taken for it.
  std::size_t count_voxels() const {
    const std::uint64_t most = most_voxels_of_file(std::filesystem::file_size(path_));
    std::uint64_t count = 0;
    for (auto leaf = grid_.tree().cbeginLeaf(); leaf; ++leaf) {
      check_leaf(*leaf);
      count += leaf->getLastValue();
    }
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

  void read_leaf(const PointLeaf& leaf) {
    const std::size_t first = voxels_.size();
    voxels_.resize(first + leaf.getLastValue());
    const std::span voxels = std::span(voxels_).subspan(first);
    read_places(leaf, voxels);
    read_records(leaf, voxels);
    check_same_attributes(leaf);
    if (has_optional(kColor)) read_color(leaf, voxels);
    for_each_channel([&]<typename Value>(const char* name, std::vector<Value> VoxelChannels::*channel) {
      if (!has_optional(name)) return;
      const auto codes = require<ChannelArray<Value>>(leaf, name);
      for (std::size_t i = 0; i < voxels.size(); ++i) {
        if (!is_finite(codes[i])) fail(std::string("has a voxel whose ") + name + " is not finite");
        (channels_.*channel).push_back(codes[i]);
      }
    });
  }

  bool has_optional(const std::string& name) const {
    return optional_ && std::ranges::find(*optional_, name) != optional_->end();
  }

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

  void check_same_attributes(const PointLeaf& leaf) {
    const std::vector<std::string> found = optional_attributes(leaf);
    if (optional_.value_or(found) != found) fail("has attributes that only some of its leaves have");
    optional_ = found;
  }

  void read_color(const PointLeaf& leaf, std::span<ReadVoxel> voxels) const {
    const auto color = require<VectorArray>(leaf, kColor);
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      if (!is_finite(color[i])) fail("has a voxel whose colour is not finite");
      set_color(voxels[i].record, {color[i].x(), color[i].y(), color[i].z()});
    }
  }

  // From the order of cells into the order of voxels.
  VoxelLevel assemble() const {
    std::vector<std::uint32_t> order(voxels_.size());
    std::iota(order.begin(), order.end(), 0u);
    parallel_sort(order, [&](auto a, auto b) { return voxels_[a].key < voxels_[b].key; });

    VoxelAssembly assembly(voxel_size_, voxels_.size());
    for (const std::uint32_t i : order) {
      if (!assembly.add(voxels_[i].index, voxels_[i].record)) fail("holds a voxel twice");
    }
    for_each_channel([&](const char* /*name*/, auto channel) {
      const auto& values = channels_.*channel;
      if (values.empty()) return;
      auto& ordered = assembly.channels().*channel;
      ordered.reserve(values.size());
      for (const std::uint32_t i : order) ordered.push_back(values[i]);
    });
    return assembly.finish();
  }

  const points::PointDataGrid& grid_;
  const std::filesystem::path& path_;
  double voxel_size_ = 0;  // [m]
  std::vector<ReadVoxel> voxels_;
  VoxelChannels channels_;
  std::optional<std::vector<std::string>> optional_;  // attributes that all leaves must have alike
};

}  // namespace

ReadLevel read_voxel_grid(const points::PointDataGrid& grid, const std::filesystem::path& path) {
  return GridReader(grid, path).read();
}

}  // namespace vdbmap

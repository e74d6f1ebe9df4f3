// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/normals.h"

#include <array>
#include <cmath>

#include "vdbmap/core/eigen_features.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap {
namespace {

// Count, sum of positions and of their products about one origin, padded to whole vector registers.
struct alignas(32) Sums {
  std::array<double, 12> values{};  // n, x y z, xx yy zz xy xz yz

  void add(const Sums& other) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += other.values[i];
  }
};

Sums sums_about(const VoxelRecord& record, const Eigen::Vector3d& mean) {
  const double n = record.count;
  const double rest = n - 1;
  const auto& c = record.covariance;
  return {{n, n * mean.x(), n * mean.y(), n * mean.z(), rest * c[0] + n * mean.x() * mean.x(),
           rest * c[1] + n * mean.y() * mean.y(), rest * c[2] + n * mean.z() * mean.z(),
           rest * c[3] + n * mean.x() * mean.y(), rest * c[4] + n * mean.x() * mean.z(),
           rest * c[5] + n * mean.y() * mean.z()}};
}

Eigen::Matrix3d covariance_of(const Sums& sums) {
  const auto& v = sums.values;
  const Eigen::Vector3d mean(v[1] / v[0], v[2] / v[0], v[3] / v[0]);
  Eigen::Matrix3d products;
  products << v[4], v[7], v[8], v[7], v[5], v[9], v[8], v[9], v[6];
  return (products - v[0] * mean * mean.transpose()) / (v[0] - 1);
}

// One leaf and the voxels around it, 10 x 10 x 10 cells, as numbers into a compact list of sums.
class LeafNeighborhood {
 public:
  explicit LeafNeighborhood(const VoxelLevel& level) : level_(level), accessor_(level.tree()) {}

  void load(const VoxelLeaf& leaf) {
    cells_.fill(kEmpty);
    sums_.clear();
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          const VoxelIndex step(x, y, z);
          const VoxelLeaf* neighbor = accessor_.probeConstLeaf(leaf.origin() + VoxelIndex(8 * x, 8 * y, 8 * z));
          if (neighbor) load_part(*neighbor, step);
        }
      }
    }
  }

  // Sums over the 27 cells around the voxel of the leaf at `offset`.
  Sums around(openvdb::Index offset) const {
    const int cell =
        cell_of(static_cast<int>(offset >> 6), static_cast<int>(offset >> 3 & 7), static_cast<int>(offset & 7));
    Sums total;
    for (const int x : {-100, 0, 100}) {
      for (const int y : {-10, 0, 10}) {
        for (const int z : {-1, 0, 1}) {
          const std::int16_t number = cells_[cell + x + y + z];
          if (number != kEmpty) total.add(sums_[number]);
        }
      }
    }
    return total;
  }

 private:
  static constexpr std::int16_t kEmpty = -1;

  static int cell_of(int x, int y, int z) { return (x + 1) * 100 + (y + 1) * 10 + z + 1; }

  // The cells of a neighbour that touch the leaf: one layer of a side neighbour, all of the leaf itself.
  void load_part(const VoxelLeaf& neighbor, const VoxelIndex& step) {
    const VoxelIndex shift(8 * step.x(), 8 * step.y(), 8 * step.z());
    const auto first = [&](int axis) { return step[axis] < 0 ? 7 : 0; };
    const auto last = [&](int axis) { return step[axis] > 0 ? 0 : 7; };
    for (int x = first(0); x <= last(0); ++x) {
      const auto layer = neighbor.getValueMask().getWord<openvdb::Index64>(static_cast<openvdb::Index>(x));
      if (layer == 0) continue;
      for (int y = first(1); y <= last(1); ++y) {
        const auto row = static_cast<std::uint8_t>(layer >> (8 * y));
        if (row == 0) continue;
        for (int z = first(2); z <= last(2); ++z) {
          if (row >> z & 1) load_voxel(neighbor, VoxelIndex(x, y, z), VoxelIndex(x, y, z) + shift);
        }
      }
    }
  }

  void load_voxel(const VoxelLeaf& leaf, const VoxelIndex& in_leaf, const VoxelIndex& from_origin) {
    const auto offset = static_cast<openvdb::Index>(in_leaf.x() << 6 | in_leaf.y() << 3 | in_leaf.z());
    const VoxelRecord& record = level_.records()[leaf.transientData() + rank_in_leaf(leaf, offset)];
    const double size = level_.voxel_size();
    const Eigen::Vector3d mean = mean_of(record, from_origin, size) - center_of_voxel(VoxelIndex(4, 4, 4), size);
    cells_[cell_of(from_origin.x(), from_origin.y(), from_origin.z())] = static_cast<std::int16_t>(sums_.size());
    sums_.push_back(sums_about(record, mean));
  }

  const VoxelLevel& level_;
  openvdb::tree::ValueAccessor<const VoxelTree, false> accessor_;
  std::array<std::int16_t, 1000> cells_;
  std::vector<Sums> sums_;
};

void set_plane(VoxelRecord& record, const Sums& neighborhood) {
  const PlaneFit plane = neighborhood.values[0] < 3 ? PlaneFit() : fit_plane(covariance_of(neighborhood));
  set_normal(record, plane.normal);
  record.planarity_code = static_cast<std::uint8_t>(std::lround(plane.planarity * 255));
}

}  // namespace

void compute_normals(VoxelLevel& level) {
  const std::vector<const VoxelLeaf*> leaves = level.leaves();
  parallel_ranges(leaves.size(), 32, [&](std::size_t begin, std::size_t end) {
    LeafNeighborhood neighborhood(level);
    for (std::size_t i = begin; i < end; ++i) {
      neighborhood.load(*leaves[i]);
      std::size_t record = leaves[i]->transientData();
      for (auto voxel = leaves[i]->getValueMask().beginOn(); voxel; ++voxel) {
        set_plane(level.records()[record++], neighborhood.around(voxel.pos()));
      }
    }
  });
}

}  // namespace vdbmap

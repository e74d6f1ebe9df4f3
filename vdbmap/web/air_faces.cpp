// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/air_faces.h"

#include <array>
#include <cstddef>

#include "vdbmap/core/parallel.h"

namespace vdbmap {
namespace {

// A leaf's layers x of 8 x 8 voxels, bit 8 y + z.
using Layers = std::array<std::uint64_t, 8>;

Layers layers_of(const VoxelLeaf* leaf) {
  Layers layers{};
  if (leaf == nullptr) return layers;
  for (std::size_t x = 0; x < layers.size(); ++x) {
    layers[x] = leaf->getValueMask().getWord<openvdb::Index64>(static_cast<openvdb::Index>(x));
  }
  return layers;
}

constexpr std::uint64_t kLowestZ = 0x0101010101010101;
constexpr std::uint64_t kHighestZ = 0x8080808080808080;

// Which voxels of a leaf have a neighbour behind each face, a layer a word.
std::array<Layers, 6> covered_faces(const VoxelTree& tree, const VoxelLeaf& leaf) {
  constexpr std::int32_t kLeaf = VoxelLeaf::DIM;
  const auto beside = [&](std::int32_t x, std::int32_t y, std::int32_t z) {
    return layers_of(tree.find_leaf(leaf.origin().offsetBy(x * kLeaf, y * kLeaf, z * kLeaf)));
  };
  const Layers own = layers_of(&leaf);
  const Layers below_x = beside(-1, 0, 0), above_x = beside(1, 0, 0);
  const Layers below_y = beside(0, -1, 0), above_y = beside(0, 1, 0);
  const Layers below_z = beside(0, 0, -1), above_z = beside(0, 0, 1);

  std::array<Layers, 6> covered;
  for (std::size_t x = 0; x < own.size(); ++x) {
    covered[0][x] = x > 0 ? own[x - 1] : below_x[7];
    covered[1][x] = x < 7 ? own[x + 1] : above_x[0];
    covered[2][x] = own[x] << 8 | below_y[x] >> 56;
    covered[3][x] = own[x] >> 8 | above_y[x] << 56;
    covered[4][x] = (own[x] & ~kHighestZ) << 1 | (below_z[x] & kHighestZ) >> 7;
    covered[5][x] = (own[x] & ~kLowestZ) >> 1 | (above_z[x] & kLowestZ) << 7;
  }
  return covered;
}

}  // namespace

std::vector<AirFaces> air_faces(const VoxelLevel& level) {
  std::vector<AirFaces> faces(level.size());
  const std::span<const VoxelLeaf> leaves = level.leaves();
  parallel_for(
      leaves.size(),
      [&](std::size_t i) {
        const std::array<Layers, 6> covered = covered_faces(level.tree(), leaves[i]);
        for_each_voxel(leaves[i], [&](const VoxelIndex& voxel, std::size_t record) {
          const std::size_t layer = voxel.x() & 7;
          const int bit = (voxel.y() & 7) << 3 | (voxel.z() & 7);
          AirFaces open = 0;
          for (std::size_t face = 0; face < covered.size(); ++face) {
            open |= static_cast<AirFaces>((~covered[face][layer] >> bit & 1) << face);
          }
          faces[record] = open;
        });
      },
      64);
  return faces;
}

}  // namespace vdbmap

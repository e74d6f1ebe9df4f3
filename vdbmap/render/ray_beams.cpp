// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/ray_beams.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <openvdb/tools/Morphology.h>

#ifndef __clang__  // see io/vdb/standard_grids.h
extern template class openvdb::tree::Tree<openvdb::MaskTree::RootNodeType>;
#endif

namespace vdbmap {
namespace {

constexpr int kLog2Leaf = VoxelLeaf::LOG2DIM;

VoxelTree leaves_and_neighbors(const VoxelLevel& level) {
  openvdb::MaskTree tree;
  openvdb::tree::ValueAccessor<openvdb::MaskTree> accessor(tree);
  for (const VoxelLeaf& leaf : level.leaves()) accessor.setValueOn(leaf.origin() >> kLog2Leaf);
  openvdb::tools::dilateActiveValues(tree, 1, openvdb::tools::NN_FACE_EDGE_VERTEX);
  tree.voxelizeActiveTiles();  // what dilation filled wholly
  LargeVector<VoxelLeaf> leaves;
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) leaves.push_back(*leaf);
  return VoxelTree(std::move(leaves));
}

double reach_of(const Camera& camera, double half_tile, double leaf_size) {
  const double half_diagonal = std::numbers::sqrt2 * half_tile * camera.pixel_width();
  if (camera.is_perspective()) return 0.99 * leaf_size / half_diagonal;  // apart by at most that angle
  return half_diagonal < 0.99 * leaf_size ? std::numeric_limits<double>::infinity() : 0;
}

}  // namespace

RayBeams::RayBeams(const VoxelLevel& level, const Camera& camera, int tile_size)
    : leaf_size_(level.voxel_size() * (1 << kLog2Leaf)),
      leaves_(leaves_and_neighbors(level)),
      caster_(leaves_, leaf_size_),
      camera_(camera),
      half_tile_(tile_size / 2.0),
      reach_(reach_of(camera, half_tile_, leaf_size_)) {}

double RayBeams::free_distance(int left, int top) const {
  const Ray ray = camera_.ray_through({left + half_tile_, top + half_tile_});
  const Eigen::Vector3d begin = ray.origin / leaf_size_;
  const VoxelIndex cell(static_cast<int>(std::floor(begin.x())), static_cast<int>(std::floor(begin.y())),
                        static_cast<int>(std::floor(begin.z())));
  const VoxelLeaf* leaf = leaves_.find_leaf(cell);
  if (leaf && leaf->isValueOn(cell)) return 0;
  const auto hit = caster_.first_hit(ray, {0, reach_});
  return hit ? hit->distance : reach_;
}

}  // namespace vdbmap

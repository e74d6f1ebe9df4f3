// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/tree/LeafNodeMask.h>
#include <openvdb/tree/Tree.h>

namespace vdbmap {

/// Which voxels are occupied: an OpenVDB tree of bit masks.
using VoxelTree = openvdb::tree::Tree4<openvdb::ValueMask, 5, 4, 3>::Type;
using VoxelLeaf = VoxelTree::LeafNodeType;

}  // namespace vdbmap

// OpenVDB's library holds this tree, compiled: no need to compile it again in each file that uses it.
extern template class openvdb::tree::Tree<vdbmap::VoxelTree::RootNodeType>;

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_block.h"

namespace vdbmap {

BlockSums merge_blocks(BlockSums a, BlockSums b) {
  if (a.empty()) return b;
  if (b.empty()) return a;

  BlockSums merged;
  merged.reserve(a.size() + b.size() / 2);
  auto next_a = a.begin();
  auto next_b = b.begin();
  while (next_a != a.end() && next_b != b.end()) {
    if (next_a->key < next_b->key) {
      merged.push_back(*next_a++);
    } else if (next_b->key < next_a->key) {
      merged.push_back(*next_b++);
    } else {
      merged.push_back(*next_a++);
      merged.back().sums.add(next_b++->sums);
    }
  }
  merged.insert(merged.end(), next_a, a.end());
  merged.insert(merged.end(), next_b, b.end());
  return merged;
}

void BlockLeaves::add(KeyInBlock voxel) {
  if (voxel >> 9 != leaf_of_last_) {
    leaf_of_last_ = voxel >> 9;
    leaves_.emplace_back(origin_ + leaf_origin_in_block(voxel));
  }
  leaves_.back().setValueOn(offset_in_leaf(voxel));
}

}  // namespace vdbmap

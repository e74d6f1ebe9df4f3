// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/cell_table.h"

#include <map>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"

namespace vdbmap::registration {
namespace {

TEST(Cell, HoldsAllIndicesOfAVoxel) {
  for (const VoxelIndex& voxel :
       {VoxelIndex(0, 0, 0), VoxelIndex(1, -2, 3), VoxelIndex(-kIndexLimit, 5, kIndexLimit - 1)}) {
    EXPECT_EQ(voxel_of_cell(cell_of(voxel)), voxel);
  }
}

TEST(Cell, AStepLeadsToTheNeighbor) {
  const VoxelIndex voxel(0, -1, 7);
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        EXPECT_EQ(voxel_of_cell(cell_of(voxel) + cell_step(x, y, z)), voxel.offsetBy(x, y, z));
      }
    }
  }
}

TEST(CellTable, KeepsTheFirstNumberOfEveryCellWhileItGrows) {
  CellTable table;
  std::map<Cell, std::uint32_t> expected;
  std::uint32_t number = 0;
  for (const VoxelIndex& voxel : test::random_voxels(5000, -9, 9, 1)) {
    const Cell cell = cell_of(voxel);
    const auto [entry, is_new] = expected.emplace(cell, number);
    EXPECT_EQ(table.find_or_insert(cell, number), entry->second);
    EXPECT_EQ(table.find_or_insert(cell, number + 1'000'000), entry->second);
    ++number;
  }
  EXPECT_EQ(table.size(), expected.size());
  for (const auto& [cell, first_number] : expected) EXPECT_EQ(table.find(cell), first_number);
  EXPECT_EQ(table.find(cell_of({100, 0, 0})), CellTable::kNone);
}

TEST(CellTable, ForgetsAllWhenCleared) {
  CellTable table(1);
  table.find_or_insert(cell_of({1, 2, 3}), 4);
  table.clear();
  EXPECT_EQ(table.size(), 0U);
  EXPECT_EQ(table.find(cell_of({1, 2, 3})), CellTable::kNone);
}

}  // namespace
}  // namespace vdbmap::registration

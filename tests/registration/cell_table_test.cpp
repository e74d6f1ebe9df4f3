// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/cell_table.h"

#include <map>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"

namespace vdbmap::registration {
namespace {

TEST(CellTable, KeepsTheFirstNumberOfEveryCellWhileItGrows) {
  CellTable table;
  std::map<VoxelId, std::uint32_t> expected;
  std::uint32_t number = 0;
  for (const VoxelIndex& voxel : test::random_voxels(5000, -9, 9, 1)) {
    const VoxelId cell = id_of_voxel(voxel);
    const auto [entry, is_new] = expected.emplace(cell, number);
    EXPECT_EQ(table.find_or_insert(cell, number), entry->second);
    EXPECT_EQ(table.find_or_insert(cell, number + 1'000'000), entry->second);
    ++number;
  }
  EXPECT_EQ(table.size(), expected.size());
  for (const auto& [cell, first_number] : expected) EXPECT_EQ(table.find(cell), first_number);
  EXPECT_EQ(table.find(id_of_voxel({100, 0, 0})), CellTable::kNone);
}

TEST(CellTable, ForgetsAllWhenCleared) {
  CellTable table(1);
  table.find_or_insert(id_of_voxel({1, 2, 3}), 4);
  table.clear();
  EXPECT_EQ(table.size(), 0U);
  EXPECT_EQ(table.find(id_of_voxel({1, 2, 3})), CellTable::kNone);
}

}  // namespace
}  // namespace vdbmap::registration

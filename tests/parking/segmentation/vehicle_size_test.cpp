// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/segmentation/vehicle_size.h"

#include <gtest/gtest.h>

#include "tests/support/sample_maps.h"

namespace vdbmap::parking {
namespace {

// A solid block of voxels.
struct Block {
  VoxelIndex low, high;
};

// Whether the voxels of each block are still a vehicle after all were said to be one; vegetation came second.
std::vector<bool> stay(const std::vector<Block>& blocks) {
  std::vector<VoxelIndex> voxels;
  for (const Block& block : blocks) {
    for (auto voxel = openvdb::CoordBBox(block.low, block.high).beginXYZ(); voxel; ++voxel) voxels.push_back(*voxel);
  }
  const VoxelMap map = test::map_of_voxels(voxels);
  const VoxelLevel& level = map.finest();
  std::vector<SurfaceClass> classes(level.size(), SurfaceClass::kVehicle);
  const std::vector<SurfaceClass> second(level.size(), SurfaceClass::kVegetation);
  drop_what_is_no_vehicle(level, second, classes);
  std::vector<bool> result;
  for (const Block& block : blocks) {
    std::size_t num_vehicle = 0, num_all = 0;
    for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
      if (!openvdb::CoordBBox(block.low, block.high).isInside(voxel)) return;
      ++num_all;
      num_vehicle += classes[number] == SurfaceClass::kVehicle ? 1 : 0;
    });
    EXPECT_TRUE(num_vehicle == 0 || num_vehicle == num_all);
    result.push_back(num_vehicle > 0);
  }
  return result;
}

TEST(VehicleSize, IsAMetreAndAHalfAtLeastInAnyDirection) {
  EXPECT_EQ(stay({{{0, 0, 0}, {15, 3, 8}}}), std::vector<bool>{true});
  EXPECT_EQ(stay({{{0, 0, 0}, {3, 15, 8}}}), std::vector<bool>{true});
  EXPECT_EQ(stay({{{-7, -2, 0}, {6, 2, 8}}}), std::vector<bool>{false});
  std::vector<Block> diagonal;  // 1.1 m on each axis, 1.56 m along itself
  for (int i = 0; i < 12; ++i) diagonal.push_back({{i, i, 0}, {i, i, 5}});
  EXPECT_TRUE(stay(diagonal).front());
}

TEST(VehicleSize, IsFourMetresAndAHalfInHeightAtMost) {
  EXPECT_EQ(stay({{{0, 0, 0}, {60, 20, 40}}}), std::vector<bool>{true});
  EXPECT_EQ(stay({{{0, 0, 0}, {60, 20, 47}}}), std::vector<bool>{false});
}

TEST(VehicleSize, PartsUpToSixtyCentimetresApartAreOne) {
  EXPECT_EQ(stay({{{0, 0, 0}, {8, 5, 5}}, {{14, 0, 0}, {20, 5, 5}}}), (std::vector<bool>{true, true}));
  EXPECT_EQ(stay({{{0, 0, 0}, {8, 5, 5}}, {{15, 0, 0}, {21, 5, 5}}}), (std::vector<bool>{false, false}));
}

}  // namespace
}  // namespace vdbmap::parking

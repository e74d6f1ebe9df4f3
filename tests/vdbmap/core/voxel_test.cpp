// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel.h"

#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"

namespace vdbmap {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Voxel, FloorDivisionIsTheLargestQuotientNotAbove) {
  for (std::int32_t divisor = 1; divisor <= 12; ++divisor) {
    for (std::int32_t dividend = -50; dividend <= 50; ++dividend) {
      const std::int32_t quotient = floor_divide(dividend, divisor);
      EXPECT_LE(quotient * divisor, dividend) << dividend << " / " << divisor;
      EXPECT_GT((quotient + 1) * divisor, dividend) << dividend << " / " << divisor;
    }
  }
}

TEST(Voxel, ALowerCornerBelongsToItsVoxelAndAnUpperCornerToTheNext) {
  for (const std::int32_t i : {-1'048'576, -641, -1, 0, 1, 640, 1'048'575}) {
    const VoxelIndex voxel(i, 0, -i - 1);
    const Eigen::Vector3d corner = corner_of_voxel(voxel, 0.125);  // 2^-3: exact
    EXPECT_EQ(voxel_of_point(corner, 8), voxel);
    EXPECT_EQ(voxel_of_point(corner + Eigen::Vector3d(0.125, 0, 0), 8), voxel.offsetBy(1, 0, 0));
    EXPECT_EQ(voxel_of_point(corner - Eigen::Vector3d(0, 1e-9, 0), 8), voxel.offsetBy(0, -1, 0));
  }
}

TEST(Voxel, DecimalCoordinatesOnABorderBelongToTheUpperVoxel) {
  // (i / 10.0) * 10 is i again (Goldberg 1991, theorem 7), so that what a text file calls 0.3 m starts voxel 3.
  for (std::int32_t i = -20'000; i < 20'000; ++i) {
    EXPECT_EQ(voxel_of_point({i / 10.0, 0, 0}, voxels_per_metre(0.1)).x(), i);
  }
}

TEST(Voxel, ThePointsOfAVoxelLieWithinHalfAnEdgeOfItsCentre) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d::Constant(-70), Eigen::Vector3d::Constant(70));
  for (const double size : {0.05, 0.1, 0.32, 1.0, 8.0}) {
    for (const Eigen::Vector3d& point : test::random_points(2000, box, 1)) {
      const VoxelIndex voxel = voxel_of_point(point, voxels_per_metre(size));
      const Eigen::Vector3d from_center = point - center_of_voxel(voxel, size);
      const double rounding = 1e-13;  // of 70 m
      EXPECT_LE(from_center.cwiseAbs().maxCoeff(), size / 2 + rounding);
      EXPECT_TRUE(center_of_voxel(voxel, size)
                      .isApprox(corner_of_voxel(voxel, size) + Eigen::Vector3d::Constant(size / 2), 1e-12));
    }
  }
}

TEST(Voxel, AParentCoversItsChildrenAndNoOthers) {
  for (const std::int32_t factor : {2, 3, 10}) {
    for (std::int32_t parent = -4; parent <= 4; ++parent) {
      const VoxelIndex first = first_child_of_voxel({parent, -parent, 7}, factor);
      for (std::int32_t step = -1; step <= factor; ++step) {
        const bool inside = step >= 0 && step < factor;
        EXPECT_EQ(parent_of_voxel(first.offsetBy(step, 0, 0), factor) == VoxelIndex(parent, -parent, 7), inside);
        EXPECT_EQ(parent_of_voxel(first.offsetBy(0, step, 0), factor) == VoxelIndex(parent, -parent, 7), inside);
        EXPECT_EQ(parent_of_voxel(first.offsetBy(0, 0, step), factor) == VoxelIndex(parent, -parent, 7), inside);
      }
    }
  }
}

TEST(Voxel, TheParentOfAPointsVoxelIsThePointsVoxelInTheLevelAbove) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d::Constant(-30), Eigen::Vector3d::Constant(30));
  for (const Eigen::Vector3d& point : test::random_points(5000, box, 2)) {
    EXPECT_EQ(parent_of_voxel(voxel_of_point(point, 10), 10), voxel_of_point(point, 1));
  }
}

TEST(Voxel, AddressesReachTwentyOneBits) {
  const double last = kIndexLimit - 0.5;
  EXPECT_TRUE(is_addressable(Eigen::Vector3d(last, -kIndexLimit, 0) / 10, 10));
  EXPECT_FALSE(is_addressable(Eigen::Vector3d(0, kIndexLimit, 0) / 10, 10));
  EXPECT_FALSE(is_addressable(Eigen::Vector3d(0, 0, -kIndexLimit - 0.5) / 10, 10));
  EXPECT_TRUE(is_addressable(VoxelIndex(kIndexLimit - 1, -kIndexLimit, 0)));
  EXPECT_FALSE(is_addressable(VoxelIndex(kIndexLimit, 0, 0)));
  EXPECT_FALSE(is_addressable(VoxelIndex(0, -kIndexLimit - 1, 0)));
}

TEST(Voxel, PointsThatAreNotFiniteHaveNoAddress) {
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    EXPECT_FALSE(is_addressable(Eigen::Vector3d(bad, 0, 0), 10));
    EXPECT_FALSE(is_addressable(Eigen::Vector3d(0, bad, 0), 10));
    EXPECT_FALSE(is_addressable(Eigen::Vector3d(0, 0, bad), 10));
  }
}

TEST(Voxel, SizesOfWhichATileIsAWholeNumberOfLeavesAreExactNumbersPerMetre) {
  EXPECT_EQ(voxels_per_metre(0.1), 10.0);
  EXPECT_EQ(voxels_per_metre(0.05), 20.0);
  EXPECT_EQ(voxels_per_metre(0.001), 1000.0);
  EXPECT_EQ(voxels_per_metre(0.2), 5.0);
  EXPECT_EQ(voxels_per_metre(0.8), 1.25);
  EXPECT_EQ(voxels_per_metre(8), 1 / 8.0);
  EXPECT_EQ(voxels_per_metre(64.0 / 600), 9.375);
}

// Another anchor moves voxels by whole tiles, and records lie leaf by leaf: a tile of 100 voxels of 0.64 m would move
// half a leaf.
TEST(Voxel, AnotherAnchorMovesWholeLeaves) {
  for (int per_tile = 1; per_tile <= 6400; ++per_tile) {
    const double size = kTileSize / per_tile;
    if (per_tile % 8 == 0) {
      EXPECT_NEAR(voxels_per_metre(size) * kTileSize, per_tile, 1e-9);
    } else {
      EXPECT_THROW(voxels_per_metre(size), std::invalid_argument) << size;
    }
  }
}

TEST(Voxel, SizesOfWhichATileIsNoWholeNumberOfLeavesAreRefused) {
  for (const double size : {0.3, 0.15, 0.7, 0.1001, 3.0, 0.0, -0.1, 0.0005, 0.64, 3.2, 16.0, 64.0, 65.0, 128.0, kNaN,
                            kInfinity, -kInfinity}) {
    EXPECT_THROW(voxels_per_metre(size), std::invalid_argument) << size;
  }
  try {
    voxels_per_metre(0.64);
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "voxel size is 0.64 m, expected 0.001 to 8 m that divide 8 m, like 0.05, 0.1, 0.2, 0.5, 1, 2");
  }
}

TEST(Voxel, LevelsAreWholeMultiplesFromTwoOn) {
  EXPECT_EQ(level_factor(0.1, 1.0), 10);
  EXPECT_EQ(level_factor(0.1, 0.2), 2);
  EXPECT_EQ(level_factor(64.0 / 600, 0.32), 3);
  EXPECT_EQ(level_factor(0.001, 64), 64000);
  for (const auto& [fine, coarse] : std::vector<std::pair<double, double>>{
           {0.1, 0.1}, {0.1, 0.25}, {1.0, 0.1}, {0.1, -1.0}, {0.1, kNaN}, {kNaN, 1.0}, {0.1, 1.0000001}}) {
    EXPECT_THROW(level_factor(fine, coarse), std::invalid_argument) << fine << ' ' << coarse;
  }
}

}  // namespace
}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/camera_choice.h"

#include <algorithm>
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/sample_maps.h"

namespace vdbmap {
namespace {

// A street of 120 m in the direction of (3, 1) with houses on one side of one half: nothing about it is symmetric.
VoxelMap long_street() {
  std::vector<VoxelIndex> voxels;
  for (int i = 0; i < 1200; i += 3) {
    for (int j = -40; j < 40; j += 4) voxels.emplace_back(i, i / 3 + j, 0);
    for (int k = 1; k < 80; k += 4) {
      if (i < 500) voxels.emplace_back(i, i / 3 + 45, k);
    }
  }
  return test::map_of_voxels(voxels);
}

struct Framing {
  double share_shown = 0;
  Eigen::AlignedBox2d box;  // of all voxels but half a percent on each side [share of the picture]
};

Framing framing_of(const VoxelLevel& level, const Camera& camera) {
  Framing framing;
  std::array<std::vector<double>, 2> shares;
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t) {
    const auto place = camera.project(center_of_voxel(voxel, level.voxel_size()));
    if (!place) return;
    const Eigen::Vector2d share(place->pixel.x() / camera.size().width, place->pixel.y() / camera.size().height);
    if ((share.array() >= 0).all() && (share.array() <= 1).all())
      framing.share_shown += 1.0 / static_cast<double>(level.size());
    for (const int axis : {0, 1}) shares[axis].push_back(share[axis]);
  });
  for (const int axis : {0, 1}) {
    std::ranges::sort(shares[axis]);
    const std::size_t num_outside = shares[axis].size() / 200;
    framing.box.min()[axis] = shares[axis][num_outside];
    framing.box.max()[axis] = shares[axis][shares[axis].size() - 1 - num_outside];
  }
  return framing;
}

class OrbitFrom : public testing::TestWithParam<std::vector<double>> {};

TEST_P(OrbitFrom, TheMapFillsThePictureAndLiesInItsMiddle) {
  const VoxelMap map = long_street();
  for (const ImageSize& size : {ImageSize{1920, 1080}, ImageSize{400, 900}}) {
    const Framing framing = framing_of(map.finest(), choose_camera(map.finest(), View::kOrbit, size, GetParam()));
    EXPECT_GT(framing.share_shown, 0.98);
    EXPECT_LT((framing.box.center() - Eigen::Vector2d(0.5, 0.5)).cwiseAbs().maxCoeff(), 0.03);
    // 0.94 between the margins, less the size of the nearest voxels, which a view along the street has before it.
    EXPECT_GT(framing.box.sizes().maxCoeff(), 0.85);
  }
}

TEST(OrbitOfFewVoxels, StaysOutsideOfThem) {
  for (const std::vector<VoxelIndex>& voxels :
       {std::vector<VoxelIndex>{{0, 0, 0}}, {{0, 0, 0}, {0, 0, 9}}, {{0, 0, 0}, {5, 0, 0}, {0, 7, 0}, {0, 0, 3}}}) {
    const VoxelMap map = test::map_of_voxels(voxels);
    for (const std::vector<double>& numbers : {std::vector<double>{}, {0, -90}, {30, 0}}) {
      const Camera camera = choose_camera(map.finest(), View::kOrbit, {640, 480}, numbers);
      for (const VoxelIndex& voxel : voxels) {
        for (const int x : {0, 1}) {
          for (const int y : {0, 1}) {
            const auto place = camera.project(corner_of_voxel(voxel.offsetBy(x, y, 1), 0.1));
            ASSERT_TRUE(place);
            EXPECT_TRUE((place->pixel.array() > 0).all() && place->pixel.x() < 640 && place->pixel.y() < 480);
          }
        }
      }
    }
  }
}

TEST(PlanCamera, TheMapFillsThePictureAndLiesInItsMiddle) {
  const VoxelMap map = long_street();
  for (const ImageSize& size : {ImageSize{1920, 1080}, ImageSize{400, 900}}) {
    const Framing framing = framing_of(map.finest(), choose_camera(map.finest(), View::kPlan, size));
    EXPECT_GT(framing.share_shown, 0.99);
    EXPECT_LT((framing.box.center() - Eigen::Vector2d(0.5, 0.5)).cwiseAbs().maxCoeff(), 0.02);
    EXPECT_GT(framing.box.sizes().maxCoeff(), 0.9);
  }
}

INSTANTIATE_TEST_SUITE_P(, OrbitFrom,
                         testing::Values(std::vector<double>{}, std::vector<double>{0, -40},
                                         std::vector<double>{200, -20}, std::vector<double>{90, -80}));

}  // namespace
}  // namespace vdbmap

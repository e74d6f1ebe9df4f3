// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/segmentation/voxel_pyramid.h"

#include <algorithm>
#include <map>
#include <tuple>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"
#include "tests/support/sample_maps.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap::parking {
namespace {

using Place = std::tuple<int, int, int>;

Place place_of(const VoxelIndex& voxel) { return {voxel.x(), voxel.y(), voxel.z()}; }

// Means and counts of the voxels of a size, from the points alone.
struct Sum {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
};

std::map<Place, Sum> voxels_of(const PointCloud& cloud, double size) {
  std::map<Place, Sum> voxels;
  for (const Eigen::Vector3d& point : cloud.positions) {
    Sum& voxel = voxels[place_of(voxel_of_point(point, 1 / size))];
    voxel.sum += point;
    ++voxel.count;
  }
  return voxels;
}

// Of all occupied voxels the nearest 28 up to 2.5 voxels away, in the order that voxel_pyramid.h promises.
std::vector<VoxelIndex> steps_by_brute_force(const std::map<Place, Sum>& voxels, const Place& voxel) {
  std::vector<std::tuple<int, int, int, int>> near;
  for (const auto& [place, sum] : voxels) {
    const int x = std::get<0>(place) - std::get<0>(voxel), y = std::get<1>(place) - std::get<1>(voxel),
              z = std::get<2>(place) - std::get<2>(voxel);
    if (x * x + y * y + z * z <= 6.25) near.emplace_back(x * x + y * y + z * z, x, y, z);
  }
  std::ranges::sort(near);
  std::vector<VoxelIndex> steps;
  for (std::size_t i = 0; i < std::min<std::size_t>(near.size(), 28); ++i) {
    steps.emplace_back(std::get<1>(near[i]), std::get<2>(near[i]), std::get<3>(near[i]));
  }
  return steps;
}

class VoxelPyramids : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    cloud_ = test::random_cloud(3000, {Eigen::Vector3d(-2, -1.5, -0.6), Eigen::Vector3d(1.5, 1.4, 0.5)}, 5);
    map_ = test::fine_map_of(cloud_);
    pyramid_ = make_pyramid(map_.finest());
  }

  static inline PointCloud cloud_;
  static inline VoxelMap map_;
  static inline VoxelPyramid pyramid_;
};

// Voxels are told apart by their means; numbers of the finest level are those of the map.
TEST_F(VoxelPyramids, HaveTheMeansNeighboursAndParentsOfBruteForce) {
  std::vector<VoxelIndex> indices;  // of the level at hand
  for_each_voxel(map_.finest(), [&](const VoxelIndex& voxel, std::size_t) { indices.push_back(voxel); });
  for (std::size_t l = 0; l < kNumLevels; ++l) {
    const double size = 0.1 * (1 << l);
    const PyramidLevel& level = pyramid_[l];
    const auto expected = voxels_of(cloud_, size);
    ASSERT_EQ(level.size(), expected.size());
    ASSERT_EQ(indices.size(), level.size());
    std::map<Place, std::size_t> numbers;
    for (std::size_t i = 0; i < level.size(); ++i) numbers[place_of(indices[i])] = i;
    for (std::size_t i = 0; i < level.size(); ++i) {
      const Sum& voxel = expected.at(place_of(indices[i]));
      const Eigen::Vector3d in_voxel = (voxel.sum / voxel.count - corner_of_voxel(indices[i], size)) / size;
      ASSERT_LT((level.places[i].cast<double>() - in_voxel).cwiseAbs().maxCoeff(), 2e-4);
      const auto steps = steps_by_brute_force(expected, place_of(indices[i]));
      const auto found = level.neighbours_of(i);
      ASSERT_EQ(found.size(), steps.size());
      for (std::size_t k = 0; k < steps.size(); ++k) {
        ASSERT_EQ(neighbour_steps()[found[k].step], steps[k]);
        ASSERT_EQ(found[k].voxel, numbers.at(place_of(indices[i] + steps[k])));
      }
    }
    if (l + 1 == kNumLevels) break;
    ASSERT_EQ(level.parents.size(), level.size());
    std::vector<VoxelIndex> above(pyramid_[l + 1].size());
    for (std::size_t i = 0; i < level.size(); ++i) above[level.parents[i]] = parent_of_voxel(indices[i], 2);
    for (std::size_t i = 0; i < level.size(); ++i) {
      ASSERT_EQ(above[level.parents[i]], parent_of_voxel(indices[i], 2));
    }
    indices = above;
  }
}

TEST_F(VoxelPyramids, StandOnTenCentimetresOnly) {
  BuildOptions options;
  options.voxel_sizes = {0.2};
  EXPECT_THROW(make_pyramid(build_map(cloud_, options).finest()), std::invalid_argument);
}

TEST(NeighbourSteps, AreThe81WithinTwoAndAHalfVoxels) {
  EXPECT_EQ(neighbour_steps().size(), 81U);
  EXPECT_EQ(neighbour_steps()[0], VoxelIndex(0, 0, 0));
  EXPECT_EQ(neighbour_steps()[1], VoxelIndex(-1, 0, 0));
  EXPECT_EQ(neighbour_steps()[6], VoxelIndex(1, 0, 0));
}

}  // namespace
}  // namespace vdbmap::parking

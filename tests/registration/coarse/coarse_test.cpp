// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/coarse/coarse.h"

#include <random>

#include <gtest/gtest.h>

#include "tests/support/pose_distance.h"
#include "tests/support/random_points.h"
#include "tests/support/sample_maps.h"
#include "tests/support/sanitizers.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/threads.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap::registration {
namespace {

const VoxelLevel& street_level() {
  static const VoxelLevel level = test::coarse_level(test::sample_scene(test::village(), 60, 1));
  return level;
}

class CoarseSeed : public testing::TestWithParam<unsigned> {};

// Other points of the same street, turned any way and carried far off: the 2 m and 5 degrees.
TEST_P(CoarseSeed, FindsAVillageTurnedAnyWay) {
  std::mt19937 random(GetParam());
  const Eigen::Isometry3d moved_from_street = test::random_motion(90, 25.0 * GetParam(), random);
  const VoxelLevel combined =
      test::coarse_level(test::moved(test::sample_scene(test::village(), 40, 100 + GetParam()), moved_from_street));
  const auto hypotheses = find_coarse(combined, prepare_coarse_map(street_level()));
  ASSERT_FALSE(hypotheses.empty());
  const auto error = test::distance_between(hypotheses.front().target_from_source, moved_from_street.inverse());
  EXPECT_LT(error.rotation_deg, 5);
  const Eigen::Vector3d middle(0, 0, 2);
  EXPECT_LT((hypotheses.front().target_from_source * (moved_from_street * middle) - middle).norm(), 2);
}

INSTANTIATE_TEST_SUITE_P(Seeds, CoarseSeed, testing::Range(1U, test::kIsSanitized ? 2U : 7U));

TEST(Coarse, AnEmptyScanOrMapHasNoHypothesis) {
  PointCloud one;
  one.positions = {{0.5, 0.5, 0.5}};
  EXPECT_TRUE(find_coarse(test::coarse_level(one), prepare_coarse_map(street_level())).empty());
  EXPECT_TRUE(find_coarse(street_level(), prepare_coarse_map(test::coarse_level(one))).empty());
  EXPECT_TRUE(find_coarse(test::coarse_level({}), prepare_coarse_map(street_level())).empty());
}

TEST(Coarse, DoesNotDependOnTheNumberOfThreads) {
  const VoxelLevel combined = test::coarse_level(test::sample_scene(test::village(), 40, 5));
  const auto find = [&] { return find_coarse(combined, prepare_coarse_map(street_level())); };
  const auto one = test::on_threads(1, find);
  const auto four = test::on_threads(4, find);
  ASSERT_EQ(one.size(), four.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].target_from_source.matrix(), four[i].target_from_source.matrix());
  }
}

TEST(Coarse, RefusesOptionsOutOfRange) {
  CoarseOptions options;
  options.feature_radius = 33;  // voxels of 1 m: 32 at most
  EXPECT_THROW(prepare_coarse_map(street_level(), options), std::invalid_argument);
  options = {};
  options.map_share = 0;
  EXPECT_THROW(prepare_coarse_map(street_level(), options), std::invalid_argument);
  options = {};
  options.num_nearest = 0;
  EXPECT_THROW(find_coarse(street_level(), {}, options), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap::registration

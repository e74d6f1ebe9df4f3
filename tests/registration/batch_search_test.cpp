// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/batch_search.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "registration/batch_builder.h"
#include "tests/support/pose_distance.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/threads.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap::registration {
namespace {

constexpr double kApart = 128;  // [m] between a street and its twin: whole voxels of every level

VoxelMap map_of(bool has_twin) {
  BuildOptions options;
  options.anchor = Eigen::Vector3d::Zero();
  PointCloud cloud = test::survey_of_village();
  if (has_twin) {
    const PointCloud twin = test::moved(cloud, Eigen::Isometry3d(Eigen::Translation3d(0, kApart, 0)));
    cloud.positions.insert(cloud.positions.end(), twin.positions.begin(), twin.positions.end());
  }
  return build_map(cloud, options);
}

const VoxelMap& village_map() {
  static const VoxelMap map = map_of(false);
  return map;
}

const VoxelMap& map_of_twins() {
  static const VoxelMap map = map_of(true);
  return map;
}

Eigen::Isometry3d true_pose() {
  return Eigen::Translation3d(-6, 0.5, 1.8) * Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ());
}

const CombinedScans& batch() {
  static const CombinedScans combined = [] {
    BatchBuilder builder(1.0, {});
    for (int i = 0; i < 4; ++i) {
      const Eigen::Isometry3d batch_from_scan(Eigen::Translation3d(2.0 * i, 0, 0));
      const test::Scanner scanner{.num_azimuths = 600, .range_noise = 0.01, .seed = static_cast<unsigned>(i) + 1};
      const PointCloud scan = test::scan_scene(test::village(), true_pose() * batch_from_scan, scanner);
      builder.add(scan.positions, sample_scan(scan.positions, 1.0, 1.5, {}), batch_from_scan);
    }
    return builder.combine();
  }();
  return combined;
}

PoseHypothesis hypothesis(const Eigen::Vector3d& shift, std::size_t num_inliers) {
  return {Eigen::Translation3d(shift) * true_pose(), num_inliers};
}

const PoseHypothesis kTwin = hypothesis({0.2, kApart + 0.1, 0}, 60);

// Around the truth, from where alignment leads there.
std::vector<PoseHypothesis> guesses_of_one_place(std::size_t count) {
  std::vector<PoseHypothesis> guesses;
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = static_cast<double>(i);
    guesses.push_back(hypothesis({0.15 * number - 0.4, 0.3 - 0.1 * number, 0.05 * number}, 90 - i));
  }
  return guesses;
}

void expect_ambiguous(const BatchResult& result) {
  EXPECT_NE(result.reason.find("another pose agrees nearly as well"), std::string::npos) << result.reason;
  ASSERT_GE(result.candidates.size(), 2u);
  const double shift =
      (result.candidates[0].map_from_batch.translation() - result.candidates[1].map_from_batch.translation()).norm();
  EXPECT_NEAR(shift, kApart, 0.1);
}

TEST(BatchSearch, OnePlaceIsFoundHoweverManyGuessesLeadThere) {
  for (const std::size_t count : {1UL, 2UL, 16UL}) {
    const BatchResult result = compare_hypotheses(batch(), village_map(), guesses_of_one_place(count));
    EXPECT_TRUE(result.found()) << result.reason;
    ASSERT_EQ(result.candidates.size(), 1u);
    EXPECT_LT(test::distance_between(result.candidates[0].map_from_batch, true_pose()).translation, 0.05);
  }
}

// However many guesses meet before it, a place that looks alike is compared.
TEST(BatchSearch, APlaceThatLooksAlikeIsComparedWhereverItStands) {
  for (const std::size_t count : {1UL, 5UL, 6UL, 15UL}) {
    std::vector<PoseHypothesis> hypotheses = guesses_of_one_place(count);
    hypotheses.push_back(kTwin);
    expect_ambiguous(compare_hypotheses(batch(), map_of_twins(), hypotheses));
  }
}

// Between the place and its twin stand others where nothing fits.
TEST(BatchSearch, PlacesThatDoNotFitHideNoneThatDoes) {
  std::vector<PoseHypothesis> hypotheses = guesses_of_one_place(4);
  for (const double x : {-20.0, 12.0, 25.0}) hypotheses.push_back(hypothesis({x, 0, 0}, 70));
  hypotheses.push_back(kTwin);
  expect_ambiguous(compare_hypotheses(batch(), map_of_twins(), hypotheses));
  hypotheses.pop_back();
  EXPECT_TRUE(compare_hypotheses(batch(), map_of_twins(), hypotheses).found());
}

// Places that alignment on the coarser levels leaves so far from the best that its agreement is low.
TEST(BatchSearch, IsTheSameInWhateverOrderThePlacesCome) {
  std::vector<PoseHypothesis> hypotheses = {kTwin, hypothesis({12, 0, 0}, 70)};
  for (const PoseHypothesis& guess : guesses_of_one_place(4)) hypotheses.push_back(guess);
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    std::rotate(hypotheses.begin(), hypotheses.begin() + 1, hypotheses.end());
    expect_ambiguous(compare_hypotheses(batch(), map_of_twins(), hypotheses));
  }
}

TEST(BatchSearch, OfTwinsInTheMapNeitherIsFoundFromFeatures) {
  const VoxelMap& map = map_of_twins();
  expect_ambiguous(find_batch(batch(), map, prepare_coarse_map(map.coarsest())));
}

// However small a part is: the village is one, its twin is of another or of the same.
TEST(BatchSearch, ALargeMapIsSearchedInPartsToTheSameEnd) {
  CoarseOptions parts;
  parts.max_whole = 100;
  const CoarseMap village = prepare_coarse_map(village_map().coarsest(), parts);
  ASSERT_FALSE(village.tiles.empty());
  const BatchResult result = find_batch(batch(), village_map(), village, parts);
  EXPECT_TRUE(result.found()) << result.reason;
  EXPECT_LT(test::distance_between(result.candidates.at(0).map_from_batch, true_pose()).translation, 0.05);
  expect_ambiguous(find_batch(batch(), map_of_twins(), prepare_coarse_map(map_of_twins().coarsest(), parts), parts));
}

TEST(BatchSearch, WithoutHypothesesNothingIsFound) {
  const BatchResult result = compare_hypotheses(batch(), village_map(), {});
  EXPECT_EQ(result.reason, "no features agree with the map");
  EXPECT_TRUE(result.candidates.empty());
}

TEST(BatchSearch, DoesNotDependOnTheNumberOfThreads) {
  std::vector<PoseHypothesis> hypotheses = guesses_of_one_place(7);
  hypotheses.push_back(kTwin);
  const auto compare = [&] { return compare_hypotheses(batch(), map_of_twins(), hypotheses); };
  const BatchResult one = test::on_threads(1, compare);
  const BatchResult four = test::on_threads(4, compare);
  ASSERT_EQ(one.candidates.size(), four.candidates.size());
  for (std::size_t i = 0; i < one.candidates.size(); ++i) {
    EXPECT_EQ(one.candidates[i].map_from_batch.matrix(), four.candidates[i].map_from_batch.matrix());
    EXPECT_EQ(one.candidates[i].agreement, four.candidates[i].agreement);
  }
}

TEST(BatchSearch, AlignsWithTheOptionsOfTheCaller) {
  const std::vector<PoseHypothesis> hypotheses = {hypothesis({0.9, -0.6, 0.2}, 90)};
  const auto error_after = [&](int max_iterations) {
    FineOptions fine;
    fine.max_iterations = max_iterations;
    const BatchResult result = compare_hypotheses(batch(), village_map(), hypotheses, {}, fine);
    return test::distance_between(result.candidates.front().map_from_batch, true_pose()).translation;
  };
  EXPECT_LT(error_after(15), 0.8 * error_after(1));
  FineOptions bad;
  bad.max_iterations = 0;
  const VoxelMap& map = village_map();
  EXPECT_THROW(compare_hypotheses(batch(), map, hypotheses, {}, bad), std::invalid_argument);
  EXPECT_THROW(find_batch(batch(), map, prepare_coarse_map(map.coarsest()), {}, {}, bad), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap::registration

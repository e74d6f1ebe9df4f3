// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/change/map_diff.h"

#include <cstdlib>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/sample_maps.h"
#include "tests/support/surveyed_place.h"
#include "vdbmap/change/change_regions.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap {
namespace {

using test::lane;
using test::Survey;
using test::survey_of;

SeenMap seen(const Survey& survey) { return {survey.map, &survey.visibility}; }

const Survey& usual_survey() {
  static const Survey survey = survey_of(lane());
  return survey;
}

// Another day: other noise, and other places to look from.
Survey later_survey(const test::LaneOptions& options) {
  return survey_of(lane(options), {.seed = 2, .first_stop = -7.3});
}

std::uint64_t num_changes(const ChangeCounts& counts) { return counts.appeared + counts.vanished + counts.changed; }

void expect_same(const MapDiff& a, const MapDiff& b) {
  EXPECT_EQ(a.counts, b.counts);
  for (const auto kind : {&MapDiff::appeared, &MapDiff::vanished, &MapDiff::changed}) {
    EXPECT_TRUE(test::same_voxels((a.*kind).level, (b.*kind).level));
    EXPECT_TRUE(std::ranges::equal((a.*kind).level.records(), (b.*kind).level.records()));
    EXPECT_EQ((a.*kind).confidences, (b.*kind).confidences);
  }
  EXPECT_EQ(a.unobserved.leaves().size(), b.unobserved.leaves().size());
}

TEST(MapDiff, FindsNothingWhereTwoSurveysSawTheSame) {
  const Survey later = later_survey({});
  const MapDiff diff = map_diff(seen(usual_survey()), seen(later));
  EXPECT_EQ(num_changes(diff.counts), 0u);
  EXPECT_GT(diff.counts.unchanged, 20'000u);
}

TEST(MapDiff, SaysThatACarVanished) {
  const Survey later = later_survey({.has_car = false});
  const MapDiff diff = map_diff(seen(usual_survey()), seen(later));
  const std::vector<ChangeRegion> regions = find_regions(diff);
  ASSERT_EQ(regions.size(), 1u);
  EXPECT_EQ(regions[0].kind, Change::kVanished);
  EXPECT_EQ(regions[0].id, 1u);
  // The car's far side was never seen.
  EXPECT_NEAR(regions[0].center().x(), 4, 0.1);
  EXPECT_NEAR(regions[0].size().x(), 4.4, 0.15);
  EXPECT_NEAR(regions[0].top, 1.7, 0.1);
  EXPECT_GT(regions[0].confidence, 0.8);
  EXPECT_EQ(diff.counts.appeared, 0u);
}

TEST(MapDiff, SaysThatACarAppeared) {
  const Survey earlier = later_survey({.has_car = false});
  const std::vector<ChangeRegion> regions = find_regions(map_diff(seen(earlier), seen(usual_survey())));
  ASSERT_EQ(regions.size(), 1u);
  EXPECT_EQ(regions[0].kind, Change::kAppeared);
}

TEST(MapDiff, CallsTheGroundUnderACarUnobserved) {
  const Survey later = later_survey({.has_car = false});
  const MapDiff diff = map_diff(seen(usual_survey()), seen(later));
  // Beneath the car and behind it, the road, pavement and wall that the first survey could not see.
  EXPECT_GT(diff.counts.unobserved, 100u);
}

TEST(MapDiff, FindsAWallThatMovedBy8Centimetres) {
  for (const double move : {-0.08, 0.08}) {
    const Survey later = later_survey({.wall_y = 6 + move});
    const std::vector<ChangeRegion> regions = find_regions(map_diff(seen(usual_survey()), seen(later)));
    ASSERT_FALSE(regions.empty()) << move;
    EXPECT_EQ(regions[0].kind, Change::kChanged) << move;
    EXPECT_GT(regions[0].size().x(), 15) << move;
    EXPECT_GT(regions[0].size().z(), 3) << move;
  }
}

TEST(MapDiff, TakesAShiftOf3CentimetresForNoChange) {
  for (const Eigen::Vector3d& shift : {Eigen::Vector3d(0.03, 0, 0), Eigen::Vector3d(0, 0.03, 0),
                                       Eigen::Vector3d(0.017, 0.017, 0.017), Eigen::Vector3d(0, 0, -0.03)}) {
    const Survey later = survey_of(lane(), {.shift = shift});
    const MapDiff diff = map_diff(seen(usual_survey()), seen(later));
    EXPECT_LT(static_cast<double>(num_changes(diff.counts)), 0.001 * static_cast<double>(later.map.finest().size()))
        << shift.transpose();
  }
}

TEST(MapDiff, FindsNothingOnceAMotionIsUndone) {
  Eigen::Isometry3d earlier_from_later(Eigen::Translation3d(0.21, -0.13, 0.08));
  earlier_from_later.rotate(Eigen::AngleAxisd(0.01, Eigen::Vector3d(0.1, 0.2, 1).normalized()));
  test::Scene turned = lane();
  const Eigen::Isometry3d later_from_earlier = earlier_from_later.inverse();
  for (test::Rectangle& side : turned) {
    side = {later_from_earlier * side.corner, later_from_earlier.linear() * side.edge_a,
            later_from_earlier.linear() * side.edge_b};
  }
  const Survey later = survey_of(turned, {.seed = 3});
  EXPECT_GT(num_changes(map_diff(seen(usual_survey()), seen(later)).counts), 1000u);
  DiffOptions options;
  options.earlier_from_later = earlier_from_later;
  EXPECT_LT(num_changes(map_diff(seen(usual_survey()), seen(later), options).counts), 20u);  // at edges
}

TEST(MapDiff, LeavesOpenWhatNobodyLookedAt) {
  // The box was put there by someone who saw it; the usual survey cannot see behind the screen.
  const Survey with_box = survey_of(lane({.has_hidden_box = true}), {.seed = 4});
  Survey earlier = survey_of(test::box({-4.9, -5.9, 0}, {-4.1, -5.3, 0.8}), {.seed = 5});
  const MapDiff diff = map_diff(seen(earlier), seen(with_box));
  EXPECT_EQ(diff.counts.vanished, 0u);
  EXPECT_GT(diff.counts.unobserved, 50u);
}

TEST(MapDiff, WithoutRaysKnowsOnlyWhatChanged) {
  const Survey later = later_survey({.has_car = false, .wall_y = 6.08});
  const MapDiff diff = map_diff({usual_survey().map}, {later.map});
  EXPECT_EQ(diff.counts.appeared + diff.counts.vanished, 0u);
  EXPECT_GT(diff.counts.changed, 100u);
  DiffOptions options;
  options.takes_unseen_as_empty = true;
  EXPECT_GT(map_diff({usual_survey().map}, {later.map}, options).counts.vanished, 500u);
}

TEST(MapDiff, DoesNotDependOnAnchors) {
  const test::LaneOptions changed{.has_car = false, .wall_y = 6.08};
  const Survey later = later_survey(changed);
  const Survey elsewhere = survey_of(lane(changed), {.seed = 2, .first_stop = -7.3, .anchor = {-128, 64, 0}});
  const MapDiff diff = map_diff(seen(usual_survey()), seen(later));
  const MapDiff other = map_diff(seen(usual_survey()), seen(elsewhere));
  EXPECT_EQ(diff.counts, other.counts);
  EXPECT_EQ(other.frame.anchor, Eigen::Vector3d(-128, 64, 0));
  const std::vector<ChangeRegion> regions = find_regions(diff), same = find_regions(other);
  ASSERT_EQ(regions.size(), same.size());
  for (std::size_t i = 0; i < regions.size(); ++i) {
    EXPECT_TRUE(regions[i].center().isApprox(same[i].center(), 1e-9));
  }
}

TEST(MapDiff, CountsEveryVoxelOnce) {
  const Survey later = later_survey({.has_car = false, .wall_y = 6.08});
  const ChangeCounts counts = map_diff(seen(usual_survey()), seen(later)).counts;
  std::uint64_t num_of_both = later.map.finest().size();
  const VoxelFinder finder(later.map.finest());
  for_each_voxel(usual_survey().map.finest(),
                 [&](const VoxelIndex& voxel, std::size_t) { num_of_both += finder.find(voxel) ? 0 : 1; });
  EXPECT_EQ(num_changes(counts) + counts.unchanged + counts.unobserved, num_of_both);
}

TEST(MapDiff, IsTheSameForAnyNumberOfThreads) {
  const Survey later = later_survey({.has_car = false, .wall_y = 6.08});
  const MapDiff diff = map_diff(seen(usual_survey()), seen(later));
  const ThreadLimit limit(1);
  expect_same(diff, map_diff(seen(usual_survey()), seen(later)));
}

TEST(MapDiff, OfPartsIsThatOfTheWhole) {
  const Survey later = later_survey({.has_car = false, .wall_y = 6.08});
  std::vector<MapDiff> parts;
  for (const int begin : {-4096, 0, 24}) {
    openvdb::CoordBBox box = openvdb::CoordBBox::inf();
    box.min().x() = begin;
    box.max().x() = begin == -4096 ? -1 : begin == 0 ? 23 : 4095;
    parts.push_back(map_diff_in(box, seen(usual_survey()), seen(later)));
  }
  expect_same(join_diffs(parts), map_diff(seen(usual_survey()), seen(later)));
}

TEST(MapDiff, RefusesWhatCannotBeCompared) {
  const VoxelMap map = test::map_of_voxels({{0, 0, 0}});
  VoxelMap hannover = map, munich = map;
  hannover.frame.epsg = 25832;
  munich.frame.epsg = 25833;
  EXPECT_THROW(map_diff({hannover}, {munich}), std::invalid_argument);
  EXPECT_NO_THROW(map_diff({hannover}, {map}));
  VoxelMap coarse;
  coarse.levels.emplace_back(0.2, LargeVector<VoxelLeaf>{}, LargeVector<VoxelRecord>{});
  EXPECT_THROW(map_diff({coarse}, {map}), std::invalid_argument);
  EXPECT_THROW(map_diff({VoxelMap{}}, {map}), std::invalid_argument);
  EXPECT_THROW(map_diff({map, &usual_survey().visibility}, {map}), std::invalid_argument);
  DiffOptions options;
  options.significance = 0;
  EXPECT_THROW(map_diff({map}, {map}, options), std::invalid_argument);
}

TEST(MapDiff, OfEmptyMapsIsEmpty) {
  VoxelMap empty;
  empty.levels.emplace_back(0.1, LargeVector<VoxelLeaf>{}, LargeVector<VoxelRecord>{});
  const MapDiff nothing = map_diff({empty}, {empty});
  EXPECT_EQ(nothing.counts, ChangeCounts());
  EXPECT_TRUE(find_regions(nothing).empty());
  const MapDiff all = map_diff({empty}, seen(usual_survey()));
  EXPECT_EQ(all.counts.unobserved, usual_survey().map.finest().size());
}

}  // namespace
}  // namespace vdbmap

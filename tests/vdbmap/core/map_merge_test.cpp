// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/map_merge.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/sample_maps.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/core/srgb.h"

namespace vdbmap {
namespace {

enum class Attributes { kNone, kAll };

// Points on a wavy ground and a wall, 8 m x 8 m from `corner`.
PointCloud street(const Eigen::Vector3d& corner, std::size_t count, unsigned seed,
                  Attributes attributes = Attributes::kNone) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> along(0.0, 8.0);
  std::uniform_int_distribution<int> color(0, 65535);
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = along(random);
    const double y = along(random);
    const bool on_wall = i % 4 == 0;
    cloud.positions.push_back(corner + Eigen::Vector3d(x, on_wall ? 4.03 : y, on_wall ? y / 4 : 0.1 * std::sin(x)));
    if (attributes == Attributes::kNone) continue;
    const auto channel = [&] { return static_cast<std::uint16_t>(color(random)); };
    cloud.colors.push_back({channel(), channel(), channel()});
    cloud.intensities.push_back(static_cast<float>(x / 8));
  }
  return cloud;
}

PointCloud joined(PointCloud a, const PointCloud& b) {
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  a.colors.insert(a.colors.end(), b.colors.begin(), b.colors.end());
  a.intensities.insert(a.intensities.end(), b.intensities.begin(), b.intensities.end());
  return a;
}

VoxelMap single_point(const Eigen::Vector3d& point, const BuildOptions& options = test::anchored({0, 0, 0})) {
  PointCloud cloud;
  cloud.positions = {point};
  return build_map(cloud, options);
}

void expect_same_channels(const VoxelChannels& a, const VoxelChannels& b) {
  for_each_channel([&](const char* name, auto channel) { EXPECT_EQ(a.*channel, b.*channel) << name; });
}

void expect_identical(const VoxelMap& a, const VoxelMap& b) {
  EXPECT_EQ(a.frame, b.frame);
  EXPECT_EQ(a.has_color, b.has_color);
  ASSERT_EQ(a.levels.size(), b.levels.size());
  for (std::size_t i = 0; i < a.levels.size(); ++i) {
    EXPECT_TRUE(test::same_voxels(a.levels[i], b.levels[i]));
    EXPECT_TRUE(std::ranges::equal(a.levels[i].records(), b.levels[i].records()));
    expect_same_channels(a.levels[i].channels(), b.levels[i].channels());
  }
}

// Every stored mean is off by up to a step of the code before and one after the merge, every covariance element by
// 2^-9 of its value up to 256 points and by 2^-17 beyond; an offset of the means by a step changes a covariance by a
// step times the edge.
void expect_close(const VoxelRecord& merged, const VoxelRecord& built, double voxel_size) {
  EXPECT_EQ(merged.count, built.count);
  const double step = voxel_size / kMeanSteps;
  const double rounding = built.count <= 256 ? 0x1p-8 : 0x1p-16;
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(merged.covariance[i], built.covariance[i],
                2 * step * voxel_size + 2 * rounding * std::abs(built.covariance[i]));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(merged.mean_code[i], built.mean_code[i], 2);
    EXPECT_NEAR(merged.color_code[i], built.color_code[i], 2);  // a step is 1/128 of the value or less
  }
}

void expect_close(const VoxelLevel& merged, const VoxelLevel& built) {
  ASSERT_TRUE(test::same_voxels(merged, built));
  for (std::size_t i = 0; i < built.size(); ++i) {
    expect_close(merged.records()[i], built.records()[i], built.voxel_size());
  }
  ASSERT_EQ(merged.channels().intensities.size(), built.channels().intensities.size());
  for (std::size_t i = 0; i < built.channels().intensities.size(); ++i) {
    EXPECT_NEAR(merged.channels().intensities[i], built.channels().intensities[i], 2e-5);  // counted in 2^-16
  }
}

// Where there is a plane at all, its normal is the same but for a step or two of its code (0.6 degrees each).
void expect_close_normals(const VoxelLevel& merged, const VoxelLevel& built) {
  for (std::size_t i = 0; i < built.size(); ++i) {
    if (planarity_of(built.records()[i]) < 0.2) continue;
    EXPECT_GT(std::abs(normal_of(merged.records()[i]).dot(normal_of(built.records()[i]))), std::cos(0.05));
    EXPECT_NEAR(planarity_of(merged.records()[i]), planarity_of(built.records()[i]), 0.02);
  }
}

void expect_close(const VoxelMap& merged, const VoxelMap& built) {
  EXPECT_EQ(merged.frame, built.frame);
  EXPECT_EQ(merged.has_color, built.has_color);
  ASSERT_EQ(merged.levels.size(), built.levels.size());
  for (std::size_t i = 0; i < built.levels.size(); ++i) {
    expect_close(merged.levels[i], built.levels[i]);
    expect_close_normals(merged.levels[i], built.levels[i]);
  }
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no error";
}

TEST(MergeMaps, TwoPointsInOneVoxelGiveTheirMomentsInClosedForm) {
  const VoxelMap merged = merge_maps(single_point({0.02, 0.05, 0.05}), single_point({0.06, 0.05, 0.05}));

  ASSERT_EQ(merged.finest().size(), 1U);
  const Moments moments = moments_of(merged.finest().records()[0], {0, 0, 0}, 0.1);
  EXPECT_EQ(moments.count, 2);
  EXPECT_NEAR(moments.mean.x(), 0.04, 0.1 / kMeanSteps);
  EXPECT_NEAR(moments.covariance()(0, 0), 0.04 * 0.04 / 2, 0x1p-8 * 0.04 * 0.04 / 2);  // divisor n - 1; 8 bits
  EXPECT_NEAR(moments.covariance()(1, 1), 0, 1e-12);
  ASSERT_EQ(merged.coarsest().size(), 1U);
  EXPECT_EQ(merged.coarsest().records()[0].count, 2U);
}

TEST(MergeMaps, EqualsBuildingFromAllPoints) {
  const PointCloud a = street({-3, -4, 0}, 20'000, 1, Attributes::kAll);
  const PointCloud b = street({0, 1, 0.05}, 30'000, 2, Attributes::kAll);
  const BuildOptions options = test::anchored({0, 0, 0});
  expect_close(merge_maps(build_map(a, options), build_map(b, options)), build_map(joined(a, b), options));
}

TEST(MergeMaps, OtherAnchorsAreShiftedByWholeVoxels) {
  const PointCloud a = street(test::kUtm + Eigen::Vector3d(-3, -4, 0), 20'000, 3);
  const PointCloud b = street(test::kUtm + Eigen::Vector3d(0, 1, 0.05), 20'000, 4);
  const BuildOptions near = test::anchored(test::kUtm);
  const BuildOptions far = test::anchored(test::kUtm + Eigen::Vector3d(-64, 640, 64));
  expect_close(merge_maps(build_map(a, near), build_map(b, far)), build_map(joined(a, b), near));
  expect_close(merge_maps(build_map(a, far), build_map(b, near)), build_map(joined(a, b), far));
}

TEST(MergeMaps, FineVoxelsDoNotDependOnTheAnchors) {
  const VoxelMap a = build_map(street({-3, -4, 0}, 5'000, 5), test::anchored({0, 0, 0}));
  const PointCloud b = street({0, 1, 0.05}, 5'000, 6);
  const VoxelMap near = merge_maps(a, build_map(b, test::anchored({0, 0, 0})));
  const VoxelMap far = merge_maps(a, build_map(b, test::anchored({-128, 64, 0})));
  ASSERT_TRUE(test::same_voxels(near.finest(), far.finest()));
  for (std::size_t i = 0; i < near.finest().size(); ++i) {
    EXPECT_EQ(near.finest().records()[i].count, far.finest().records()[i].count);
    EXPECT_EQ(near.finest().records()[i].mean_code, far.finest().records()[i].mean_code);
    EXPECT_EQ(near.finest().records()[i].covariance, far.finest().records()[i].covariance);
  }
}

TEST(MergeMaps, TheOrderDoesNotMatter) {
  BuildOptions options = test::anchored({0, 0, 0});
  options.epoch = 2;
  const VoxelMap a = build_map(street({-3, -4, 0}, 20'000, 7, Attributes::kAll), options);
  options.epoch = 1;
  const VoxelMap b = build_map(street({0, 1, 0.05}, 20'000, 8, Attributes::kAll), options);
  expect_identical(merge_maps(a, b), merge_maps(b, a));
}

TEST(MergeMaps, TheOrderDoesNotMatterWhereAMeanLiesBetweenTwoCodes) {
  // Two single points an odd number of steps apart: their mean is at the edge of a step.
  for (int steps = 1; steps < 200; steps += 2) {
    const VoxelMap a = single_point({0.05, 0.05, 0.05});
    const VoxelMap b = single_point({0.05 + steps * 0.1 / kMeanSteps, 0.05, 0.05});
    expect_identical(merge_maps(a, b), merge_maps(b, a));
  }
}

TEST(MergeMaps, VoxelsOfOneMapKeepTheirRecordButForTheNormal) {
  const VoxelMap a = build_map(street({0, 0, 0}, 5'000, 9, Attributes::kAll), test::anchored({0, 0, 0}));
  const VoxelMap b = build_map(street({20, 0, 0}, 5'000, 10, Attributes::kAll), test::anchored({0, 0, 0}));
  const VoxelMap merged = merge_maps(a, b);
  ASSERT_EQ(merged.finest().size(), a.finest().size() + b.finest().size());
  const VoxelFinder in_merged(merged.finest());
  for (const VoxelMap* source : {&a, &b}) {
    for_each_voxel(source->finest(), [&](const VoxelIndex& voxel, std::size_t number) {
      const VoxelRecord* found = in_merged.find(voxel);
      ASSERT_NE(found, nullptr);
      EXPECT_EQ(*found, source->finest().records()[number]);  // far from each other: even the normals are equal
    });
  }
}

TEST(MergeMaps, AnEmptyMapChangesNothing) {
  BuildOptions options;
  options.epoch = 4;
  options.epsg = 25832;
  const VoxelMap map = build_map(street(test::kUtm, 5'000, 11, Attributes::kAll), options);
  const VoxelMap empty = build_map({}, {});
  expect_identical(merge_maps(map, empty), map);
  expect_identical(merge_maps(empty, map), map);
  expect_identical(merge_maps(empty, empty), empty);
}

TEST(MergeMaps, ColorsAreWeightedByCountInLinearLight) {
  const Rgb16 red{65535, 0, 0};
  const Rgb16 grey{32896, 32896, 32896};
  PointCloud one;
  one.positions = {{0.05, 0.05, 0.05}};
  one.colors = {red};
  PointCloud three = one;
  three.positions.assign(3, {0.02, 0.02, 0.02});
  three.colors.assign(3, grey);
  const VoxelMap merged =
      merge_maps(build_map(one, test::anchored({0, 0, 0})), build_map(three, test::anchored({0, 0, 0})));
  const double linear_grey = linear_from_srgb(32896) / 65535.0;
  const Eigen::Vector3d expected(0.25 + 0.75 * linear_grey, 0.75 * linear_grey, 0.75 * linear_grey);
  EXPECT_TRUE(color_of(merged.finest().records()[0]).isApprox(expected, 0x1p-7));
}

TEST(MergeMaps, WhatOneMapDoesNotKnowIsTakenFromTheOther) {
  PointCloud colored;
  colored.positions = {{0.05, 0.05, 0.05}};
  colored.colors = {{65535, 0, 65535}};
  colored.intensities = {0.5F};
  BuildOptions options = test::anchored({0, 0, 0});
  options.epoch = 7;
  const VoxelMap known = build_map(colored, options);
  PointCloud plain;
  plain.positions = {{0.05, 0.05, 0.05}, {5.05, 0.05, 0.05}};
  const VoxelMap merged = merge_maps(build_map(plain, test::anchored({0, 0, 0})), known);

  EXPECT_TRUE(merged.has_color);
  ASSERT_EQ(merged.finest().size(), 2U);
  EXPECT_EQ(color_of(merged.finest().records()[0]), Eigen::Vector3d(1, 0, 1));
  EXPECT_EQ(merged.finest().records()[1].color_code, (std::array<std::uint16_t, 3>{}));
  EXPECT_EQ(merged.finest().channels().intensities, (std::vector<float>{0.5F, 0.0F}));
  EXPECT_EQ(merged.finest().channels().first_epochs, (std::vector<std::int32_t>{7, 0}));
  EXPECT_EQ(merged.finest().channels().last_epochs, (std::vector<std::int32_t>{7, 0}));
}

TEST(MergeMaps, EpochsSpanBothMaps) {
  BuildOptions options = test::anchored({0, 0, 0});
  options.epoch = 5;
  const VoxelMap later = single_point({0.05, 0.05, 0.05}, options);
  options.epoch = 2;
  const VoxelMap earlier = single_point({0.06, 0.05, 0.05}, options);
  const VoxelMap merged = merge_maps(later, earlier);
  for (const VoxelLevel& level : merged.levels) {
    EXPECT_EQ(level.channels().first_epochs, std::vector<std::int32_t>{2});
    EXPECT_EQ(level.channels().last_epochs, std::vector<std::int32_t>{5});
  }
}

PointCloud labelled_voxel(double x, std::vector<std::uint16_t> labels) {
  PointCloud cloud;
  cloud.positions.assign(labels.size(), {x, 0.05, 0.05});
  cloud.labels = std::move(labels);
  return cloud;
}

TEST(MergeMaps, AVoxelHasTheLabelOfTheMapWithMorePointsInIt) {
  const auto label_of = [](std::vector<std::uint16_t> a, std::vector<std::uint16_t> b) {
    const VoxelMap map_a = build_map(labelled_voxel(0.05, std::move(a)), test::anchored({0, 0, 0}));
    const VoxelMap map_b = build_map(labelled_voxel(0.05, std::move(b)), test::anchored({0, 0, 0}));
    EXPECT_EQ(test::difference(merge_maps(map_a, map_b), merge_maps(map_b, map_a)), "");
    return merge_maps(map_a, map_b).finest().channels().labels;
  };
  EXPECT_EQ(label_of({4}, {9, 9}), std::vector<std::int32_t>{9});
  EXPECT_EQ(label_of({4, 4, 9}, {9, 9}), std::vector<std::int32_t>{4});  // though nine has more votes
  EXPECT_EQ(label_of({9}, {4}), std::vector<std::int32_t>{4});
  EXPECT_EQ(label_of({0, 0, 0}, {4}), std::vector<std::int32_t>{4});
}

TEST(MergeMaps, LabelsOfOneMapAreKept) {
  const VoxelMap plain = single_point({0.05, 0.05, 0.05});
  VoxelMap labelled = build_map(labelled_voxel(1.05, {6}), test::anchored({0, 0, 0}));
  labelled.label_scheme = LabelScheme::kAsprs;
  const VoxelMap merged = merge_maps(plain, labelled);
  EXPECT_EQ(merged.finest().channels().labels, (std::vector<std::int32_t>{kNoLabel, 6}));
  EXPECT_EQ(merged.label_scheme, LabelScheme::kAsprs);
}

TEST(MergeMaps, LabelSchemesThatDifferAreRefused) {
  VoxelMap a = build_map(labelled_voxel(0.05, {6}), test::anchored({0, 0, 0}));
  VoxelMap b = a;
  a.label_scheme = LabelScheme::kAsprs;
  EXPECT_EQ(merge_maps(a, b).label_scheme, LabelScheme::kUnknown);
  EXPECT_EQ(merge_maps(a, a).label_scheme, LabelScheme::kAsprs);
  b.label_scheme = LabelScheme::kSemanticKitti;
  EXPECT_THROW(merge_maps(a, b), std::invalid_argument);
}

TEST(MergeMaps, TheResultDoesNotDependOnTheNumberOfThreads) {
  const VoxelMap a = build_map(street({-3, -4, 0}, 20'000, 12, Attributes::kAll), test::anchored({0, 0, 0}));
  const VoxelMap b = build_map(street({0, 1, 0.05}, 20'000, 13, Attributes::kAll), test::anchored({64, 0, 0}));
  const VoxelMap on_many = merge_maps(a, b);
  const ThreadLimit limit(1);
  expect_identical(merge_maps(a, b), on_many);
}

TEST(MergeMaps, EpsgCodesThatDifferAreRefused) {
  BuildOptions options = test::anchored({0, 0, 0});
  options.epsg = 25832;
  const VoxelMap a = single_point({1, 1, 1}, options);
  options.epsg = 32632;
  const VoxelMap b = single_point({1, 1, 1}, options);
  EXPECT_THROW(merge_maps(a, b), std::invalid_argument);
  EXPECT_EQ(message_of([&] { merge_maps(a, b); }), "maps of EPSG:25832 and EPSG:32632 cannot be merged");
  EXPECT_EQ(merge_maps(a, single_point({1, 1, 1})).frame.epsg, 25832);
  EXPECT_EQ(merge_maps(single_point({1, 1, 1}), a).frame.epsg, 25832);
}

TEST(MergeMaps, LevelsThatDifferAreRefused) {
  BuildOptions options = test::anchored({0, 0, 0});
  const VoxelMap a = single_point({1, 1, 1}, options);
  options.voxel_sizes = {0.1, 0.5};
  const VoxelMap b = single_point({1, 1, 1}, options);
  EXPECT_THROW(merge_maps(a, b), std::invalid_argument);
  EXPECT_EQ(message_of([&] { merge_maps(a, b); }), "maps with levels of 0.1, 1 m and of 0.1, 0.5 m cannot be merged");
  EXPECT_THROW(merge_maps(a, VoxelMap()), std::invalid_argument);
}

TEST(MergeMaps, AVoxelBeyondTheRangeOfIdsIsRefused) {
  const VoxelMap here = single_point({1, 1, 1});
  const VoxelMap there = single_point(test::kUtm, test::anchored(test::kUtm));
  EXPECT_THROW(merge_maps(here, there), std::out_of_range);
  EXPECT_EQ(message_of([&] { merge_maps(here, there); }),
            "a voxel of the map with anchor 548864 5804032 0 is more than 104857.6 m from the anchor 0 0 0, the "
            "farthest that voxel ids reach");
  const VoxelMap last = single_point({-104'857.55, 1, 1});
  EXPECT_EQ(merge_maps(here, last).finest().size(), 2U);
  EXPECT_THROW(merge_maps(single_point({65, 1, 1}, test::anchored({64, 0, 0})), last), std::out_of_range);
}

}  // namespace
}  // namespace vdbmap

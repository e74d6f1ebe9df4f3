// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/map_builder.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/brute_force.h"
#include "tests/support/random_points.h"
#include "tests/support/sample_maps.h"
#include "tests/support/threads.h"
#include "vdbmap/core/srgb.h"
#include "vdbmap/core/voxel_sums.h"

namespace vdbmap {
namespace {

const Eigen::AlignedBox3d kBlocks(Eigen::Vector3d(-14, -3, -0.7),
                                  Eigen::Vector3d(13, 3, 0.8));  // across blocks of 12.8 m

constexpr double kSize = 0.1;                         // [m]
constexpr double kQuantum = kSize / kQuantaPerVoxel;  // [m] each point is off by half of it at most
constexpr double kStep = kSize / kMeanSteps;          // [m] and the stored mean by half of it

PointCloud cloud_of(std::vector<Eigen::Vector3d> positions) {
  PointCloud cloud;
  cloud.positions = std::move(positions);
  return cloud;
}

VoxelMap map_of_points(std::vector<Eigen::Vector3d> positions) {
  return build_map(cloud_of(std::move(positions)), test::anchored({0, 0, 0}));
}

PointCloud at_utm(PointCloud cloud) {
  for (Eigen::Vector3d& point : cloud.positions) point += test::kUtm;
  return cloud;
}

// Of a stored covariance element, as a share of it.
double rounding_of(std::int64_t count) { return count <= 256 ? 0x1p-8 : 0x1p-16; }

// Mean and covariance as stored against those of the points, by the errors of points, mean and rounding.
void expect_moments(const VoxelRecord& record, const VoxelIndex& voxel, const Moments& expected) {
  EXPECT_EQ(record.count, expected.count);
  const double rounding = 1e-9;  // doubles at UTM coordinates
  EXPECT_LT((mean_of(record, voxel, kSize) - expected.mean).cwiseAbs().maxCoeff(), (kStep + kQuantum) / 2 + rounding);

  // A point off by q/2 in a voxel of edge s changes products of offsets by q/2 (|x| + |y|) <= q s.
  const Eigen::Matrix3d covariance = expected.covariance();
  const Eigen::Matrix3d error = covariance_of(record) - covariance;
  const double n_by_n_less_1 = expected.count > 1 ? static_cast<double>(expected.count) / (expected.count - 1.0) : 1;
  const Eigen::Array33d allowed =
      kQuantum * kSize * n_by_n_less_1 + rounding_of(expected.count) * covariance.array().abs();
  EXPECT_TRUE((error.array().abs() <= allowed).all()) << error << "\nallowed\n" << allowed;
}

Eigen::Vector3d mean_linear_color(const PointCloud& cloud, const std::vector<std::size_t>& numbers) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::size_t i : numbers) {
    const Rgb16& color = cloud.colors[i];
    sum += Eigen::Vector3d(linear_from_srgb(color.r), linear_from_srgb(color.g), linear_from_srgb(color.b));
  }
  return sum / (65535.0 * static_cast<double>(numbers.size()));
}

void expect_brute_force(const VoxelMap& map, const PointCloud& cloud) {
  const test::PointsByVoxel voxels = test::points_by_voxel(cloud.positions, kSize, map.frame.anchor);
  ASSERT_EQ(map.finest().size(), voxels.size());
  const VoxelFinder finder(map.finest());
  for (const auto& [voxel, numbers] : voxels) {
    const VoxelRecord* record = finder.find(voxel);
    ASSERT_NE(record, nullptr) << voxel;
    expect_moments(*record, voxel, test::two_pass_moments(cloud.positions, numbers, map.frame.anchor));
    const Eigen::Vector3d color = mean_linear_color(cloud, numbers);
    EXPECT_TRUE(((color_of(*record) - color).array().abs() <= 0x1.01p-8 * color.array()).all());  // 8 bits
  }
}

TEST(MapBuilder, EveryVoxelHoldsTheMomentsAndColorOfItsPoints) {
  const PointCloud dense =
      test::random_cloud(40'000, {Eigen::Vector3d(-0.95, -1.05, -0.5), Eigen::Vector3d(1, 1, 0.5)}, 1);
  expect_brute_force(build_map(dense, test::anchored({0, 0, 0})), dense);
  const PointCloud sparse = test::random_cloud(40'000, kBlocks, 2);
  expect_brute_force(build_map(sparse, test::anchored({0, 0, 0})), sparse);
}

TEST(MapBuilder, UtmCoordinatesLoseNothing) {
  const PointCloud cloud =
      at_utm(test::random_cloud(20'000, {Eigen::Vector3d(-2, -1, -0.5), Eigen::Vector3d(2, 1, 0.5)}, 3));
  const VoxelMap map = build_map(cloud);
  EXPECT_EQ(map.frame.anchor, test::kUtm);
  expect_brute_force(map, cloud);
}

TEST(MapBuilder, ScansAreMovedByTheirPose) {
  const PointCloud scan = test::random_cloud(20'000, kBlocks, 4);
  std::mt19937 random(4);
  Eigen::Isometry3d map_from_scan = test::random_motion(30, 123, random);
  map_from_scan.pretranslate(test::kUtm);
  MapBuilder builder{BuildOptions()};
  builder.add(scan, map_from_scan);
  EXPECT_EQ(builder.num_points(), scan.size());
  const VoxelMap map = builder.finish();

  PointCloud moved = scan;
  for (Eigen::Vector3d& point : moved.positions) point = map_from_scan * point;
  expect_brute_force(map, moved);
}

TEST(MapBuilder, TheOrderOfThePointsDoesNotMatter) {
  const PointCloud cloud = test::random_cloud(40'000, kBlocks, 5);
  const VoxelMap map = build_map(cloud, test::anchored({0, 0, 0}));
  EXPECT_EQ(test::difference(build_map(test::shuffled(cloud, 6), test::anchored({0, 0, 0})), map), "");
}

TEST(MapBuilder, TheCutIntoCallsDoesNotMatter) {
  const PointCloud cloud = test::random_cloud(40'000, kBlocks, 7);
  const VoxelMap map = build_map(cloud, test::anchored({0, 0, 0}));
  MapBuilder builder(test::anchored({0, 0, 0}));
  std::size_t begin = 0;
  for (const std::size_t end : {0UL, 1UL, 3UL, 17'000UL, 17'001UL, 40'000UL}) {
    builder.add(test::part_of(cloud, begin, end));
    begin = end;
  }
  EXPECT_EQ(builder.num_points(), cloud.size());
  EXPECT_EQ(test::difference(builder.finish(), map), "");
}

// Blocks that the builder knows, blocks that it does not, and voxels of both clouds.
TEST(MapBuilder, TheLastCloudMayComeWithFinish) {
  const Eigen::AlignedBox3d left(Eigen::Vector3d(-14, -3, -0.7), Eigen::Vector3d(1, 1, 0.8));
  const PointCloud first = test::random_cloud(30'000, left, 11);
  const PointCloud last = test::random_cloud(30'000, kBlocks, 12);
  const Eigen::Isometry3d pose(Eigen::Translation3d(0.3, -0.2, 0.1));
  MapBuilder one_by_one(test::anchored({0, 0, 0}));
  one_by_one.add(first);
  one_by_one.add(last, pose);
  const VoxelMap map = one_by_one.finish();

  MapBuilder at_once(test::anchored({0, 0, 0}));
  at_once.add(first);
  EXPECT_EQ(test::difference(at_once.finish(last, pose), map), "");
  EXPECT_EQ(at_once.num_points(), 0U);
  at_once.add(last, pose);
  EXPECT_EQ(test::difference(at_once.finish(first), map), "");
  at_once.add(first);
  at_once.add(last, pose);
  EXPECT_EQ(test::difference(at_once.finish(PointCloud()), map), "");
}

class MapBuilderThreads : public testing::TestWithParam<int> {};

TEST_P(MapBuilderThreads, TheNumberOfThreadsDoesNotMatter) {
  const PointCloud cloud = at_utm(test::random_cloud(100'000, kBlocks, 8));
  BuildOptions options;
  options.epoch = 3;
  options.voxel_sizes = {0.1, 0.2, 1};
  const VoxelMap map = test::on_threads(1, [&] { return build_map(cloud, options); });
  EXPECT_EQ(test::difference(test::on_threads(GetParam(), [&] { return build_map(cloud, options); }), map), "");
}

INSTANTIATE_TEST_SUITE_P(Threads, MapBuilderThreads, testing::Values(1, 2, 4));

TEST(MapBuilder, PointsOnABorderBelongToTheUpperVoxel) {
  std::vector<Eigen::Vector3d> corners;
  for (int i = -20; i < 20; ++i) corners.emplace_back(i / 10.0, -i / 10.0, 2 * i / 10.0);
  const VoxelMap map = map_of_points(corners);
  ASSERT_EQ(map.finest().size(), corners.size());
  const VoxelFinder finder(map.finest());
  for (int i = -20; i < 20; ++i) {
    const VoxelIndex voxel(i, -i, 2 * i);
    ASSERT_NE(finder.find(voxel), nullptr) << i;
    const Eigen::Vector3d from_corner = mean_of(*finder.find(voxel), voxel, kSize) - corner_of_voxel(voxel, kSize);
    EXPECT_LT(from_corner.maxCoeff(), kStep);
  }
}

TEST(MapBuilder, DecimalUtmCoordinatesOnABorderBelongToTheUpperVoxel) {
  // Times ten they are whole again, to the last bit (Goldberg 1991, theorem 7).
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 1000; ++i) corners.emplace_back((5'488'640 + i) / 10.0, (58'040'320 + i) / 10.0, 0.05);
  const VoxelMap map = build_map(cloud_of(corners), test::anchored(test::kUtm));
  const VoxelFinder finder(map.finest());
  for (int i = 0; i < 1000; ++i) EXPECT_NE(finder.find({i, i, 0}), nullptr) << i;
}

TEST(MapBuilder, PointsAHairBelowABorderStayThere) {
  // -1e-20 is in voxel -1, but 1 - 1e-20 is 1 in doubles: the upper end of the voxel, not the lower.
  for (const double hair : {1e-20, 1e-17, 1e-12, 1e-8}) {
    const VoxelMap map = map_of_points({{-hair, 0.05, 0.05}});
    ASSERT_EQ(map.finest().size(), 1U);
    const VoxelRecord* record = VoxelFinder(map.finest()).find({-1, 0, 0});
    ASSERT_NE(record, nullptr);
    EXPECT_NEAR(mean_of(*record, {-1, 0, 0}, kSize).x(), 0, kStep) << hair;
  }
}

TEST(MapBuilder, OnePointHasNoCovarianceAndNoPlane) {
  const VoxelMap map = map_of_points({{-0.234, 12.3, 4.56}});
  ASSERT_EQ(map.levels.size(), 2U);
  for (const VoxelLevel& level : map.levels) {
    ASSERT_EQ(level.size(), 1U);
    EXPECT_EQ(level.records()[0].count, 1U);
    EXPECT_EQ(covariance_of(level.records()[0]), Eigen::Matrix3d::Zero());
    EXPECT_EQ(planarity_of(level.records()[0]), 0);
  }
}

TEST(MapBuilder, RepeatedPointsHaveNoCovariance) {
  const VoxelMap map = map_of_points(std::vector<Eigen::Vector3d>(1000, Eigen::Vector3d(-7.777, 0.123, 99.99)));
  ASSERT_EQ(map.finest().size(), 1U);
  EXPECT_EQ(map.finest().records()[0].count, 1000U);
  EXPECT_EQ(covariance_of(map.finest().records()[0]), Eigen::Matrix3d::Zero());
}

TEST(MapBuilder, NoPointsMakeAnEmptyMap) {
  const VoxelMap map = build_map(PointCloud());
  ASSERT_EQ(map.levels.size(), 2U);
  EXPECT_EQ(map.finest().size(), 0U);
  EXPECT_EQ(map.coarsest().size(), 0U);
  EXPECT_EQ(map.frame.anchor, Eigen::Vector3d::Zero());
  EXPECT_EQ(extent(map), std::nullopt);
}

TEST(MapBuilder, IsEmptyAfterFinish) {
  MapBuilder builder(test::anchored({0, 0, 0}));
  builder.add(test::random_cloud(100, kBlocks, 9));
  builder.finish();
  EXPECT_EQ(builder.num_points(), 0U);
  EXPECT_EQ(builder.finish().finest().size(), 0U);
}

TEST(MapBuilder, ChoosesTheAnchorNearTheFirstPointOfTheFirstScan) {
  MapBuilder builder{BuildOptions()};
  builder.add(PointCloud());  // says nothing
  const Eigen::Isometry3d map_from_scan(Eigen::Translation3d(test::kUtm + Eigen::Vector3d(500, -500, 100)));
  builder.add(cloud_of({{1, 1, 1}, {-1, 2, 3}}), map_from_scan);
  builder.add(cloud_of({{4000, 0, 0}}), map_from_scan);
  EXPECT_EQ(builder.finish().frame.anchor, test::kUtm);
}

TEST(MapBuilder, AnchorsMoveVoxelsByWholeTiles) {
  const PointCloud cloud = test::random_cloud(10'000, kBlocks, 10);
  const VoxelMap here = build_map(cloud, test::anchored({0, 0, 0}));
  const VoxelMap there = build_map(cloud, test::anchored({-64, 128, 64}));
  ASSERT_EQ(there.finest().size(), here.finest().size());
  const VoxelFinder finder(there.finest());
  for_each_voxel(here.finest(), [&](const VoxelIndex& voxel, std::size_t number) {
    const VoxelRecord* record = finder.find(voxel + VoxelIndex(640, -1280, -640));
    ASSERT_NE(record, nullptr);
    EXPECT_EQ(record->count, here.finest().records()[number].count);
  });
}

TEST(MapBuilder, PointsBeyondTheRangeOfIdsAreRefusedByName) {
  const double limit = kIndexLimit * kSize;  // 104,857.6 m
  EXPECT_EQ(map_of_points({{limit - 0.05, -limit, 0}}).finest().size(), 1U);
  EXPECT_THROW(map_of_points({{limit, 0, 0}}), std::out_of_range);
  EXPECT_THROW(map_of_points({{0, -limit - 0.05, 0}}), std::out_of_range);
  EXPECT_THROW(map_of_points({{0, 0, std::numeric_limits<double>::quiet_NaN()}}), std::out_of_range);
  EXPECT_THROW(map_of_points({{0, 0, 0}, {0, std::numeric_limits<double>::infinity(), 0}}), std::out_of_range);
  try {
    map_of_points({{0, 0, 0}, {1, 234567.5, 2}});
    FAIL() << "nothing was thrown";
  } catch (const std::out_of_range& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("234567.5"), std::string::npos) << message;
    EXPECT_NE(message.find("104857.6 m from the anchor"), std::string::npos) << message;
  }
}

TEST(MapBuilder, PointsBeyondTheRangeOfIdsAreLeftOutAndCounted) {
  const std::vector<Eigen::Vector3d> near = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  std::vector<Eigen::Vector3d> all = near;
  all.insert(all.begin() + 1, {{2e5, 0, 0}, {0, -3e5, 0}});
  MapBuilder builder(test::anchored({0, 0, 0}));
  builder.add(cloud_of(all));
  EXPECT_EQ(builder.unreachable().count, 2U);
  EXPECT_EQ(builder.unreachable().first, Eigen::Vector3d(2e5, 0, 0));
  EXPECT_DOUBLE_EQ(builder.unreachable().reach, 104'857.6);
  EXPECT_EQ(builder.num_points(), 3U);
  builder.add(cloud_of({{1, 1, 1}}));
  EXPECT_EQ(builder.unreachable().count, 0U);
  const VoxelMap map = builder.finish(cloud_of(all));
  EXPECT_EQ(builder.unreachable().count, 2U);

  MapBuilder expected(test::anchored({0, 0, 0}));
  for (const auto& points : {near, {{1, 1, 1}}, near}) expected.add(cloud_of(points));
  EXPECT_EQ(test::difference(map, expected.finish()), "");
}

// Points of a street in UTM coordinates, and one that a driver left at the origin.
TEST(MapBuilder, AStrayPointDoesNotChooseTheAnchorWhereverItStands) {
  const PointCloud street = test::random_cloud(
      5000, {test::kUtm - Eigen::Vector3d(80, 60, 10), test::kUtm + Eigen::Vector3d(80, 60, 10)}, 41);
  const VoxelMap expected = build_map(street);
  for (const std::size_t place : {std::size_t{0}, std::size_t{1}, street.size() / 2, street.size()}) {
    for (const Eigen::Vector3d& stray :
         {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(-1e12, 3, 1e300), Eigen::Vector3d(1e10, 0, 0)}) {
      PointCloud cloud = street;
      const auto at = [place](auto& values) { return values.begin() + static_cast<std::ptrdiff_t>(place); };
      cloud.positions.insert(at(cloud.positions), stray);
      cloud.colors.insert(at(cloud.colors), Rgb16{1, 2, 3});
      cloud.intensities.insert(at(cloud.intensities), 5.0f);
      cloud.labels.insert(at(cloud.labels), std::uint16_t{3});
      EXPECT_EQ(test::difference(build_map(cloud), expected), "") << stray.transpose() << " at " << place;
      EXPECT_EQ(test::difference(build_map(cloud, test::anchored(test::kUtm)), expected), "");
    }
  }
}

TEST(MapBuilder, NothingIsMappedThatNoFileCouldHold) {
  for (const double far : {1e9, 1e10, 1e300}) {
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3d point(1, 2, 3);
      point[axis] = -far;
      EXPECT_THROW(build_map(cloud_of({point, point})), std::out_of_range) << far;
    }
  }
  const VoxelMap farthest = build_map(cloud_of({{9.9999e8, -9.9999e8, 0}}));
  EXPECT_TRUE(is_anchor(farthest.frame.anchor));
}

TEST(MapBuilder, OptionsThatMakeNoMapAreRefused) {
  for (const std::vector<double>& sizes : std::vector<std::vector<double>>{
           {}, {0.3}, {0.1, 0.25}, {1, 0.1}, {0.1, 0.1}, {0.1, 1, 0.5}, {-0.1}, {std::nan("")}}) {
    BuildOptions options;
    options.voxel_sizes = sizes;
    EXPECT_THROW(MapBuilder{options}, std::invalid_argument);
  }
  for (const Eigen::Vector3d& anchor : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(64, 32, 0),
                                        Eigen::Vector3d(0, 0, std::nan("")), Eigen::Vector3d(0, 64e9, 0)}) {
    EXPECT_THROW(MapBuilder{test::anchored(anchor)}, std::invalid_argument) << anchor.transpose();
  }
  EXPECT_NO_THROW(MapBuilder{test::anchored({-64, 5'804'032, 128})});
}

TEST(MapBuilder, IntensitiesAreAveraged) {
  const PointCloud cloud =
      test::random_cloud(20'000, {Eigen::Vector3d(-0.5, -0.5, -0.5), Eigen::Vector3d(0.5, 0.5, 0.5)}, 11);
  const VoxelMap map = build_map(cloud, test::anchored({0, 0, 0}));
  const std::vector<float>& intensities = map.finest().channels().intensities;
  ASSERT_EQ(intensities.size(), map.finest().size());
  const test::PointsByVoxel voxels = test::points_by_voxel(cloud.positions, kSize);
  for_each_voxel(map.finest(), [&](const VoxelIndex& voxel, std::size_t number) {
    double sum = 0;
    for (const std::size_t i : voxels.at(voxel)) sum += cloud.intensities[i];
    const double mean = sum / static_cast<double>(voxels.at(voxel).size());
    EXPECT_NEAR(intensities[number], mean, mean * 1e-7 + 1e-5);  // a float; points counted in 2^-16
  });
}

TEST(MapBuilder, PointsWithoutAttributesDoNotCountAmongThoseThatHaveThem) {
  PointCloud plain = cloud_of(std::vector<Eigen::Vector3d>(3, Eigen::Vector3d(0.02, 0.02, 0.02)));
  PointCloud known = cloud_of({{0.08, 0.08, 0.08}});
  known.colors = {{65535, 0, 65535}};
  known.intensities = {42};
  MapBuilder builder(test::anchored({0, 0, 0}));
  builder.add(plain);
  builder.add(known);
  const VoxelMap map = builder.finish();
  ASSERT_EQ(map.finest().size(), 1U);
  EXPECT_EQ(map.finest().records()[0].count, 4U);
  EXPECT_EQ(color_of(map.finest().records()[0]), Eigen::Vector3d(1, 0, 1));
  EXPECT_EQ(map.finest().channels().intensities, std::vector<float>{42});
}

TEST(MapBuilder, IntensitiesThatAreDamageDoNotCount) {
  PointCloud cloud = cloud_of(std::vector<Eigen::Vector3d>(6, Eigen::Vector3d(0.02, 0.02, 0.02)));
  const float infinity = std::numeric_limits<float>::infinity();
  cloud.intensities = {3, std::nanf(""), infinity, -infinity, 1e30f, 5};
  const VoxelMap map = build_map(cloud, test::anchored({0, 0, 0}));
  EXPECT_EQ(map.finest().records()[0].count, 6U);
  EXPECT_EQ(map.finest().channels().intensities, std::vector<float>{4});
}

TEST(MapBuilder, AttributesNobodyGaveAreAbsent) {
  const VoxelMap map = map_of_points({{1, 2, 3}});
  EXPECT_FALSE(map.has_color);
  for (const VoxelLevel& level : map.levels) {
    EXPECT_TRUE(level.channels().intensities.empty());
    EXPECT_TRUE(level.channels().first_epochs.empty());
    EXPECT_TRUE(level.channels().last_epochs.empty());
  }
}

TEST(MapBuilder, EpochAndReferenceSystemAreKept) {
  BuildOptions options;
  options.epoch = -7;
  options.epsg = 25832;
  const VoxelMap map = build_map(test::random_cloud(1000, kBlocks, 12), options);
  EXPECT_EQ(map.frame.epsg, 25832);
  EXPECT_TRUE(map.has_color);
  for (const VoxelLevel& level : map.levels) {
    EXPECT_EQ(level.channels().first_epochs, std::vector<std::int32_t>(level.size(), -7));
    EXPECT_EQ(level.channels().last_epochs, std::vector<std::int32_t>(level.size(), -7));
  }
}

TEST(MapBuilder, CloudsOfSeveralChunksAreCountedWhole) {
  const std::size_t chunk = std::size_t{1} << 23;
  PointCloud cloud;
  cloud.positions.assign(chunk, {0.05, 0.05, 0.05});
  cloud.intensities.assign(chunk, 2);
  cloud.positions.insert(cloud.positions.end(), {{0.02, 0.05, 0.05}, {7.05, 0.05, 0.05}});
  cloud.intensities.insert(cloud.intensities.end(), {3, 9});
  const VoxelMap map = build_map(cloud, test::anchored({0, 0, 0}));

  ASSERT_EQ(map.finest().size(), 2U);
  EXPECT_EQ(map.finest().records()[0].count, chunk + 1);
  EXPECT_EQ(map.finest().records()[1].count, 1U);
  EXPECT_EQ(map.finest().channels().intensities[1], 9);
  // One point 3 cm aside of n: the variance is 0.03^2 / n, exact to sixteen bits for all its smallness.
  const double variance = 0.03 * 0.03 / static_cast<double>(chunk + 1);
  EXPECT_NEAR(covariance_of(map.finest().records()[0])(0, 0), variance, 1e-4 * variance);
}

TEST(MapBuilder, StartsAnewAfterFinish) {
  PointCloud colored;
  colored.positions = {{5000, 0, 0}};
  colored.colors = {{1, 2, 3}};
  PointCloud plain;
  plain.positions = {{1, 0, 0}};

  MapBuilder builder{BuildOptions()};
  builder.add(colored);
  EXPECT_EQ(builder.finish().frame.anchor.x(), 5120);
  builder.add(plain);
  const VoxelMap second = builder.finish();
  EXPECT_EQ(second.frame.anchor.x(), 0);
  EXPECT_FALSE(second.has_color);
  EXPECT_EQ(second.finest().size(), 1u);
}

}  // namespace
}  // namespace vdbmap

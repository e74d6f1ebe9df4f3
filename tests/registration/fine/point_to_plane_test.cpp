// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/point_to_plane.h"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

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

VoxelMap map_of(const test::Scene& scene, const Eigen::Vector3d& origin = Eigen::Vector3d::Zero(),
                const std::vector<double>& voxel_sizes = {0.1, 1}) {
  BuildOptions options;
  options.voxel_sizes = voxel_sizes;
  options.anchor = origin;
  const Eigen::Isometry3d moved_to(Eigen::Translation3d{origin});
  return build_map(test::moved(test::sample_scene(scene, 250, 1), moved_to), options);
}

const VoxelMap& street_map() {
  static const VoxelMap map = map_of(test::street());
  return map;
}

// A scanner on a car, at a random place of the street with a random heading.
Eigen::Isometry3d pose_in_street(std::mt19937& random) {
  std::uniform_real_distribution<double> along(-15, 15);
  std::uniform_real_distribution<double> across(-1.5, 1.5);
  std::uniform_real_distribution<double> heading(-3.14, 3.14);
  const double x = along(random);
  const double y = across(random);
  return Eigen::Translation3d(x, y, 1.8) * Eigen::AngleAxisd(heading(random), Eigen::Vector3d::UnitZ());
}

// A guess `distance` off in any level direction and `angle_deg` in heading.
Eigen::Isometry3d level_guess(const Eigen::Isometry3d& pose, double distance, double angle_deg, std::mt19937& random) {
  std::uniform_real_distribution<double> bearing(-3.14, 3.14);
  const double angle = bearing(random) > 0 ? angle_deg : -angle_deg;
  const double toward = bearing(random);
  Eigen::Isometry3d guess = pose * Eigen::AngleAxisd(angle * EIGEN_PI / 180, Eigen::Vector3d::UnitZ());
  guess.pretranslate(Eigen::Vector3d(distance * std::cos(toward), distance * std::sin(toward), 0));
  return guess;
}

// A guess `distance` off in any direction and turned by `angle_deg` about any axis.
Eigen::Isometry3d any_guess(const Eigen::Isometry3d& pose, double distance, double angle_deg, std::mt19937& random) {
  const Eigen::Isometry3d offset = test::random_motion(distance, angle_deg, random);
  Eigen::Isometry3d guess = pose;
  guess.linear() = offset.linear() * pose.linear();
  guess.translation() += offset.translation();
  return guess;
}

// Rotation vector about the sensor and translation, in the axes of the map.
Vector6d motion_between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  const Eigen::AngleAxisd turn(to.linear() * from.linear().transpose());
  Vector6d motion;
  motion << turn.angle() * turn.axis(), to.translation() - from.translation();
  return motion;
}

// Means of voxels are exact; normals are off by up to 0.7 degrees, a quarter of that at random, over at most 7 cm: a
// millimetre a point, which hundreds of points average out.
void expect_at(const FineResult& result, const Eigen::Isometry3d& pose) {
  const test::PoseDistance error = test::distance_between(result.map_from_scan, pose);
  EXPECT_LT(error.translation, 0.005);
  EXPECT_LT(error.rotation_deg, 0.05);
  EXPECT_TRUE(result.converged);
  EXPECT_GT(result.inlier_share, 0.8);
  EXPECT_TRUE(result.unobservable.empty());
}

class PointToPlaneSeed : public testing::TestWithParam<unsigned> {};

TEST_P(PointToPlaneSeed, FindsAScanInAStreetFromTwoMetresAndTenDegrees) {
  std::mt19937 random(GetParam());
  const Eigen::Isometry3d pose = pose_in_street(random);
  const PointCloud scan = test::scan_scene(test::street(), pose);
  expect_at(align_scan(scan, street_map(), level_guess(pose, 2, 10, random)), pose);
  expect_at(align_scan(scan, street_map(), any_guess(pose, 2, 10, random)), pose);
}

INSTANTIATE_TEST_SUITE_P(Seeds, PointToPlaneSeed, testing::Range(1U, test::kIsSanitized ? 3U : 13U));

TEST(PointToPlane, ATrueGuessStaysWhereItIs) {
  std::mt19937 random(22);
  const Eigen::Isometry3d pose = pose_in_street(random);
  const FineResult result = align_scan(test::scan_scene(test::street(), pose), street_map(), pose);
  expect_at(result, pose);
  EXPECT_LT(result.rms_distance, 0.03);
  EXPECT_GT(result.num_points, 500U);
}

TEST(PointToPlane, FindsAScanInAMapAtUtmCoordinates) {
  std::mt19937 random(23);
  const Eigen::Isometry3d pose = pose_in_street(random);
  const PointCloud scan = test::scan_scene(test::street(), pose);
  const Eigen::Isometry3d guess = level_guess(pose, 1, 5, random);
  const VoxelMap map = map_of(test::street(), test::kUtm);
  ASSERT_EQ(map.frame.anchor, test::kUtm);

  const Eigen::Isometry3d utm_from_local(Eigen::Translation3d{test::kUtm});
  const FineResult at_utm = align_scan(scan, map, utm_from_local * guess);
  expect_at(at_utm, utm_from_local * pose);
  // The same as without the anchor but for points that rounding at UTM values (1e-9 m) put one quantum aside, which
  // may let a voxel join the surface beside it or not.
  const FineResult local = align_scan(scan, street_map(), guess);
  EXPECT_LT(test::distance_between(at_utm.map_from_scan, utm_from_local * local.map_from_scan).translation, 3e-4);
}

TEST(PointToPlane, DoesNotDependOnTheNumberOfThreads) {
  std::mt19937 random(24);
  const Eigen::Isometry3d pose = pose_in_street(random);
  const PointCloud scan = test::scan_scene(test::street(), pose, {.range_noise = 0.02});
  const Eigen::Isometry3d guess = level_guess(pose, 2, 10, random);
  const auto align = [&] { return align_scan(scan, street_map(), guess); };
  const FineResult on_one = test::on_threads(1, align);
  for (const int threads : {2, 4}) {
    const FineResult on_many = test::on_threads(threads, align);
    EXPECT_EQ(on_many.map_from_scan.matrix(), on_one.map_from_scan.matrix());
    EXPECT_EQ(on_many.covariance, on_one.covariance);
    EXPECT_EQ(on_many.inlier_share, on_one.inlier_share);
    EXPECT_EQ(on_many.rms_distance, on_one.rms_distance);
  }
}

class PointToPlaneLevels : public testing::TestWithParam<std::vector<double>> {};

TEST_P(PointToPlaneLevels, FindsAScanFromThirtyCentimetres) {
  std::mt19937 random(25);
  const Eigen::Isometry3d pose = pose_in_street(random);
  const PointCloud scan = test::scan_scene(test::street(), pose);
  const VoxelMap map = map_of(test::street(), Eigen::Vector3d::Zero(), GetParam());
  ASSERT_EQ(map.levels.size(), GetParam().size());
  expect_at(align_scan(scan, map, level_guess(pose, 0.1, 1, random)), pose);
  if (map.levels.size() > 1) expect_at(align_scan(scan, map, level_guess(pose, 0.3, 2, random)), pose);
}

INSTANTIATE_TEST_SUITE_P(Levels, PointToPlaneLevels,
                         testing::Values(std::vector<double>{0.1}, std::vector<double>{0.1, 0.5},
                                         std::vector<double>{0.1, 0.5, 1}));

TEST(PointToPlane, FindsAScanInARoom) {
  const VoxelMap map = map_of(test::room());
  std::mt19937 random(26);
  for (int i = 0; i < (test::kIsSanitized ? 2 : 6); ++i) {
    const Eigen::Isometry3d pose =
        Eigen::Translation3d(0.3 * i - 1, 0.2 * i - 0.5, 1.4) * Eigen::AngleAxisd(i, Eigen::Vector3d::UnitZ());
    FineOptions options;
    options.coarse_spacing = 0.4;
    options.fine_spacing = 0.25;
    const PointCloud scan = test::scan_scene(test::room(), pose);
    expect_at(align_scan(scan, map, level_guess(pose, 0.3, 5, random), options), pose);
  }
}

TEST(PointToPlane, NamesTheDirectionAlongACorridor) {
  const Eigen::Isometry3d pose(Eigen::Translation3d(1, 0.3, 1.5));
  const FineResult result = align_scan(test::scan_scene(test::corridor(), pose), map_of(test::corridor()), pose);
  ASSERT_EQ(result.unobservable.size(), 1U);
  EXPECT_GT(std::abs(result.unobservable[0].motion[3]), 0.99) << result.unobservable[0].description;
  EXPECT_GT(std::sqrt(result.covariance(3, 3)), 10 * std::sqrt(result.covariance(4, 4)));
}

TEST(PointToPlane, CovarianceTellsHowFarNoisyScansScatter) {
  const VoxelMap map = map_of(test::room());
  const Eigen::Isometry3d pose(Eigen::Translation3d(0.6, -0.4, 1.4));
  FineOptions options;
  options.fine_spacing = 0.4;
  constexpr int kTrials = test::kIsSanitized ? 10 : 60;
  std::vector<FineResult> results;
  std::vector<Vector6d> errors;
  Vector6d mean = Vector6d::Zero();
  for (unsigned trial = 0; trial < kTrials; ++trial) {
    const test::Scanner scanner{.num_azimuths = 360, .range_noise = 0.03, .seed = trial};
    results.push_back(align_scan(test::scan_scene(test::room(), pose, scanner), map, pose, options));
    errors.push_back(motion_between(pose, results.back().map_from_scan));
    mean += errors.back() / kTrials;
  }

  double chi_squared = 0;  // about the mean: the voxels' own errors are the same in all trials
  for (int i = 0; i < kTrials; ++i) {
    chi_squared += (errors[i] - mean).dot(results[i].covariance.ldlt().solve(errors[i] - mean));
  }
  const double freedom = 6 * (kTrials - 1);
  // Four standard deviations of chi squared; below, the share of the covariance that stands for the voxels' own errors.
  EXPECT_LT(chi_squared, freedom + 4 * std::sqrt(2 * freedom));
  EXPECT_GT(chi_squared, 0.5 * freedom);
  EXPECT_LT(mean.tail<3>().norm(), 0.005);  // as without noise
}

void expect_lost(const FineResult& result, const Eigen::Isometry3d& guess) {
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.inlier_share, 0);
  EXPECT_EQ(result.rms_distance, 0);
  EXPECT_EQ(result.unobservable.size(), 6U);
  EXPECT_TRUE(result.covariance.allFinite());
  EXPECT_GT(std::sqrt(result.covariance(3, 3)), 1.9);  // nothing is known beyond the guess
  EXPECT_TRUE(result.map_from_scan.isApprox(guess, 1e-12));
}

TEST(PointToPlane, AnEmptyScanIsLost) {
  const Eigen::Isometry3d guess(Eigen::Translation3d(1, 2, 3));
  expect_lost(align_scan(PointCloud(), street_map(), guess), guess);
}

TEST(PointToPlane, AScanOutOfRangeIsLost) {
  PointCloud scan;
  scan.positions = {{0.1, 0.2, 0.3}, {200, 0, 0}, {0, -101, 0}};
  const FineResult result = align_scan(scan, street_map(), Eigen::Isometry3d::Identity());
  expect_lost(result, Eigen::Isometry3d::Identity());
  EXPECT_EQ(result.num_points, 0U);
}

TEST(PointToPlane, AScanFarOutsideTheMapIsLost) {
  const PointCloud scan = test::scan_scene(test::street(), Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1.8)));
  for (const double distance : {2000.0, -90'000.0, 1e8}) {
    const Eigen::Isometry3d guess(Eigen::Translation3d(distance, 0, 0));
    expect_lost(align_scan(scan, street_map(), guess), guess);
  }
}

TEST(PointToPlane, AScanInAnEmptyMapIsLost) {
  const PointCloud scan = test::scan_scene(test::street(), Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1.8)));
  expect_lost(align_scan(scan, build_map(PointCloud()), Eigen::Isometry3d::Identity()), Eigen::Isometry3d::Identity());
}

TEST(PointToPlane, AMapWithoutLevelsIsRefused) {
  EXPECT_THROW(align_scan(PointCloud(), VoxelMap(), Eigen::Isometry3d::Identity()), std::invalid_argument);
}

TEST(PointToPlane, GuessesThatAreNoPosesAreRefused) {
  const PointCloud scan = test::scan_scene(test::street(), Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1.8)));
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Eigen::Isometry3d guess = Eigen::Isometry3d::Identity();
    guess.translation().y() = bad;
    EXPECT_THROW(align_scan(scan, street_map(), guess), std::invalid_argument);
    guess = Eigen::Isometry3d::Identity();
    guess.linear()(1, 2) = bad;
    EXPECT_THROW(align_scan(scan, street_map(), guess), std::invalid_argument);
  }
  Eigen::Isometry3d guess = Eigen::Isometry3d::Identity();
  guess.linear() *= 1.01;
  EXPECT_THROW(align_scan(scan, street_map(), guess), std::invalid_argument);
  guess.linear() = Eigen::Vector3d(1, 1, -1).asDiagonal();  // a mirror
  EXPECT_THROW(align_scan(scan, street_map(), guess), std::invalid_argument);
}

TEST(PointToPlane, OptionsOutOfRangeAreRefused) {
  const auto expect_refused = [](const auto& change) {
    FineOptions options;
    change(options);
    EXPECT_THROW(options.check(), std::invalid_argument);
    EXPECT_THROW(align_scan(PointCloud(), street_map(), Eigen::Isometry3d::Identity(), options), std::invalid_argument);
  };
  EXPECT_NO_THROW(FineOptions().check());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, -1.0, nan}) {
    expect_refused([&](FineOptions& options) { options.fine_spacing = bad; });
    expect_refused([&](FineOptions& options) { options.coarse_spacing = bad; });
    expect_refused([&](FineOptions& options) { options.range.max = bad; });
  }
  expect_refused([](FineOptions& options) { options.range.min = -0.1; });
  expect_refused([](FineOptions& options) { options.range = {5, 5}; });
  expect_refused([](FineOptions& options) { options.max_iterations = 0; });
}

}  // namespace
}  // namespace vdbmap::registration

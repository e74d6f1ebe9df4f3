// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/odometry.h"

#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/moving_scanner.h"
#include "tests/support/pose_distance.h"
#include "tests/support/random_points.h"
#include "tests/support/threads.h"

namespace vdbmap::registration {
namespace {

constexpr double kPeriod = 0.1;  // [s] of a turn

// [m] of poses after some scans of few rings. A scan moves 0.8 m; the map's points are 0.22 m and more apart.
constexpr double kTolerance = 0.15;

// The street with some things in it: between bare planes the rings of a scanner that moves along them stay as
// they are, which no point-to-point alignment can see through.
test::Scene rough_street() {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> along(-28, 28);
  std::uniform_real_distribution<double> across(-8.5, 8.5);
  std::uniform_real_distribution<double> size(0.2, 0.9);
  test::Scene scene = test::street();
  for (int i = 0; i < 60; ++i) {
    const double y = across(random);
    const double x = along(random);
    const Eigen::Vector3d corner(x, y, 0);
    if (std::abs(corner.y()) < 2) continue;  // of the lane
    const Eigen::Vector3d edges = test::vector_of([&] { return size(random); }).cwiseProduct(Eigen::Vector3d(1, 1, 3));
    for (const test::Rectangle& side : test::box(corner, corner + edges)) scene.push_back(side);
  }
  return scene;
}

// A drive along the street that swerves a little: 8 m/s.
Eigen::Isometry3d sensor_at(double seconds) {
  const double x = -20 + 8 * seconds;
  const double heading = 0.1 * std::sin(2 * seconds);
  return Eigen::Translation3d(x, 0.3 * std::sin(seconds), 1.8) *
         Eigen::AngleAxisd(heading, Eigen::Vector3d(0.02, 0.05, 1).normalized());
}

test::Scanner scanner(int number) {
  test::Scanner scanner;
  scanner.range_noise = 0.02;
  scanner.seed = static_cast<unsigned>(number);
  scanner.num_azimuths = 400;
  scanner.num_beams = 24;
  return scanner;
}

// The scan of turn `number` as if taken all at its begin.
PointCloud still_scan(int number) {
  return test::scan_scene(rough_street(), sensor_at(kPeriod * number), scanner(number));
}

PointCloud moving_scan(int number) {
  return test::scan_while_moving(rough_street(), sensor_at, kPeriod * number, kPeriod, scanner(number));
}

Eigen::Isometry3d true_pose(int number) { return sensor_at(0).inverse() * sensor_at(kPeriod * number); }

test::PoseDistance error_of(const OdometryStep& step, int number) {
  return test::distance_between(step.first_from_scan, true_pose(number));
}

TEST(Odometry, FollowsADriveFromScanToScan) {
  Odometry odometry;
  for (int i = 0; i < 12; ++i) {
    const OdometryStep step = odometry.register_scan(still_scan(i));
    ASSERT_TRUE(step.registered()) << i << ": " << step.reason;
    EXPECT_LT(error_of(step, i).translation, kTolerance) << i;
    EXPECT_LT(error_of(step, i).rotation_deg, 1.5) << i;  // few rings see ground on both sides of the lane only
    EXPECT_FALSE(step.was_refound) << i;
  }
}

TEST(Odometry, DeskewsScansOfAMovingScanner) {
  Odometry odometry;
  Odometry without([] {
    OdometryOptions options;
    options.deskews = false;
    return options;
  }());
  double worst = 0;
  double worst_without = 0;
  for (int i = 0; i < 10; ++i) {
    const PointCloud scan = moving_scan(i);
    const OdometryStep step = odometry.register_scan(scan);
    ASSERT_TRUE(step.registered()) << i << ": " << step.reason;
    EXPECT_TRUE(step.has_time);
    EXPECT_EQ(step.motion.reference_time, scan.times.front());
    worst = std::max(worst, error_of(step, i).translation);
    const OdometryStep step_without = without.register_scan(scan);
    EXPECT_TRUE(step_without.motion.twist.isZero(0));
    worst_without = std::max(worst_without, error_of(step_without, i).translation);
  }
  // The pose is that of a scan's first point from the first scan on, which was taken on the move as well.
  EXPECT_LT(worst, kTolerance);
  EXPECT_GT(worst_without, 1.5 * worst);
}

TEST(Odometry, TheFirstScanIsAtTheOriginAndStepsLeadFromScanToScan) {
  Odometry odometry;
  const OdometryStep first = odometry.register_scan(still_scan(0));
  EXPECT_TRUE(first.registered());
  EXPECT_TRUE(first.first_from_scan.isApprox(Eigen::Isometry3d::Identity(), 0));
  EXPECT_FALSE(first.covariance);
  Eigen::Isometry3d chain = Eigen::Isometry3d::Identity();
  for (int i = 1; i < 4; ++i) {
    const OdometryStep step = odometry.register_scan(still_scan(i));
    chain = chain * step.previous_from_scan;
    EXPECT_TRUE(chain.isApprox(step.first_from_scan, 1e-12));
    ASSERT_TRUE(step.covariance);
    EXPECT_GT(step.covariance->ldlt().vectorD().minCoeff(), 0);
  }
}

TEST(Odometry, CovariancesAreAsLargeAsTheErrors) {
  Odometry odometry;
  Eigen::Isometry3d previous = Eigen::Isometry3d::Identity();
  double sum = 0;
  double count = 0;
  for (int i = 0; i < 15; ++i) {
    const OdometryStep step = odometry.register_scan(still_scan(i));
    if (i >= 3) {
      const Eigen::Isometry3d truth = true_pose(i - 1).inverse() * true_pose(i);
      const Eigen::AngleAxisd turn(truth.linear() * step.previous_from_scan.linear().transpose());
      Vector6d error;
      error << turn.angle() * turn.axis(), truth.translation() - step.previous_from_scan.translation();
      sum += error.dot(step.covariance->ldlt().solve(error));
      ++count;
    }
    previous = step.first_from_scan;
  }
  // Six on average for the exact covariance.
  EXPECT_GT(sum / count, 2);
  EXPECT_LT(sum / count, 18);
}

TEST(Odometry, IsTheSameForAnyNumberOfThreads) {
  const auto poses = [] {
    Odometry odometry;
    std::vector<double> numbers;
    for (int i = 0; i < 6; ++i) {
      const OdometryStep step = odometry.register_scan(moving_scan(i < 4 ? i : i + 12));
      const auto matrix = step.first_from_scan.matrix().reshaped();
      numbers.insert(numbers.end(), matrix.begin(), matrix.end());
      const Matrix6d covariance = step.covariance.value_or(Matrix6d::Zero());
      numbers.insert(numbers.end(), covariance.reshaped().begin(), covariance.reshaped().end());
    }
    return numbers;
  };
  EXPECT_EQ(test::on_threads(1, poses), test::on_threads(4, poses));
}

TEST(Odometry, ARepeatedScanDoesNotMove) {
  Odometry odometry;
  const PointCloud scan = still_scan(0);
  odometry.register_scan(scan);
  const std::size_t num_points = odometry.map().num_points();
  for (int i = 0; i < 3; ++i) {
    const OdometryStep step = odometry.register_scan(scan);
    EXPECT_TRUE(step.registered());
    // Not zero: the map leaves out points that are too near to others.
    EXPECT_LT(test::distance_between(step.first_from_scan, Eigen::Isometry3d::Identity()).translation, 2e-3);
    EXPECT_LT(test::distance_between(step.first_from_scan, Eigen::Isometry3d::Identity()).rotation_deg, 1e-2);
  }
  EXPECT_LT(odometry.map().num_points(), num_points + num_points / 20);
}

PointCloud without_points() { return {}; }

PointCloud few_points() {
  PointCloud cloud;
  cloud.positions = {{10, 0, 0}, {0, 10, 0}, {5, 5, 1}};
  return cloud;
}

PointCloud far_points() {
  PointCloud cloud = still_scan(1);
  for (Eigen::Vector3d& point : cloud.positions) point *= 1000;
  return cloud;
}

PointCloud points_that_are_not_finite() {
  PointCloud cloud;
  cloud.positions.assign(5000, Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  return cloud;
}

PointCloud points_on_one_spot() {
  PointCloud cloud;
  cloud.positions.assign(5000, Eigen::Vector3d(7, 1, 0));
  return cloud;
}

TEST(Odometry, AScanOfNoUseIsToldAndLeavesTheOthersAlone) {
  std::vector<PointCloud> scans;
  for (int i = 0; i < 6; ++i) scans.push_back(still_scan(i));
  for (const PointCloud& useless :
       {without_points(), few_points(), far_points(), points_that_are_not_finite(), points_on_one_spot()}) {
    Odometry odometry;
    for (int i = 0; i < 6; ++i) {
      if (i == 0 || i == 4) {
        const OdometryStep step = odometry.register_scan(useless);
        EXPECT_FALSE(step.registered());
        EXPECT_TRUE(step.first_from_scan.matrix().allFinite());
        EXPECT_FALSE(step.covariance);
      }
      if (i == 4) continue;  // the useless one stands in its place
      const OdometryStep step = odometry.register_scan(scans[static_cast<std::size_t>(i)]);
      ASSERT_TRUE(step.registered()) << i << ": " << step.reason;
      EXPECT_LT(error_of(step, i).translation, kTolerance) << i;
      EXPECT_FALSE(step.was_refound) << i;
    }
  }
}

TEST(Odometry, ReasonsNameCountsAndLimits) {
  EXPECT_EQ(Odometry().register_scan(without_points()).reason, "it holds no points");
  EXPECT_EQ(Odometry().register_scan(few_points()).reason,
            "only 3 of 3 points are left within 1 to 100 m and 1.5 m apart, 20 are needed");
}

TEST(Odometry, AScanAfterAGapIsFoundAgain) {
  Odometry odometry;
  for (int i = 0; i < 18; ++i) {
    if (i >= 8 && i < 14) continue;  // 4.8 m
    const OdometryStep step = odometry.register_scan(still_scan(i));
    ASSERT_TRUE(step.registered()) << i << ": " << step.reason;
    EXPECT_LT(error_of(step, i).translation, i < 14 ? kTolerance : 0.4) << i;  // a wrong place is metres off
    EXPECT_EQ(step.was_refound, i == 14) << i;
    if (i == 14) {
      EXPECT_GT(step.jump, 3);
    }
  }
}

TEST(Odometry, AScanOfAnotherPlaceIsRefused) {
  Odometry odometry;
  for (int i = 0; i < 5; ++i) odometry.register_scan(still_scan(i));
  const std::size_t num_points = odometry.map().num_points();
  const OdometryStep step = odometry.register_scan(
      test::scan_scene(test::room(), Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1.5)), scanner(99)));
  EXPECT_FALSE(step.registered()) << step.overlap_share;
  EXPECT_NE(step.reason.find("% of its points lie on those of the scans before"), std::string::npos) << step.reason;
  EXPECT_EQ(odometry.map().num_points(), num_points);
}

// Points anywhere, at the times of a turn.
PointCloud moving_garbage(int number, double reach) {
  PointCloud cloud;
  cloud.positions = test::random_points(4000, {Eigen::Vector3d::Constant(-reach), Eigen::Vector3d::Constant(reach)}, 7);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.times.push_back(kPeriod * (number + static_cast<double>(i) / static_cast<double>(cloud.size())));
  }
  return cloud;
}

TEST(Odometry, ABadSecondScanLeavesTheMapAndALaterOneStraightensTheFirst) {
  for (const PointCloud& bad : {moving_garbage(1, 40), moving_garbage(1, 80)}) {
    Odometry odometry;
    odometry.register_scan(moving_scan(0));
    const std::vector<Eigen::Vector3d> map = odometry.map().points();
    EXPECT_FALSE(odometry.register_scan(bad).registered());
    EXPECT_EQ(odometry.map().points(), map);
    for (int i = 2; i < 6; ++i) {
      const OdometryStep step = odometry.register_scan(moving_scan(i));
      ASSERT_TRUE(step.registered()) << i << ": " << step.reason;
      // In the frame of the first scan's first point: 0.4 m off where it is not straightened.
      EXPECT_LT(error_of(step, i).translation, kTolerance) << i;
      EXPECT_FALSE(step.was_refound) << i;
    }
  }
}

PointCloud with_times_that_begin_anew(PointCloud scan) {
  const double first = scan.times.front();
  for (double& time : scan.times) time -= first;
  return scan;
}

TEST(Odometry, TimesThatBeginAnewDeskewByTheTrueSpeedWhereScansAreLeftOut) {
  Odometry odometry;
  for (int i = 0; i < 16; i += 2) {
    const OdometryStep step = odometry.register_scan(with_times_that_begin_anew(moving_scan(i)));
    odometry.pass_over(1);
    ASSERT_TRUE(step.registered()) << i << ": " << step.reason;
    EXPECT_LT(error_of(step, i).translation, kTolerance) << i;
    if (i > 0) {
      EXPECT_NEAR(step.motion.twist.tail<3>().norm(), 8, 0.8) << i;  // 16 m/s by the clock of all scans
    }
  }
}

TEST(Odometry, TimesThatBeginAnewDeskewByTheTrueSpeedAfterAScanThatCannotBeRead) {
  Odometry odometry;
  for (int i = 0; i < 8; ++i) {
    if (i == 4) {
      odometry.pass_over(1);
      continue;
    }
    const OdometryStep step = odometry.register_scan(with_times_that_begin_anew(moving_scan(i)));
    ASSERT_TRUE(step.registered()) << i << ": " << step.reason;
    EXPECT_LT(error_of(step, i).translation, kTolerance) << i;
    if (i > 0) {
      EXPECT_NEAR(step.motion.twist.tail<3>().norm(), 8, 0.8) << i;
    }
  }
}

// As in rain: a share of the points is measured in the air before the surface.
PointCloud in_rain(PointCloud scan, double share) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(0, 1);
  for (Eigen::Vector3d& point : scan.positions) {
    if (any(random) < share) point *= 0.1 + 0.8 * any(random);
  }
  return scan;
}

TEST(Odometry, AShareThatDropsForGoodIsAcceptedAfterSomeScans) {
  Odometry odometry;
  double clear_share = 0;
  int num_lost = 0;
  for (int i = 0; i < 18; ++i) {
    const OdometryStep step = odometry.register_scan(i < 5 ? still_scan(i) : in_rain(still_scan(i), 0.37));
    if (i == 4) clear_share = step.overlap_share;
    if (i == 5) {
      ASSERT_FALSE(step.registered()) << step.overlap_share << " after " << clear_share;
    }
    if (i >= 5 && !step.registered()) ++num_lost;
    if (i < 14) continue;
    EXPECT_TRUE(step.registered()) << i << ": " << step.reason;
    EXPECT_LT(error_of(step, i).translation, 2 * kTolerance) << i;  // a third of the points is in the air
  }
  EXPECT_LT(num_lost, 10);
}

TEST(Odometry, ScansOfNothingThatIsThereAreRefusedHoweverManyTheyAre) {
  Odometry odometry;
  for (int i = 0; i < 5; ++i) odometry.register_scan(still_scan(i));
  for (int i = 5; i < 10; ++i) EXPECT_FALSE(odometry.register_scan(moving_garbage(i, 40)).registered()) << i;
}

TEST(Odometry, TimesOfNoUseAreToldAndTheScanIsTakenAsItIs) {
  Odometry odometry;
  for (int i = 0; i < 8; ++i) {
    PointCloud scan = moving_scan(i);
    if (i == 3) scan.times.assign(scan.size(), 5.0);
    if (i == 5) scan.times.front() = std::numeric_limits<double>::quiet_NaN();
    if (i == 6) {
      for (double& time : scan.times) time -= 100;
    }
    const OdometryStep step = odometry.register_scan(scan);
    ASSERT_TRUE(step.registered()) << i << ": " << step.reason;
    EXPECT_EQ(step.time_problem.empty(), i != 3 && i != 5 && i != 6) << i << ": " << step.time_problem;
    EXPECT_EQ(step.has_time, step.time_problem.empty());
    // A scan that is not deskewed lies half a turn's way ahead: 0.4 m.
    EXPECT_LT(error_of(step, i).translation, step.has_time ? 0.3 : 0.5) << i;
  }
}

TEST(Odometry, AMissingTurnIsBridgedByTheTimes) {
  Odometry odometry;
  for (int i = 0; i < 12; ++i) {
    if (i == 5 || i == 6 || i == 7) continue;
    const OdometryStep step = odometry.register_scan(moving_scan(i));
    ASSERT_TRUE(step.registered()) << i << ": " << step.reason;
    EXPECT_LT(error_of(step, i).translation, kTolerance) << i;
    if (i > 1) {
      EXPECT_LT(step.jump, 0.5) << i;  // predicted although four times as far away
    }
  }
}

TEST(Odometry, RefusesBadOptions) {
  OdometryOptions options;
  options.range = {5, 5};
  EXPECT_THROW(Odometry{options}, std::invalid_argument);
  options = {};
  options.voxel_size = 0;
  EXPECT_THROW(Odometry{options}, std::invalid_argument);
  options = {};
  options.registration_spacing = 0.1;
  EXPECT_THROW(Odometry{options}, std::invalid_argument);
  options = {};
  options.convergence = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Odometry{options}, std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap::registration

// SPDX-License-Identifier: GPL-3.0-or-later
// What refine_jointly() makes of odometry that slips between scans that the map knows.
#include "registration/fine/odometry_trust.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "tests/support/pose_distance.h"
#include "tests/support/random_points.h"

namespace vdbmap::registration {
namespace {

constexpr std::size_t kScans = 21;
constexpr double kMapTurn = 0.001;  // [rad] standard deviation
constexpr double kMapShift = 0.01;  // [m]
constexpr double kGood = 0.02;      // [m] what is asked of scans that the map determines

Matrix6d map_covariance() {
  Vector6d deviations;
  deviations << Eigen::Vector3d::Constant(kMapTurn), Eigen::Vector3d::Constant(kMapShift);
  return deviations.cwiseAbs2().asDiagonal();
}

Vector6d draw(double turn, double shift, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Vector6d motion;
  for (int i = 0; i < 6; ++i) motion[i] = (i < 3 ? turn : shift) * normal(random);
  return motion;
}

// A drive round a bend, a metre a scan, that the map and odometry know as well as they say.
struct BentDrive {
  std::vector<Eigen::Isometry3d> truth;
  std::vector<SequencePose> scans;

  explicit BentDrive(unsigned seed, double noise = 0) {
    std::mt19937 random(seed);
    const JointOptions options;
    const double turn = noise * options.odometry_rotation_deg * std::numbers::pi / 180;
    truth.push_back(test::random_motion(80, 70, random));
    for (std::size_t i = 0; i < kScans; ++i) {
      const Eigen::Isometry3d step = Eigen::Translation3d(1, 0, 0) * Eigen::AngleAxisd(0.04, Eigen::Vector3d::UnitZ());
      if (i > 0) truth.push_back(truth.back() * step);
      SequencePose scan;
      scan.in_map = PoseEstimate{moved_by(truth[i], noise * draw(kMapTurn, kMapShift, random)), map_covariance()};
      if (i > 0) scan.previous_from_scan = moved_by(step, draw(turn, noise * options.odometry_translation, random));
      scans.push_back(scan);
    }
    guess_by_odometry();
  }

  // As a batch is placed: all scans hang on the first.
  void guess_by_odometry() {
    scans[0].map_from_scan_guess = truth[0];
    for (std::size_t i = 1; i < kScans; ++i) {
      scans[i].map_from_scan_guess = scans[i - 1].map_from_scan_guess * *scans[i].previous_from_scan;
    }
  }

  void slip(std::size_t scan, const Eigen::Isometry3d& slip) {
    scans[scan].previous_from_scan = *scans[scan].previous_from_scan * slip;
    guess_by_odometry();
  }

  void leave_tunnel_unknown(std::size_t first, std::size_t last) {
    for (std::size_t i = first; i <= last; ++i) scans[i].in_map.reset();
  }

  double error(std::span<const PoseEstimate> poses, std::size_t i) const {
    return test::distance_between(poses[i].map_from_scan, truth[i]).translation;
  }

  double greatest_error(std::span<const PoseEstimate> poses) const {
    double greatest = 0;
    for (std::size_t i = 0; i < kScans; ++i) greatest = std::max(greatest, error(poses, i));
    return greatest;
  }
};

class SlipOf : public testing::TestWithParam<double> {};

TEST_P(SlipOf, OneStepMovesNoScanThatTheMapKnows) {
  std::mt19937 random(3);
  for (const std::size_t scan : {1UL, 2UL, 10UL, 19UL, 20UL}) {
    BentDrive drive(1);
    drive.slip(scan, test::random_motion(GetParam(), 0, random));
    EXPECT_LT(drive.greatest_error(refine_jointly(drive.scans)), kGood) << scan;
  }
}

// Not on both sides of one scan: that would look like a scan that went astray.
TEST_P(SlipOf, SeveralStepsMoveNoScanThatTheMapKnows) {
  std::mt19937 random(4);
  BentDrive drive(2);
  for (const std::size_t scan : {3UL, 9UL, 11UL, 16UL}) drive.slip(scan, test::random_motion(GetParam(), 1, random));
  EXPECT_LT(drive.greatest_error(refine_jointly(drive.scans)), kGood);
}

TEST_P(SlipOf, AStepMovesNoScanOfANoisyDriveFartherThanItsNoise) {
  std::mt19937 random(5);
  for (unsigned seed = 0; seed < 10; ++seed) {
    BentDrive drive(100 + seed, 1);
    const auto before = refine_jointly(drive.scans);
    drive.slip(10, test::random_motion(GetParam(), 0, random));
    const auto after = refine_jointly(drive.scans);
    for (std::size_t i = 0; i < kScans; ++i) {
      EXPECT_LT(test::distance_between(before[i].map_from_scan, after[i].map_from_scan).translation, kGood);
    }
  }
}

TEST_P(SlipOf, OneStepDoesNotBringBackAScanThatWentAstray) {
  std::mt19937 random(6);
  BentDrive drive(3);
  drive.slip(10, test::random_motion(GetParam(), 0, random));
  for (const std::size_t astray : {5UL, 15UL}) {
    drive.scans[astray].in_map->map_from_scan = drive.truth[astray] * test::random_motion(0.8, 0, random);
  }
  EXPECT_LT(drive.greatest_error(refine_jointly(drive.scans)), kGood);
}

// Nothing tells which step slipped, so that the scans between may be off, but they know it: within four deviations.
TEST_P(SlipOf, OneStepInATunnelIsAdmitted) {
  std::mt19937 random(7);
  BentDrive drive(4);
  drive.leave_tunnel_unknown(6, 14);
  drive.slip(9, test::random_motion(GetParam(), 0, random));
  const auto poses = refine_jointly(drive.scans);
  for (std::size_t i = 0; i < kScans; ++i) {
    const bool is_known = drive.scans[i].in_map.has_value();
    const double deviation = std::sqrt(poses[i].covariance.bottomRightCorner<3, 3>().trace());
    EXPECT_LT(drive.error(poses, i), is_known ? kGood : 4 * deviation) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Metres, SlipOf, testing::Values(0.2, 0.5, 1.0, 2.0, 5.0, 50.0));

TEST(OdometryTrust, ASlipOfRotationMovesNoScanThatTheMapKnows) {
  std::mt19937 random(8);
  for (const double degrees : {1.0, 5.0, 20.0, 120.0}) {
    BentDrive drive(5);
    drive.slip(10, test::random_motion(0, degrees, random));
    const auto poses = refine_jointly(drive.scans);
    EXPECT_LT(drive.greatest_error(poses), kGood);
    for (std::size_t i = 0; i < kScans; ++i) {
      EXPECT_LT(test::distance_between(poses[i].map_from_scan, drive.truth[i]).rotation_deg, 0.1) << degrees;
    }
  }
}

TEST(OdometryTrust, WhereNothingSlippedEveryStepCountsInFull) {
  BentDrive drive(6);
  drive.leave_tunnel_unknown(3, 17);
  const OdometryTrust trust = trust_odometry(drive.scans, {});
  for (std::size_t i = 0; i < kScans; ++i) {
    EXPECT_EQ(trust.weights[i].rotation, 1);
    EXPECT_EQ(trust.weights[i].translation, 1);
    EXPECT_LT(test::distance_between(trust.start[i], drive.truth[i]).translation, 1e-9);
  }
}

// A bridge between two known ends, without turning: variance (a b) / (a + b) of the two ways to a scan.
TEST(OdometryTrust, ATunnelIsBridgedAsFirmlyAsItsStepsAre) {
  JointOptions options;
  options.odometry_rotation_deg = 1e-6;
  BentDrive drive(7);
  drive.leave_tunnel_unknown(1, kScans - 2);
  const auto poses = refine_jointly(drive.scans, options);
  EXPECT_LT(drive.greatest_error(poses), 1e-6);
  const double step = options.odometry_translation * options.odometry_translation;
  for (std::size_t i = 1; i + 1 < kScans; ++i) {
    const double front = kMapShift * kMapShift + static_cast<double>(i) * step;
    const double back = kMapShift * kMapShift + static_cast<double>(kScans - 1 - i) * step;
    const double expected = front * back / (front + back);
    // The ends' own turns move the scans between a little more or less.
    EXPECT_NEAR(poses[i].covariance(5, 5), expected, 0.1 * expected) << i;
  }
}

// Slipped or not: the normalized errors of the scans, each of 6 degrees of freedom.
TEST(OdometryTrust, CovariancesStayHonest) {
  constexpr unsigned kDrives = 40;
  for (const double slip : {0.0, 0.2, 1.0, 5.0}) {
    double sum = 0;
    std::mt19937 random(9);
    for (unsigned seed = 0; seed < kDrives; ++seed) {
      BentDrive drive(1000 + seed, 1);
      if (slip > 0) drive.slip(10, test::random_motion(slip, 0, random));
      const auto poses = refine_jointly(drive.scans);
      for (const std::size_t i : {9UL, 10UL}) {
        Vector6d error;
        const Eigen::AngleAxisd turn(poses[i].map_from_scan.linear() * drive.truth[i].linear().transpose());
        error << turn.angle() * turn.axis(), poses[i].map_from_scan.translation() - drive.truth[i].translation();
        sum += error.dot(poses[i].covariance.ldlt().solve(error));
      }
    }
    // Neighbours share some errors: of 480 degrees of freedom half count. 1.96 deviations, and a tenth for the kernel.
    EXPECT_NEAR(sum / (2 * kDrives), 6, 6 * (1.96 * std::sqrt(2.0 / 240) + 0.1)) << slip;
  }
}

TEST(OdometryTrust, GuessesHaveNoInfluence) {
  std::mt19937 random(10);
  BentDrive drive(8, 1);
  drive.leave_tunnel_unknown(12, 15);
  drive.slip(5, test::random_motion(0.7, 2, random));
  const auto expected = refine_jointly(drive.scans);
  for (SequencePose& scan : drive.scans) scan.map_from_scan_guess = test::random_motion(100, 150, random);
  const auto poses = refine_jointly(drive.scans);
  for (std::size_t i = 0; i < kScans; ++i) {
    EXPECT_EQ(poses[i].map_from_scan.matrix(), expected[i].map_from_scan.matrix());
    EXPECT_EQ(poses[i].covariance, expected[i].covariance);
  }
}

TEST(OdometryTrust, DriveReadBackwardIsTheSame) {
  std::mt19937 random(11);
  BentDrive drive(9, 1);
  drive.leave_tunnel_unknown(12, 15);
  drive.slip(5, test::random_motion(0.7, 0, random));
  drive.scans[9].in_map->map_from_scan = drive.truth[9] * test::random_motion(0.8, 0, random);
  std::vector<SequencePose> back(drive.scans.rbegin(), drive.scans.rend());
  for (std::size_t i = kScans - 1; i > 0; --i) back[i].previous_from_scan = back[i - 1].previous_from_scan->inverse();
  back[0].previous_from_scan.reset();
  const auto forward = refine_jointly(drive.scans);
  const auto backward = refine_jointly(back);
  for (std::size_t i = 0; i < kScans; ++i) {
    // Errors of a step are weighed at its end, those of the step back at its begin: a turn's lever of a metre differs.
    EXPECT_LT(test::distance_between(forward[i].map_from_scan, backward[kScans - 1 - i].map_from_scan).translation,
              kGood);
  }
}

TEST(OdometryTrust, ADirectionThatTheMapDoesNotKnowIsNoSlip) {
  BentDrive drive(10);
  Matrix6d unknown = map_covariance();
  unknown(3, 3) = unknown(4, 4) = 100;
  for (const std::size_t i : {4UL, 5UL, 6UL, 12UL}) {
    drive.scans[i].in_map = PoseEstimate{Eigen::Translation3d(3, -2, 0) * drive.truth[i], unknown};
  }
  EXPECT_LT(drive.greatest_error(refine_jointly(drive.scans)), kGood);
}

}  // namespace
}  // namespace vdbmap::registration

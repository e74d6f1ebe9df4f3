// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/batch_agreement.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"

namespace vdbmap::registration {
namespace {

constexpr double kRadian = std::numbers::pi / 180;
constexpr std::size_t kScansInBatch = 20;  // a metre apart

// Batches along a drive whose odometry turns and stretches evenly.
struct DriftingDrive {
  std::vector<PathPose> path;
  std::vector<BatchPlace> batches;

  explicit DriftingDrive(std::size_t num_batches, double drift_deg_per_metre = 0, double stretch = 1) {
    Eigen::Isometry3d truth = Eigen::Isometry3d::Identity();
    Eigen::Isometry3d odometry(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
    for (std::size_t i = 0; i < num_batches * kScansInBatch; ++i) {
      if (i % kScansInBatch == 0) batches.push_back({i, truth});
      path.push_back({odometry, i > 0});
      const double turn = 0.02 * std::sin(0.01 * static_cast<double>(i));  // the road bends
      const Eigen::Translation3d ahead(1, 0, 0);
      truth = truth * ahead * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ());
      odometry = odometry * Eigen::Translation3d(stretch, 0, 0) *
                 Eigen::AngleAxisd(turn + drift_deg_per_metre * kRadian, Eigen::Vector3d::UnitZ());
    }
  }

  void displace(std::size_t batch, double distance, double angle_deg, std::mt19937& random) {
    batches[batch].map_from_batch = batches[batch].map_from_batch * test::random_motion(distance, angle_deg, random);
  }

  std::vector<bool> believed() const { return believed_batches(batches, path); }
};

class AgreementOfAHundredBatches : public testing::TestWithParam<double> {};

// 2 km, over which odometry turns away by up to 100 degrees and comes out 40 m too long.
TEST_P(AgreementOfAHundredBatches, KeepsTheTrueOnesAndNoneOfTheFalse) {
  DriftingDrive drive(100, GetParam(), 1.02);
  std::mt19937 random(5);
  std::vector<bool> is_true(100, true);
  for (std::size_t i = 0; i < 100; i += 4 + random() % 5) is_true[i] = false;
  is_true[99] = is_true[50] = is_true[51] = false;
  for (std::size_t i = 0; i < 100; ++i) {
    if (!is_true[i]) drive.displace(i, 5 + static_cast<double>(random() % 300), 30, random);
  }
  EXPECT_EQ(drive.believed(), is_true);
}

INSTANTIATE_TEST_SUITE_P(DegreesPerMetre, AgreementOfAHundredBatches, testing::Values(0.0, 0.01, 0.02, 0.05));

TEST(BatchAgreement, TurnedBatchesAreAsFalseAsMovedOnes) {
  DriftingDrive drive(9, 0.02);
  std::mt19937 random(6);
  drive.displace(3, 0.1, 15, random);
  drive.displace(8, 4, 0.1, random);
  std::vector<bool> expected(9, true);
  expected[3] = expected[8] = false;
  EXPECT_EQ(drive.believed(), expected);
}

// As where a street repeats: the false ones agree with each other.
TEST(BatchAgreement, ARunOfBatchesThatAreWrongAlikeIsOutvoted) {
  for (const std::size_t first : {0U, 5U, 15U}) {
    DriftingDrive drive(20, 0.02);
    std::vector<bool> expected(20, true);
    for (std::size_t i = first; i < first + 5; ++i) {
      drive.batches[i].map_from_batch = Eigen::Translation3d(12, 3, 0) * drive.batches[i].map_from_batch;
      expected[i] = false;
    }
    EXPECT_EQ(drive.believed(), expected) << first;
  }
}

TEST(BatchAgreement, OfTwoThatContradictEachOtherNeitherIsBelieved) {
  DriftingDrive drive(2);
  EXPECT_EQ(drive.believed(), std::vector<bool>({true, true}));
  std::mt19937 random(7);
  drive.displace(1, 10, 1, random);
  EXPECT_EQ(drive.believed(), std::vector<bool>({false, false}));
}

TEST(BatchAgreement, HalvesThatContradictEachOtherAreNotBelieved) {
  DriftingDrive drive(4);
  for (const std::size_t i : {2U, 3U}) {
    drive.batches[i].map_from_batch = Eigen::Translation3d(0, 0, 15) * drive.batches[i].map_from_batch;
  }
  EXPECT_EQ(drive.believed(), std::vector<bool>(4, false));
}

TEST(BatchAgreement, ASlipOfOdometryCostsNoBatchFarFromIt) {
  DriftingDrive drive(100);
  for (std::size_t i = 50 * kScansInBatch; i < drive.path.size(); ++i) {
    drive.path[i].odometry_from_scan = Eigen::Translation3d(0, 5, 0) * drive.path[i].odometry_from_scan;
  }
  const std::vector<bool> believed = drive.believed();
  for (std::size_t i = 0; i < 100; ++i) {
    const double way = 20 * std::abs(static_cast<double>(i) - 49.5);  // [m] allowed for 5 m: after some 60 m
    EXPECT_TRUE(believed[i] || way < 100) << i;
  }
}

// Odometry that is lost for a while makes nothing far from there doubtful.
TEST(BatchAgreement, AGreatSlipInALongDriveIsNoReasonToDoubtAllOfIt) {
  DriftingDrive drive(100);
  for (std::size_t i = 50 * kScansInBatch; i < drive.path.size(); ++i) {
    drive.path[i].odometry_from_scan = Eigen::Translation3d(0, 2000, 0) * drive.path[i].odometry_from_scan;
  }
  const std::vector<bool> believed = drive.believed();
  for (std::size_t i = 0; i < 100; ++i) EXPECT_TRUE(believed[i] || (i > 33 && i < 66)) << i;
}

TEST(BatchAgreement, PartsBetweenGapsStandForThemselves) {
  DriftingDrive drive(7);
  const auto move = [&](std::size_t i) {
    drive.batches[i].map_from_batch = Eigen::Translation3d(70, 0, 0) * drive.batches[i].map_from_batch;
  };
  drive.path[3 * kScansInBatch].follows = false;
  drive.path[6 * kScansInBatch].follows = false;
  for (const std::size_t i : {3U, 4U, 5U}) move(i);
  move(1);
  EXPECT_EQ(drive.believed(), std::vector<bool>({true, false, true, true, true, true, true}));
}

TEST(BatchAgreement, OfNothingIsNothing) { EXPECT_TRUE(believed_batches({}, {}).empty()); }

// Twice the batches, twice the time: 4000 of them would take 160 million steps of odometry if all pairs were compared.
TEST(BatchAgreement, ManyBatchesAreNoTrouble) {
  DriftingDrive drive(4000, 0.05, 1.01);
  std::vector<bool> expected(4000, true);
  for (std::size_t i = 7; i < 4000; i += 10) {
    drive.batches[i].map_from_batch = Eigen::Translation3d(0, 20, 0) * drive.batches[i].map_from_batch;
    expected[i] = false;
  }
  EXPECT_EQ(drive.believed(), expected);
}

// Odometry that turns evenly goes round an arc of radius 1 / k: closed form of how far that leads from the straight
// way.
TEST(BatchAgreement, AllowanceCoversTheArcOfAnEvenTurn) {
  const DriftModel drift{.translation = 0, .turn_deg = 0, .translation_per_metre = 0, .turn_deg_per_metre = 0.05};
  for (const double way : {1.0, 100.0, 600.0}) {
    const double curvature = 0.05 * kRadian;
    const double angle = curvature * way;
    const Eigen::Vector2d end(std::sin(angle) / curvature, (1 - std::cos(angle)) / curvature);
    const DriftAllowance allowed = allowance_after(way, drift);
    EXPECT_NEAR(allowed.turn, angle, 1e-12);
    EXPECT_GE(allowed.translation, (end - Eigen::Vector2d(way, 0)).norm());
    EXPECT_LE(allowed.translation, 1.05 * (end - Eigen::Vector2d(way, 0)).norm() + 1e-6);  // chord for arc
  }
}

TEST(BatchAgreement, AllowanceGrowsWithTheWay) {
  DriftAllowance last{0, 0};
  for (double way = 0; way < 500; way += 50) {
    const DriftAllowance allowed = allowance_after(way, {});
    EXPECT_GT(allowed.translation, last.translation);
    EXPECT_GT(allowed.turn, last.turn);
    last = allowed;
  }
}

TEST(BatchAgreement, RefusesDriftThatIsNone) {
  DriftModel drift;
  drift.turn_deg_per_metre = -1;
  EXPECT_THROW(believed_batches({}, {}, drift), std::invalid_argument);
  drift.turn_deg_per_metre = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(believed_batches({}, {}, drift), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap::registration

// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/trajectory_error.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

namespace vdbmap::registration {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;

Eigen::Isometry3d pose_at(const Eigen::Vector3d& position, double angle_deg = 0,
                          const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ()) {
  return Eigen::Translation3d(position) * Eigen::AngleAxisd(angle_deg * kRadPerDeg, axis);
}

Trajectory trajectory_of(std::vector<std::optional<Eigen::Isometry3d>> map_from_scan) {
  return {.map_from_scan = std::move(map_from_scan), .times = {}};
}

// True poses at the origin; estimates off by 1, 2, ... along x.
TrajectoryError error_of_shifts(const std::vector<double>& shifts) {
  Trajectory estimate;
  Trajectory truth;
  for (const double shift : shifts) {
    estimate.map_from_scan.emplace_back(pose_at({shift, 0, 0}));
    truth.map_from_scan.emplace_back(pose_at({0, 0, 0}));
  }
  return evaluate_trajectory(estimate, truth);
}

TEST(TrajectoryError, SplitsAShiftIntoPlaneAndHeight) {
  const TrajectoryError error =
      evaluate_trajectory(trajectory_of({pose_at({3, 4, -12}, 30)}), trajectory_of({pose_at({0, 0, 0}, 30)}));

  ASSERT_TRUE(error.poses[0].has_value());
  EXPECT_DOUBLE_EQ(error.poses[0]->xy, 5);
  EXPECT_DOUBLE_EQ(error.poses[0]->z, -12);
  EXPECT_DOUBLE_EQ(error.poses[0]->translation, 13);
  EXPECT_NEAR(error.poses[0]->rotation_deg, 0, 1e-12);
  EXPECT_DOUBLE_EQ(error.z.max, 12);
}

TEST(TrajectoryError, RotationIsTheAngleBetweenThePoses) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 3).normalized();
  for (const double angle_deg : {1e-9, 0.5, 90.0, 179.9, 180.0}) {
    const Eigen::Isometry3d truth = pose_at({550000, 5800000, 50}, 77, Eigen::Vector3d::UnitY());
    const Eigen::Isometry3d estimate = truth * pose_at({0, 0, 0}, angle_deg, axis);
    const TrajectoryError error = evaluate_trajectory(trajectory_of({estimate}), trajectory_of({truth}));
    // Quaternions carry about 1e-16 rad, and a whole turn of them 1e-14 degrees.
    EXPECT_NEAR(error.poses[0]->rotation_deg, angle_deg, 1e-12);
  }
}

TEST(TrajectoryError, RotationTakesTheShortWay) {
  const TrajectoryError error =
      evaluate_trajectory(trajectory_of({pose_at({0, 0, 0}, 179)}), trajectory_of({pose_at({0, 0, 0}, -179)}));
  EXPECT_NEAR(error.poses[0]->rotation_deg, 2, 1e-12);
}

TEST(TrajectoryError, SummarizesByMedianMeanRmsAndMaximum) {
  const TrajectoryError odd = error_of_shifts({4, 1, 10});
  EXPECT_DOUBLE_EQ(odd.xy.median, 4);
  EXPECT_DOUBLE_EQ(odd.xy.mean, 5);
  EXPECT_DOUBLE_EQ(odd.xy.rms, std::sqrt(117.0 / 3));
  EXPECT_DOUBLE_EQ(odd.xy.max, 10);

  const TrajectoryError even = error_of_shifts({4, 1, 10, 2});
  EXPECT_DOUBLE_EQ(even.translation.median, 3);
}

TEST(TrajectoryError, MissingPosesAreFailures) {
  const Trajectory truth = trajectory_of({pose_at({0, 0, 0}), pose_at({0, 0, 0}), pose_at({0, 0, 0})});
  const Trajectory estimate = trajectory_of({pose_at({0.05, 0, 0}), std::nullopt, pose_at({0, 0, 1})});
  const TrajectoryError error = evaluate_trajectory(estimate, truth);

  EXPECT_EQ(error.num_judged, 3U);
  EXPECT_EQ(error.num_missing, 1U);
  EXPECT_FALSE(error.poses[1].has_value());
  EXPECT_DOUBLE_EQ(success_rate(error, kFineSuccess), 1.0 / 3);
  EXPECT_DOUBLE_EQ(success_rate(error, kCoarseSuccess), 2.0 / 3);
  EXPECT_DOUBLE_EQ(error.xy.mean, 0.025);
}

TEST(TrajectoryError, ScansWithoutATruePoseAreNotJudged) {
  const TrajectoryError error = evaluate_trajectory(trajectory_of({pose_at({0, 0, 0}), std::nullopt, std::nullopt}),
                                                    trajectory_of({pose_at({0, 0, 0}), std::nullopt, std::nullopt}));
  EXPECT_EQ(error.num_judged, 1U);
  EXPECT_EQ(error.num_missing, 0U);
  EXPECT_DOUBLE_EQ(success_rate(error, kFineSuccess), 1);
}

TEST(TrajectoryError, SuccessNeedsPlaceAndRotation) {
  const TrajectoryError error =
      evaluate_trajectory(trajectory_of({pose_at({0, 0, 0}, 0.6), pose_at({0.2, 0, 0}, 0), pose_at({0.05, 0, 0}, 0.4)}),
                          trajectory_of({pose_at({0, 0, 0}), pose_at({0, 0, 0}), pose_at({0, 0, 0})}));
  EXPECT_DOUBLE_EQ(success_rate(error, kFineSuccess), 1.0 / 3);
  EXPECT_DOUBLE_EQ(success_rate(error, {0.1, 1}), 2.0 / 3);
  EXPECT_DOUBLE_EQ(success_rate(error, kCoarseSuccess), 1);
}

TEST(TrajectoryError, NothingToSummarizeIsNotANumber) {
  const TrajectoryError error = evaluate_trajectory(trajectory_of({std::nullopt}), trajectory_of({pose_at({0, 0, 0})}));
  EXPECT_TRUE(std::isnan(error.xy.median));
  EXPECT_TRUE(std::isnan(error.rotation_deg.max));
  EXPECT_DOUBLE_EQ(success_rate(error, kCoarseSuccess), 0);
  EXPECT_DOUBLE_EQ(success_rate(evaluate_trajectory({}, {}), kCoarseSuccess), 0);
}

TEST(TrajectoryError, LengthsMustAgree) {
  EXPECT_THROW(evaluate_trajectory(trajectory_of({std::nullopt}), {}), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap::registration

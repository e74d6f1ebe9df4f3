// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/adaptive_threshold.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace vdbmap::registration {
namespace {

Eigen::Isometry3d motion(double metres, double angle) {
  Eigen::Isometry3d motion(Eigen::AngleAxisd(angle, Eigen::Vector3d(1, -2, 2).normalized()));
  motion.translation() = metres * Eigen::Vector3d(2, -1, 2).normalized();
  return motion;
}

TEST(AdaptiveThreshold, ADeviationIsTheChordAtTheRangePlusTheTranslation) {
  EXPECT_NEAR(deviation_at_range(motion(0.25, 0.02), 100), 2 * 100 * std::sin(0.01) + 0.25, 1e-12);
  EXPECT_NEAR(deviation_at_range(motion(0, M_PI), 50), 100, 1e-9);
  EXPECT_EQ(deviation_at_range(Eigen::Isometry3d::Identity(), 100), 0);
}

TEST(AdaptiveThreshold, IsTheInitialOneUntilADeviationCounts) {
  AdaptiveThreshold threshold(2, 0.1, 100);
  EXPECT_EQ(threshold.sigma(), 2);
  threshold.add_deviation(motion(0.099, 0));
  threshold.add_deviation(motion(0, 0.0009));
  EXPECT_EQ(threshold.sigma(), 2);
}

TEST(AdaptiveThreshold, IsTheRootMeanSquareOfTheDeviationsThatCount) {
  AdaptiveThreshold threshold(2, 0.1, 100);
  for (const double deviation : {0.3, 0.05, 0.7, 0.0, 0.2}) threshold.add_deviation(motion(deviation, 0));
  EXPECT_NEAR(threshold.sigma(), std::sqrt((0.09 + 0.49 + 0.04) / 3), 1e-12);
}

TEST(AdaptiveThreshold, ADeviationThatIsNotFiniteDoesNotCount) {
  AdaptiveThreshold threshold(2, 0.1, 100);
  threshold.add_deviation(motion(std::numeric_limits<double>::quiet_NaN(), 0));
  EXPECT_EQ(threshold.sigma(), 2);
}

TEST(AdaptiveThreshold, RefusesLengthsThatAreNotPositive) {
  EXPECT_THROW(AdaptiveThreshold(0, 0.1, 100), std::invalid_argument);
  EXPECT_THROW(AdaptiveThreshold(2, -0.1, 100), std::invalid_argument);
  EXPECT_THROW(AdaptiveThreshold(2, 0.1, std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap::registration

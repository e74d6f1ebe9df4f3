// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/mapper_error.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tools/simulator/survey_frame.h"

namespace vdbmap::simulator {
namespace {

TEST(MapperError, DriftsByTwoToFiveCentimetresOverAHundredMetres) {
  const Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const MapperError error = make_mapper_error(seed);
    double largest = 0, roughest = 0;
    for (double s = 0; s < 400; ++s) {
      const Eigen::Vector3d here = error.estimated(start, s).translation();
      largest = std::max(largest, (error.estimated(start, s + 100).translation() - here).norm());
      roughest = std::max(roughest, (error.estimated(start, s + 1).translation() - here).norm());
    }
    EXPECT_GT(largest, 0.02) << seed;
    EXPECT_LT(largest, 0.09) << seed;     // of three axes together
    EXPECT_LT(roughest, 0.0035) << seed;  // smooth
  }
}

TEST(MapperError, PutsACentimetreBetweenTheScanners) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const MapperError error = make_mapper_error(seed);
    const Eigen::Isometry3d a = error.estimated_mounting(Eigen::Isometry3d::Identity(), 0);
    const Eigen::Isometry3d b = error.estimated_mounting(Eigen::Isometry3d::Identity(), 1);
    EXPECT_GT((a.translation() - b.translation()).norm(), 0.003) << seed;
    EXPECT_LT((a.translation() - b.translation()).norm(), 0.0125) << seed;
    EXPECT_LT(Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle(), 0.0015) << seed;
  }
}

TEST(MapperError, NoneIsNone) {
  const MapperError none;
  const Eigen::Isometry3d pose(Eigen::Translation3d(3, 4, 5));
  EXPECT_EQ(none.estimated(pose, 50).matrix(), pose.matrix());
  EXPECT_EQ(none.estimated_mounting(pose, 1).matrix(), pose.matrix());
}

std::vector<Eigen::Vector3d> cloud() {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 2000; ++i)
    points.emplace_back(30 * std::sin(1.7 * i), 20 * std::cos(2.9 * i), 4 * std::sin(0.3 * i));
  return points;
}

// Rotated by 2 mrad within cells of 2 m, a point is a few millimetres from its cell's mean.
TEST(SurveyFrame, FindsTheMotionOfThePassThatSawMost) {
  Eigen::Isometry3d first(Eigen::Translation3d(0.03, -0.02, 0.01));
  first.rotate(Eigen::AngleAxisd(0.001, Eigen::Vector3d::UnitZ()));
  const Eigen::Isometry3d second(Eigen::Translation3d(-0.05, 0.05, 0));
  SurveyFrame frame;
  const auto points = cloud();
  for (const Eigen::Vector3d& p : points) frame.add(p, first * p, 10);
  for (std::size_t i = 0; i < points.size() / 4; ++i) frame.add(points[i], second * points[i], 100);
  const auto found = frame.survey_from_scene(points);
  ASSERT_TRUE(found);
  EXPECT_LT((found->translation() - first.translation()).norm(), 0.001);
  EXPECT_LT(Eigen::AngleAxisd(found->linear().transpose() * first.linear()).angle(), 1e-4);
}

TEST(SurveyFrame, KnowsNothingOfWhatNoPassSaw) {
  SurveyFrame frame;
  frame.add({0, 0, 0}, {0, 0, 0}, 1);
  EXPECT_FALSE(frame.survey_from_scene(cloud()));
  EXPECT_FALSE(SurveyFrame().survey_from_scene({}));
}

}  // namespace
}  // namespace vdbmap::simulator

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/plan_rectangle.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace vdbmap {
namespace {

TEST(PlanRectangle, IsThatOfPointsInATurnedRectangle) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(-0.5, 0.5);
  for (const double yaw : {0.0, 0.3, 1.2, 2.0, 3.1}) {
    const Eigen::Rotation2Dd turn(yaw);
    std::vector<Eigen::Vector2d> points;
    for (const double x : {-2.25, 2.25}) {
      for (const double y : {-0.9, 0.9}) points.emplace_back(turn * Eigen::Vector2d(x, y));
    }
    for (int i = 0; i < 500; ++i) points.emplace_back(turn * Eigen::Vector2d(4.5 * share(random), 1.8 * share(random)));
    for (Eigen::Vector2d& point : points) point += Eigen::Vector2d(100, -50);
    std::shuffle(points.begin(), points.end(), random);

    const PlanRectangle rectangle = smallest_rectangle(points);
    EXPECT_NEAR(rectangle.length, 4.5, 1e-9);
    EXPECT_NEAR(rectangle.width, 1.8, 1e-9);
    EXPECT_NEAR(std::remainder(rectangle.yaw - yaw, std::numbers::pi), 0, 1e-9);
    EXPECT_TRUE(rectangle.center.isApprox(Eigen::Vector2d(100, -50), 1e-9));
  }
}

TEST(PlanRectangle, HasNoSmallerOneAtAnyAngle) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> coordinate(-3, 3);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i < 12; ++i) points.emplace_back(coordinate(random), coordinate(random));
    const PlanRectangle rectangle = smallest_rectangle(points);
    for (int step = 0; step < 1800; ++step) {
      const Eigen::Vector2d along(std::cos(step * std::numbers::pi / 1800), std::sin(step * std::numbers::pi / 1800));
      const Eigen::Vector2d across(-along.y(), along.x());
      const auto extent = [&](const Eigen::Vector2d& direction) {
        const auto [low, high] = std::ranges::minmax(points, {}, [&](const auto& p) { return p.dot(direction); });
        return (high - low).dot(direction);
      };
      EXPECT_LE(rectangle.length * rectangle.width, extent(along) * extent(across) + 1e-9);
    }
    // Its corners run against the clock and enclose the points.
    const auto corners = rectangle.corners();
    for (std::size_t i = 0; i < 4; ++i) {
      const Eigen::Vector2d side = corners[(i + 1) % 4] - corners[i];
      for (const Eigen::Vector2d& point : points) {
        const Eigen::Vector2d to = point - corners[i];
        EXPECT_GE(side.x() * to.y() - side.y() * to.x(), -1e-9);
      }
    }
  }
}

TEST(PlanRectangle, OfOnePlaceAndOfALineHasNoWidth) {
  const std::vector<Eigen::Vector2d> place(3, Eigen::Vector2d(2, 5));
  EXPECT_EQ(smallest_rectangle(place).length, 0);
  EXPECT_EQ(smallest_rectangle(place).center, Eigen::Vector2d(2, 5));
  const std::vector<Eigen::Vector2d> line = {{0, 0}, {1, 1}, {3, 3}};
  EXPECT_NEAR(smallest_rectangle(line).length, 3 * std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(smallest_rectangle(line).width, 0, 1e-12);
  EXPECT_THROW(smallest_rectangle({}), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap

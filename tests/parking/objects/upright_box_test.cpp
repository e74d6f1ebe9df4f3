// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/objects/upright_box.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"

namespace vdbmap::parking {
namespace {

using std::numbers::pi;

UprightBox box_at(double x, double y, double length, double width, double heading) {
  UprightBox box;
  box.center = {x, y, 0.7};
  box.length = length;
  box.width = width;
  box.height = 1.4;
  box.heading = heading;
  return box;
}

// Points in a box, its corners among them.
std::vector<Eigen::Vector3d> points_in(const UprightBox& box, unsigned seed) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector2d& corner : box.corners()) {
    points.emplace_back(corner.x(), corner.y(), 0.0);
    points.emplace_back(corner.x(), corner.y(), 1.4);
  }
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(-0.5, 0.5);
  for (int i = 0; i < 200; ++i) {
    const double along = box.length * share(random), across = box.width * share(random);
    const Eigen::Vector2d place = box.center.head<2>() + along * box.along() + across * box.across();
    points.emplace_back(place.x(), place.y(), 0.7);
  }
  return points;
}

TEST(SmallestBox, IsTheOneThatPointsWereMadeIn) {
  for (const double heading : {0.0, 0.3, 1.2, pi / 2, 2.0, 3.1}) {
    const UprightBox made = box_at(1000, -2000, 4.5, 1.8, heading);
    const UprightBox found = smallest_box(points_in(made, 1));
    EXPECT_LT((found.center - made.center).norm(), 1e-6);
    EXPECT_NEAR(found.length, 4.5, 1e-6);
    EXPECT_NEAR(found.width, 1.8, 1e-6);
    EXPECT_NEAR(found.height, 1.4, 1e-9);
    EXPECT_NEAR(std::remainder(found.heading - heading, pi), 0, 1e-6);
  }
}

TEST(SmallestBox, IsNoLargerThanThoseOfAThousandHeadings) {
  for (unsigned seed = 1; seed < 8; ++seed) {
    const auto points = test::random_points(40, {Eigen::Vector3d(-3, -1, 0), Eigen::Vector3d(2, 4, 1)}, seed);
    const UprightBox found = smallest_box(points);
    for (const Eigen::Vector3d& point : points) {
      UprightBox wider = found;
      wider.length += 1e-9;
      wider.width += 1e-9;
      EXPECT_TRUE(wider.contains(point.head<2>()));
    }
    for (int i = 0; i < 1000; ++i) {
      const UprightBox other = box_of_heading(points, pi * i / 1000);
      EXPECT_LE(found.length * found.width, other.length * other.width + 1e-9);
    }
  }
}

TEST(SmallestBox, DoesNotDependOnTheOrderOfPoints) {
  auto points = test::random_points(60, {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(4, 2, 1)}, 3);
  const UprightBox found = smallest_box(points);
  std::ranges::reverse(points);
  const UprightBox again = smallest_box(points);
  EXPECT_EQ(found.center, again.center);
  EXPECT_EQ(found.heading, again.heading);
}

TEST(SmallestBox, OfOnePlaceOrALineIsFlat) {
  EXPECT_EQ(smallest_box(std::vector<Eigen::Vector3d>{{1, 2, 3}}).length, 0);
  const UprightBox line = smallest_box(std::vector<Eigen::Vector3d>{{0, 0, 0}, {3, 4, 1}, {1.5, 2, 0}});
  EXPECT_NEAR(line.length, 5, 1e-9);
  EXPECT_NEAR(line.width, 0, 1e-9);
  EXPECT_THROW(smallest_box({}), std::invalid_argument);
}

TEST(OverlapInPlan, IsThatOfClosedForms) {
  const UprightBox box = box_at(0, 0, 4, 2, 0.4);
  EXPECT_NEAR(overlap_in_plan(box, box), 1, 1e-12);
  EXPECT_NEAR(overlap_in_plan(box, box_at(10, 0, 4, 2, 0)), 0, 1e-12);
  const Eigen::Vector2d half = 2 * box.along();  // half of its length further
  EXPECT_NEAR(overlap_in_plan(box, box_at(half.x(), half.y(), 4, 2, 0.4)), 4.0 / 12, 1e-9);
  // A cross of two boxes 4 x 2: the square in the middle has 4 of 12 square metres.
  EXPECT_NEAR(overlap_in_plan(box, box_at(0, 0, 4, 2, 0.4 + pi / 2)), 4.0 / 12, 1e-9);
  // A square of 2 and the same turned by 45 degrees have a regular octagon in common.
  const double octagon = 8 * (std::sqrt(2.0) - 1);
  EXPECT_NEAR(overlap_in_plan(box_at(0, 0, 2, 2, 0), box_at(0, 0, 2, 2, pi / 4)), octagon / (8 - octagon), 1e-9);
}

}  // namespace
}  // namespace vdbmap::parking

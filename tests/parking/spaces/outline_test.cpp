// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/spaces/outline.h"

#include <cmath>

#include <gtest/gtest.h>

#include "parking/spaces/parking_space.h"

namespace vdbmap::parking {
namespace {

using Outline = std::vector<Eigen::Vector2d>;

const Outline kL = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {0, 3}};

TEST(Outline, AreaIsThatOfItsParts) {
  EXPECT_DOUBLE_EQ(signed_area(kL), 6);
  EXPECT_DOUBLE_EQ(signed_area(Outline(kL.rbegin(), kL.rend())), -6);
}

TEST(Outline, ContainsWhatLiesInOneOfItsParts) {
  for (double x = -0.5; x < 5; x += 0.25) {
    for (double y = -0.5; y < 4; y += 0.25) {
      const Eigen::Vector2d place(x + 0.01, y + 0.01);
      const auto is_in = [&](double high_x, double high_y) {
        return place.x() > 0 && place.y() > 0 && place.x() < high_x && place.y() < high_y;
      };
      EXPECT_EQ(contains(kL, place), is_in(4, 1) || is_in(1, 3)) << place.transpose();
    }
  }
}

TEST(Outline, SaysWhatIsWrongWithIt) {
  EXPECT_EQ(problem_of_outline(kL), "");
  EXPECT_EQ(problem_of_outline(Outline{{0, 0}, {4, 2}, {4, 0}, {0, 2}}), "crosses itself");
  EXPECT_EQ(problem_of_outline(Outline{{0, 0}, {4, 0}, {2, 0}, {2, 2}, {0, 2}}), "crosses itself");
  EXPECT_EQ(problem_of_outline(Outline{{0, 0}, {4, 0}}), "has 2 different corners, expected 3 or more");
  EXPECT_EQ(problem_of_outline(Outline{{0, 0}, {4, 0}, {4, 0.1}}), "has an area below 1 m^2");
  EXPECT_EQ(problem_of_outline(Outline{{0, 0}, {4, 0}, {NAN, 3}}), "has a corner that is not finite");
}

TEST(Outline, HullLeavesOutWhatLiesInside) {
  EXPECT_EQ(convex_hull({{0, 0}, {2, 1}, {4, 0}, {4, 3}, {1, 1}, {0, 3}, {2, 0}}),
            (Outline{{0, 0}, {4, 0}, {4, 3}, {0, 3}}));
}

TEST(ParkingSpace, HasTheSizeOfTheSmallestRectangle) {
  const double turn = 0.5;
  Outline outline;
  for (const Eigen::Vector2d& corner : Outline{{0, 0}, {5, 0}, {5, 2}, {0, 2}}) {
    outline.emplace_back(corner.x() * std::cos(turn) - corner.y() * std::sin(turn),
                         corner.x() * std::sin(turn) + corner.y() * std::cos(turn));
  }
  const ParkingSpace space = space_of_outline(outline);
  EXPECT_NEAR(space.length, 5, 1e-9);
  EXPECT_NEAR(space.width, 2, 1e-9);
  EXPECT_NEAR(space.heading, turn, 1e-9);
}

TEST(ParkingSpace, SharesAreaWithAnother) {
  const auto box = [](double x, double length) {
    return box_of(space_of_outline({{x, 0}, {x + length, 0}, {x + length, 2}, {x, 2}}));
  };
  EXPECT_NEAR(shared_area(box(0, 5), box(4, 5)), 0.2, 1e-9);
  EXPECT_NEAR(shared_area(box(0, 5), box(1, 2.5)), 1, 1e-9);
  EXPECT_EQ(shared_area(box(0, 5), box(5.5, 5)), 0);
}

}  // namespace
}  // namespace vdbmap::parking

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/quarter.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "tools/simulator/drive.h"

namespace vdbmap::simulator {
namespace {

StreetOptions options(int columns, int rows, std::uint64_t seed = 1) {
  StreetOptions result;
  result.seed = seed;
  result.quarter_columns = columns;
  result.quarter_rows = rows;
  return result;
}

TEST(Quarter, HasOneMoreStreetThanBlocksEachWayAndACrossingOfEachTwo) {
  const Quarter quarter = make_quarter(options(3, 2));
  EXPECT_EQ(quarter.layouts.size(), 7U);
  EXPECT_EQ(quarter.crossings.size(), 12U);
  EXPECT_EQ(quarter.blocks.size(), 20U);  // and the outskirts
}

TEST(Quarter, StreetsOfOneCrossingMeetInOnePointAndOnOneHeight) {
  const Quarter quarter = make_quarter(options(3, 2));
  for (const Crossing& crossing : quarter.crossings) {
    const StreetLayout& row = quarter.layouts[crossing.row_street];
    const StreetLayout& column = quarter.layouts[crossing.column_street];
    EXPECT_LT((row.axis.point(crossing.row_station, 0) - column.axis.point(crossing.column_station, 0)).norm(), 1e-6);
    for (const double dx : {-3.0, 0.0, 2.5}) {
      for (const double dy : {-2.0, 0.0, 3.5}) {
        // Left of a row is along a column; left of a column is against a row.
        EXPECT_NEAR(row.ground_height(crossing.row_station + dx, dy),
                    column.ground_height(crossing.column_station + dy, -dx), 1e-6);
      }
    }
  }
}

TEST(Quarter, LotsFollowEachOtherAndLeaveCrossingsFree) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Quarter quarter = make_quarter(options(2, 2, seed));
    for (const StreetLayout& street : quarter.layouts) {
      for (const SideLayout& side : street.sides) {
        EXPECT_EQ(side.stretches(LotKind::kCrossing).size(), 3U);
        EXPECT_NEAR(side.lots.front().along.begin, street.begin(), 1e-9);
        EXPECT_NEAR(side.lots.back().along.end, street.end(), 1e-9);
        for (std::size_t i = 1; i < side.lots.size(); ++i) {
          EXPECT_NEAR(side.lots[i - 1].along.end, side.lots[i].along.begin, 0.02);
        }
      }
    }
  }
}

TEST(Quarter, HillsAreNoSteeperThanStreetsAre) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Quarter quarter = make_quarter(options(3, 3, seed));
    for (const StreetLayout& street : quarter.layouts) {
      for (double s = 0; s < street.length; s += 5) {
        EXPECT_LT(std::abs(street.axis.height(s + 1) - street.axis.height(s)), 0.06);
      }
    }
  }
}

// Which stations of each street are driven, to 5 m.
TEST(Quarter, TourGoesThroughAllStreetsWithoutAJump) {
  for (const auto& [columns, rows] : {std::pair(1, 1), std::pair(3, 2), std::pair(2, 3)}) {
    const Quarter quarter = make_quarter(options(columns, rows));
    std::map<std::size_t, Interval> driven;
    for (const Leg& leg : quarter.tour) {
      const Interval of_leg = {std::min(leg.from, leg.to), std::max(leg.from, leg.to)};
      const auto found = driven.try_emplace(leg.street, of_leg).first;
      found->second = {std::min(found->second.begin, of_leg.begin), std::max(found->second.end, of_leg.end)};
    }
    EXPECT_EQ(driven.size(), quarter.layouts.size());
    for (const auto& [street, interval] : driven) {
      EXPECT_LE(interval.begin, 0.01);
      EXPECT_GE(interval.end, quarter.layouts[street].length - 0.01);
    }
    const Route route(quarter.layouts, quarter.tour);
    Eigen::Isometry3d before = route.place(0.5, -0.8);
    for (double s = 1; s < route.end(); s += 0.5) {
      const Eigen::Isometry3d here = route.place(s, -0.8);
      const Eigen::Vector3d step = here.translation() - before.translation();
      ASSERT_LT(step.norm(), 0.58) << s;  // outside a bend of 7 m the way is longer
      ASSERT_GT(step.norm(), 0.42) << s;
      ASSERT_LT(Eigen::AngleAxisd(before.linear().transpose() * here.linear()).angle(), 0.08) << s;
      ASSERT_GT(step.normalized().dot(here.linear().col(0)), 0.98) << s;  // it looks where it goes
      before = here;
    }
  }
}

TEST(Quarter, RefusesTooManyBlocksAndIdealOnes) {
  EXPECT_THROW(options(7, 2).check(), std::invalid_argument);
  EXPECT_THROW(options(3, 0).check(), std::invalid_argument);
  StreetOptions ideal = options(1, 1);
  ideal.is_ideal = true;
  EXPECT_THROW(ideal.check(), std::invalid_argument);
  EXPECT_NO_THROW(options(3, 2).check());
}

}  // namespace
}  // namespace vdbmap::simulator

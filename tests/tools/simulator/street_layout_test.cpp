// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/street_layout.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace vdbmap::simulator {
namespace {

constexpr double kBumps = 0.02;  // [m] more than the roughness of any two neighbours

TEST(StreetLayout, CarriagewayFallsFromItsCrownToTheGutter) {
  const StreetLayout layout = make_layout({.is_ideal = true});
  for (const SideLayout& side : layout.sides) {
    for (double s = 5; s < 170; s += 7.3) {
      const double fall = layout.ground_height(s, 0) - layout.ground_height(s, side.sign * side.kerb_offset());
      EXPECT_NEAR(fall, 0.025 * side.kerb_offset(), kBumps);
    }
  }
}

TEST(StreetLayout, KerbIsTwelveCentimetresHighExceptAtDrivewaysAndSideStreets) {
  const StreetLayout layout = make_layout({.seed = 2, .is_ideal = true});
  for (const SideLayout& side : layout.sides) {
    const auto step = [&](double s) {
      return layout.ground_height(s, side.sign * (side.kerb_offset() + 1e-6)) -
             layout.ground_height(s, side.sign * side.kerb_offset());
    };
    for (const Lot& lot : side.lots) {
      const double s = lot.along.middle();
      if (lot.kind == LotKind::kDriveway) {
        EXPECT_NEAR(step(s), 0.03, 0.011);
      } else if (lot.kind == LotKind::kSideStreet) {
        EXPECT_NEAR(step(s), 0, 0.011);
      } else if (side.is_plain(lot.along, 2.5)) {
        EXPECT_NEAR(step(s), 0.12, 0.011);  // roughness differs on both sides of the kerb
      }
    }
  }
}

TEST(StreetLayout, LotsFollowEachOtherWithoutGapsOverTheWholeStreet) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const StreetLayout layout = make_layout({.seed = seed, .is_ideal = true});
    for (const SideLayout& side : layout.sides) {
      EXPECT_EQ(side.lots.front().along.begin, layout.begin());
      EXPECT_GE(side.lots.back().along.end, layout.end());
      for (std::size_t i = 1; i < side.lots.size(); ++i) {
        EXPECT_EQ(side.lots[i - 1].along.end, side.lots[i].along.begin);
      }
      EXPECT_EQ(side.stretches(LotKind::kSideStreet).size(), 1U);
    }
  }
}

// Real streets repeat their houses: so localization has something to confuse.
TEST(StreetLayout, HousesOfOneTypeStandMoreThanOnceOnEachSide) {
  const StreetLayout layout = make_layout({.is_ideal = true});
  for (const SideLayout& side : layout.sides) {
    EXPECT_EQ(side.house_types.size(), 4U);
    EXPECT_GE(side.stretches(LotKind::kHouse).size(), 12U);
  }
}

TEST(StreetLayout, PlacesStandOnTheGroundAndLookAlongTheStreet) {
  const StreetLayout layout = make_layout({.is_ideal = true});
  const Eigen::Isometry3d a = layout.place(50, -2);
  const Eigen::Isometry3d b = layout.place(50.5, -2);
  EXPECT_EQ(a.translation().z(), layout.ground_height(50, -2));
  const Eigen::Vector3d step = b.translation() - a.translation();
  EXPECT_NEAR(step.head<2>().norm(), 0.5, 0.01);  // the street winds a little
  EXPECT_NEAR(step.normalized().dot(a.linear().col(0)), 1, 1e-3);
}

TEST(StreetLayout, AnotherSeedIsAnotherStreetAndTheSameTheSame) {
  const StreetLayout a = make_layout({.seed = 1, .is_ideal = true}), b = make_layout({.seed = 1, .is_ideal = true}),
                     c = make_layout({.seed = 2, .is_ideal = true});
  EXPECT_EQ(a.axis.origin, b.axis.origin);
  EXPECT_EQ(a.ground_height(30, 5), b.ground_height(30, 5));
  EXPECT_NE(a.axis.origin, c.axis.origin);
}

TEST(StreetOptions, RefusesWhatIsNoStreet) {
  EXPECT_NO_THROW(StreetOptions{}.check());
  const StreetOptions refused[] = {{.length = 0},     {.length = -5},     {.length = NAN},     {.length = 1e6},
                                   {.num_epochs = 0}, {.num_epochs = 21}, {.occupancy = 1.01}, {.turnover = -0.1}};
  for (const StreetOptions& options : refused) EXPECT_THROW(options.check(), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap::simulator

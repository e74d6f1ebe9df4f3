// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/occupancy/space_columns.h"

#include <map>
#include <random>

#include <gtest/gtest.h>

namespace vdbmap::parking {
namespace {

const GroundPlane kHill = {2, {1, 1}, {0.03, -0.05}};

ParkingSpace l_shaped() { return space_of_outline({{0, 0}, {6, 1}, {5.7, 3}, {2.6, 2.5}, {2.3, 4.4}, {-0.7, 3.9}}); }

// Lengths of a ray in each column, by short steps.
std::map<std::size_t, double> lengths_by_steps(const SpaceColumns& room, const Eigen::Vector3d& from,
                                               const Eigen::Vector3d& to, double high) {
  constexpr int kSteps = 20'000;
  std::map<std::size_t, double> lengths;
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::Vector3d place = room.in_frame(from + (i + 0.5) / kSteps * (to - from));
    if (place.z() < SpaceColumns::kLow || place.z() > high) continue;
    if (const auto column = room.column_at(place.x(), place.y())) lengths[*column] += (to - from).norm() / kSteps;
  }
  return lengths;
}

TEST(SpaceColumns, AreThoseWhoseMiddlesLieInside) {
  const ParkingSpace space = space_of_outline({{0, 0}, {5.6, 0}, {5.6, 2}, {0, 2}});
  const SpaceColumns room(space, {});
  EXPECT_EQ(room.size(), 44U);
  EXPECT_DOUBLE_EQ(room.edges().x(), 5.6 / 11);
  EXPECT_DOUBLE_EQ(room.edges().y(), 0.5);
  EXPECT_LT(SpaceColumns(l_shaped(), {}).size(),
            SpaceColumns(space_of_outline({{0, 0}, {6, 1}, {5.3, 5.2}, {-0.7, 4.2}}), {}).size());
}

// Of 11 by 4 columns 9 by 2; of an outline with a corner cut out, those that have eight neighbours.
TEST(SpaceColumns, AreInnerWhereColumnsLieAllAround) {
  for (const ParkingSpace& space : {l_shaped(), space_of_outline({{0, 0}, {5.6, 0}, {5.6, 2}, {0, 2}})}) {
    const SpaceColumns room(space, {});
    const std::vector<Eigen::Vector3d> middles = room.middles();
    const double reach = 1.1 * room.edges().norm();
    std::size_t num_inner = 0;
    for (std::size_t i = 0; i < room.size(); ++i) {
      const auto num_near = std::ranges::count_if(
          middles, [&](const Eigen::Vector3d& middle) { return (middle - middles[i]).head<2>().norm() < reach; });
      EXPECT_EQ(room.is_inner(i), num_near == 9);
      num_inner += room.is_inner(i) ? 1 : 0;
    }
    if (space.outline.size() == 4) {
      EXPECT_EQ(num_inner, 18U);
    }
  }
}

TEST(SpaceColumns, ArePassedWhereShortStepsSaySo) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> wide(-8, 12), height(1, 6);
  for (const ParkingSpace& space : {l_shaped(), space_of_outline({{0, 0}, {5.6, 0}, {5.6, 2}, {0, 2}})}) {
    const SpaceColumns room(space, kHill);
    std::size_t num_passed = 0;
    for (int i = 0; i < 400; ++i) {
      const Eigen::Vector3d from(wide(random), wide(random), height(random)),
          to(wide(random), wide(random), height(random));
      for (const double high : {SpaceColumns::kHigh, SpaceColumns::kSill}) {
        std::map<std::size_t, double> lengths = lengths_by_steps(room, from, to, high);
        const double error = 3 * (to - from).norm() / 20'000;  // [m] of what steps say
        room.for_each_passed(from, to, high, [&](std::size_t column) {
          EXPECT_GE(lengths[column], SpaceColumns::kShortestPass - error);
          lengths.erase(column);
          ++num_passed;
        });
        for (const auto& [column, length] : lengths) EXPECT_LE(length, SpaceColumns::kShortestPass + error);
      }
    }
    EXPECT_GT(num_passed, 100U);
  }
}

TEST(SpaceColumns, ARayThatEndsBeforeThemPassesNone) {
  const SpaceColumns room(space_of_outline({{0, 0}, {5, 0}, {5, 2}, {0, 2}}), {});
  const auto num_passed = [&](const Eigen::Vector3d& to) {
    int count = 0;
    room.for_each_passed({-5, 1.2, 1}, to, SpaceColumns::kHigh, [&](std::size_t) { ++count; });
    return count;
  };
  EXPECT_EQ(num_passed({-0.1, 1.2, 1}), 0);
  EXPECT_EQ(num_passed({2.5, 1.2, 1}), 5);
  EXPECT_EQ(num_passed({9, 1.2, 1}), 10);
}

}  // namespace
}  // namespace vdbmap::parking

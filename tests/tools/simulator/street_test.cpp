// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/street.h"

#include <set>

#include <gtest/gtest.h>

#include "tools/simulator/label_names.h"

namespace vdbmap::simulator {
namespace {

std::set<std::uint16_t> labels_of(const Street& street, const Mesh& mesh) {
  std::set<std::uint16_t> labels;
  for (const Triangle& t : mesh.triangles) {
    labels.insert(static_cast<std::uint16_t>(street.world.materials()[t.material].label));
  }
  return labels;
}

TEST(Street, HoldsEverythingAStreetHas) {
  std::set<std::uint16_t> found;
  for (const std::uint64_t seed : {1, 2}) {
    const Street street = make_street({.seed = seed, .length = 90, .margin = 5, .num_epochs = 1, .is_ideal = true});
    found.merge(labels_of(street, street.mesh(0)));
  }
  for (const auto& [label, name] : label_names(true)) {
    EXPECT_TRUE(found.contains(static_cast<std::uint16_t>(label))) << name;
  }
}

TEST(Street, EpochsShareWhatLastsAndEveryTriangleHasAMaterialAndAnObject) {
  const Street street = make_street({.length = 40, .margin = 5, .num_epochs = 3, .is_ideal = true});
  EXPECT_EQ(street.changing.size(), 3U);
  for (int epoch = 0; epoch < 3; ++epoch) {
    const Mesh mesh = street.mesh(epoch);
    EXPECT_EQ(mesh.triangles.size(),
              street.lasting.triangles.size() + street.changing[static_cast<std::size_t>(epoch)].triangles.size());
    for (const Triangle& t : mesh.triangles) {
      ASSERT_LT(t.material, street.world.materials().size());
      ASSERT_LT(t.object, street.world.objects().size());
      ASSERT_LT(std::max({t.a, t.b, t.c}), mesh.vertices.size());
    }
    for (const Eigen::Vector3f& vertex : mesh.vertices) ASSERT_TRUE(vertex.allFinite());
  }
}

// Over a few seeds everything that a real street has stands there, but for what only moves or is no surface.
TEST(Street, RoughOnesHoldMoreKindsOfThings) {
  std::set<std::uint16_t> found;
  std::set<LotKind> lots;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const Street street = make_street({.seed = seed, .length = 120, .margin = 20, .num_epochs = 1});
    found.merge(labels_of(street, street.mesh(0)));
  }
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const SideLayout& side : make_layout({.seed = seed}).sides) {
      for (const Lot& lot : side.lots) lots.insert(lot.kind);
    }
  }
  for (const auto& [label, name] : label_names(false)) {
    using enum SurfaceClass;
    const bool only_moves = label >= kMovingCar || label == kBus || label == kMotorcyclist || label == kOutlier;
    EXPECT_TRUE(only_moves || found.contains(static_cast<std::uint16_t>(label))) << name;
  }
  for (const LotKind kind : {LotKind::kPark, LotKind::kCarPark, LotKind::kHall, LotKind::kOpen, LotKind::kSideStreet}) {
    EXPECT_TRUE(lots.contains(kind)) << name_of(kind);
  }
}

TEST(Street, VehiclesElsewhereBlockNoSpaceAndThingsOnlyVacantOnes) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Street street = make_street({.seed = seed, .length = 120, .margin = 20});
    for (const std::size_t epoch : {0, 1}) {
      EXPECT_FALSE(street.parking.elsewhere[epoch].empty());
      for (const std::size_t vehicle : street.parking.elsewhere[epoch]) {
        EXPECT_EQ(street.parking.vehicles[vehicle].space, kNoSpace);
      }
      for (std::size_t i = 0; i < street.parking.spaces.size(); ++i) {
        if (street.parking.thing_in_space[epoch][i]) {
          EXPECT_FALSE(street.parking.vehicle_in_space[epoch][i]);
        }
      }
    }
  }
}

}  // namespace
}  // namespace vdbmap::simulator

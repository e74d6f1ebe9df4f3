// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/changes.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "tools/simulator/truth_files.h"

namespace vdbmap::simulator {
namespace {

constexpr auto kCar = static_cast<std::uint16_t>(SurfaceClass::kCar);

std::set<ObjectId> vehicles_of(const Street& street, int epoch) {
  std::set<ObjectId> ids;
  for (const ParkedVehicle* vehicle : street.vehicles(epoch)) ids.insert(vehicle->object);
  return ids;
}

// Whether a point lies in the box, or no farther from it than mirrors and half a voxel's diagonal reach.
bool is_in_box(const Street& street, const ParkedVehicle& vehicle, const Eigen::Vector3d& point) {
  const Eigen::Vector3d p = vehicle.scene_from_vehicle.inverse() * (point - street.origin());
  return std::abs(p.x()) < vehicle.shape.length / 2 + 0.1 && std::abs(p.y()) < vehicle.shape.width / 2 + 0.25 &&
         p.z() > -0.1 && p.z() < vehicle.shape.height + 0.1;
}

TEST(Changes, CarsThatLeftVanishAndCarsThatCameAppearWhereTheyStood) {
  const Street street = make_street({.length = 40, .margin = 5, .turnover = 0.5, .is_ideal = true});
  const std::set<ObjectId> before = vehicles_of(street, 0), after = vehicles_of(street, 1);
  std::set<ObjectId> changed;
  for (const ChangedVoxel& voxel : changed_voxels(street, 0)) {
    if (voxel.label != kCar) continue;
    changed.insert(voxel.object);
    EXPECT_EQ(voxel.has_appeared, after.contains(voxel.object));
    EXPECT_NE(before.contains(voxel.object), after.contains(voxel.object));
    const Eigen::Vector3d center = change_anchor(street) + center_of_voxel(voxel.voxel, kChangeVoxelSize);
    EXPECT_TRUE(std::ranges::any_of(street.parking.vehicles, [&](const ParkedVehicle& vehicle) {
      return vehicle.object == voxel.object && is_in_box(street, vehicle, center);
    }));
  }
  std::set<ObjectId> expected;
  std::ranges::set_symmetric_difference(before, after, std::inserter(expected, expected.end()));
  EXPECT_FALSE(expected.empty());
  EXPECT_EQ(changed, expected);
}

TEST(Changes, CarsThatStayChangeNothing) {
  const Street street = make_street({.length = 30, .margin = 5, .occupancy = 1, .turnover = 0, .is_ideal = true});
  const auto changes = changed_voxels(street, 0);
  EXPECT_FALSE(changes.empty());  // people, bicycles, bins and leaves
  EXPECT_TRUE(std::ranges::none_of(changes, [](const ChangedVoxel& voxel) { return voxel.label == kCar; }));
}

}  // namespace
}  // namespace vdbmap::simulator

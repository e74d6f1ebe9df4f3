// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/things/kinds.h"

#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "tools/simulator/ray_caster.h"
#include "tools/simulator/things/shrub.h"

namespace vdbmap::simulator {
namespace {

struct DrawnThing {
  World world;
  Mesh mesh;
  Eigen::AlignedBox3f box;
  Eigen::AlignedBox3f below_heads;      // what is in the way of people
  std::map<SurfaceClass, double> area;  // [m^2]

  DrawnThing(const ThingKind& kind, std::uint64_t seed) {
    Random random(seed);
    kind.draw({Brush{&mesh, Eigen::Isometry3d::Identity(), 0, 5}, world, random, kind.length, kind.width, false});
    for (const Eigen::Vector3f& vertex : mesh.vertices) {
      box.extend(vertex);
      if (vertex.z() < 1.7F) below_heads.extend(vertex);
    }
    for (const Triangle& t : mesh.triangles) {
      const Eigen::Vector3f& a = mesh.vertices[t.a];
      const Eigen::Vector3f normal = (mesh.vertices[t.b] - a).cross(mesh.vertices[t.c] - a);
      area[world.materials()[t.material].label] += normal.norm() / 2.0;
    }
  }
};

TEST(ThingKinds, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const ThingKind& kind : thing_kinds()) EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
  EXPECT_GE(names.size(), 25U);
}

TEST(ThingKinds, DrawThemselvesOnTheGroundOfTheirSiteAndInTheirClass) {
  for (const ThingKind& kind : thing_kinds()) {
    for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
      const DrawnThing thing(kind, seed);
      if (thing.mesh.triangles.empty()) continue;  // a row of bins may have none
      EXPECT_GT(thing.area.count(kind.label), 0U) << kind.name;
      EXPECT_LT(thing.box.min().z(), 0.35F) << kind.name;  // beds begin above their rim
      EXPECT_GT(thing.box.max().z(), 0.1F) << kind.name;
      EXPECT_LT(thing.box.max().z(), 15) << kind.name;
      for (const Triangle& t : thing.mesh.triangles) ASSERT_EQ(t.object, 5) << kind.name;
    }
  }
}

// Twigs, rods and parasols reach beyond; what is measured is where most of it is.
TEST(ThingKinds, KeepToTheRoomTheyAskFor) {
  constexpr float kReach = 1.0F;  // [m]
  for (const ThingKind& kind : thing_kinds()) {
    for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
      const DrawnThing thing(kind, seed);
      if (kind.label == SurfaceClass::kTrunk || thing.mesh.triangles.empty()) continue;  // its branches are over heads
      const auto half = static_cast<float>(kind.length / 2) + kReach;
      EXPECT_GT(thing.below_heads.min().x(), -half) << kind.name;
      EXPECT_LT(thing.below_heads.max().x(), half) << kind.name;
      EXPECT_GT(thing.below_heads.min().y(), -static_cast<float>(kind.width / 2) - kReach) << kind.name;
      EXPECT_LT(thing.below_heads.max().y(), static_cast<float>(kind.width / 2) + kReach) << kind.name;
    }
  }
}

// The same thing, summer and winter: its twigs stay, its leaves do not.
TEST(ThingKinds, PlantsThatShedHaveFewerLeavesInWinter) {
  for (const ThingKind& kind : thing_kinds()) {
    if (kind.season != Season::kSheds) continue;
    double summer = 0, winter = 0;
    for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
      for (const bool is_winter : {false, true}) {
        World world;
        Mesh mesh;
        Random random(seed);
        kind.draw({Brush{&mesh}, world, random, kind.length, kind.width, is_winter});
        (is_winter ? winter : summer) += static_cast<double>(mesh.triangles.size());
      }
    }
    EXPECT_LT(winter, 0.8 * summer) << kind.name;
  }
}

// Level rays into a clipped hedge: its face is rough to a decimetre and more, and some light goes through its edge.
TEST(Shrub, LightEntersIt) {
  World world;
  Mesh mesh;
  Random random(3);
  add_rough_hedge({&mesh}, world.standard().twigs, {4, 0.9, 1.6}, random);
  const RayCaster caster(mesh);
  int num_hits = 0, num_rays = 0, num_deep = 0;
  for (double x = 0.5; x < 3.5; x += 0.02) {
    for (double z = 0.3; z < 1.3; z += 0.05, ++num_rays) {
      const auto hit = caster.first_hit({{x, -3, z}, Eigen::Vector3d::UnitY()});
      if (hit && hit->distance < 4.1) ++num_hits;
      if (hit && hit->distance > 3.15) ++num_deep;
    }
  }
  EXPECT_GT(num_hits, 0.8 * num_rays);
  EXPECT_GT(num_deep, 0.1 * num_rays);
}

TEST(Shrub, HasTheSizeItsShapeSays) {
  World world;
  Mesh mesh;
  Random random(3);
  const ShrubShape shape{{4, 1.6, 1.5}, 5, 0.06, 0.1, 80, 0.05, 0.2};
  add_shrub({&mesh}, world.standard().twigs, shape, random);
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex);
  EXPECT_TRUE(box.sizes().isApprox(Eigen::Vector3f(4, 1.6F, 1.5F), 0.15F)) << box.sizes().transpose();
  EXPECT_NEAR(box.min().z(), 0.2, 0.1);
}

}  // namespace
}  // namespace vdbmap::simulator

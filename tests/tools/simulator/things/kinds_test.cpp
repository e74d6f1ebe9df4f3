// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/things/kinds.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

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

// Distances [m] of level rays to a clipped hedge of 0.9 m, and how many found it.
struct HedgeFace {
  std::vector<double> depths;
  double found = 0;  // share of the rays

  explicit HedgeFace(std::uint64_t seed) {
    World world;
    Mesh mesh;
    Random random(seed);
    add_rough_hedge({&mesh}, world.standard().twigs, {4, 0.9, 1.6}, random);
    const RayCaster caster(mesh);
    int num_rays = 0;
    for (double x = 0.5; x < 3.5; x += 0.02) {
      for (double z = 0.3; z < 1.3; z += 0.05, ++num_rays) {
        const auto hit = caster.first_hit({{x, -3, z}, Eigen::Vector3d::UnitY()});
        if (hit && hit->distance < 4.1) depths.push_back(hit->distance);
      }
    }
    found = static_cast<double>(depths.size()) / num_rays;
    std::ranges::sort(depths);
  }

  double quantile(double share) const {
    return depths[static_cast<std::size_t>(share * static_cast<double>(depths.size() - 1))];
  }
};

// Of KITTI's hedges (kitti00) half of the points within 0.5 m lie in a layer of some 5 cm; no wall is as rough, and
// none is as smooth as a wall. Thin ones let light in.
TEST(Shrub, AHedgeIsRougherThanAWallAndLightEntersSome) {
  int num_open = 0;
  std::vector<double> layers;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const HedgeFace face(seed);
    EXPECT_GT(face.found, 0.8) << seed;
    EXPECT_GT(face.quantile(0.75) - face.quantile(0.25), 0.02) << seed;
    layers.push_back(face.quantile(0.75) - face.quantile(0.25));
    if (face.quantile(0.9) - face.quantile(0.1) > 0.15) ++num_open;
  }
  std::ranges::sort(layers);
  EXPECT_LT(layers[layers.size() / 2], 0.1);
  EXPECT_GE(num_open, 1);
  EXPECT_LE(num_open, 8);
}

TEST(Shrub, NoLightGoesThroughADenseOne) {
  World world;
  Random random(3);
  ShrubShape shape{{4, 1.6, 1.5}, 5, 0.06, 0.02, 80, 0.05};
  for (const bool is_dense : {false, true}) {
    Mesh mesh;
    shape.is_dense = is_dense;
    add_shrub({&mesh}, world.standard().twigs, shape, random);
    const RayCaster caster(mesh);
    int num_through = 0;
    for (double x = -1.5; x < 1.5; x += 0.05) {
      for (double z = 0.2; z < 1.1; z += 0.05) {
        if (!caster.first_hit({{x, -3, z}, Eigen::Vector3d::UnitY()})) ++num_through;
      }
    }
    EXPECT_EQ(num_through == 0, is_dense);
  }
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

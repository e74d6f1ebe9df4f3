// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/vegetation.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tools/simulator/ray_caster.h"

namespace vdbmap::simulator {
namespace {

Tree one_tree() {
  Random random(4);
  return make_tree(Eigen::Isometry3d::Identity(), 2.5, random);
}

std::size_t num_leaves(const Tree& tree, int epoch) {
  Mesh mesh;
  add_crown(mesh, tree, epoch);
  return mesh.triangles.size() / 2;
}

// Level rays through the middle half of the crown: some pass, most do not.
TEST(Vegetation, CrownsArePorous) {
  const Tree tree = one_tree();
  Mesh mesh;
  add_crown(mesh, tree, 0);
  const RayCaster caster(mesh);
  int num_blocked = 0, num_rays = 0;
  for (double y = -tree.crown_radius / 2; y < tree.crown_radius / 2; y += 0.05) {
    for (double share = 0.25; share < 0.75; share += 0.02, ++num_rays) {
      const double z = tree.trunk_height + share * tree.crown_height;
      if (caster.is_blocked({{-20, y, z}, Eigen::Vector3d::UnitX()})) ++num_blocked;
    }
  }
  EXPECT_GT(num_blocked, 0.5 * num_rays);
  EXPECT_LT(num_blocked, 0.999 * num_rays);
}

TEST(Vegetation, CrownsChangeALittleFromEpochToEpoch) {
  const Tree tree = one_tree();
  Mesh first, again, second;
  add_crown(first, tree, 0);
  add_crown(again, tree, 0);
  add_crown(second, tree, 1);
  EXPECT_EQ(first.vertices, again.vertices);
  EXPECT_NE(first.vertices, second.vertices);
  EXPECT_NEAR(static_cast<double>(num_leaves(tree, 1)) / static_cast<double>(num_leaves(tree, 0)), 1, 0.2);
}

TEST(Vegetation, TrunksStandWhereTheirTreeDoes) {
  const World world;
  Mesh mesh;
  const Tree tree = one_tree();
  add_wood(mesh, tree, world.standard());
  const auto hit = RayCaster(mesh).first_hit({{-5, 0, 0.5}, Eigen::Vector3d::UnitX()});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance, 5 - tree.trunk_radius, 0.05);  // a twelve-sided trunk that leans a little
}

TEST(Vegetation, HedgesFillTheirSizeAndNoMore) {
  Mesh mesh;
  Random random(2);
  add_hedge({&mesh}, {4, 0.6, 1.4}, random);
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex);
  EXPECT_TRUE(box.sizes().isApprox(Eigen::Vector3f(4, 0.6F, 1.5F), 0.15F)) << box.sizes().transpose();
  EXPECT_LT(box.max().z(), 1.5F);
}

TEST(Vegetation, SomeTreesLeanAndSomeAreThick) {
  Random random(8);
  int num_leaning = 0, num_thick = 0;
  for (int i = 0; i < 200; ++i) {
    Tree tree = one_tree();
    roughen(tree, random);
    num_leaning += tree.scene_from_foot.linear()(2, 2) < std::cos(0.08) ? 1 : 0;
    num_thick += tree.trunk_radius > 0.25 ? 1 : 0;
    EXPECT_GT(tree.scene_from_foot.linear()(2, 2), std::cos(0.26));
  }
  EXPECT_GT(num_leaning, 20);
  EXPECT_GT(num_thick, 20);
  EXPECT_LT(num_thick, 100);
}

TEST(Vegetation, FewLeavesHangOnInWinter) {
  Mesh summer, winter;
  add_crown(summer, one_tree(), 0);
  add_crown(winter, one_tree(), 0, 0.1);
  EXPECT_NEAR(static_cast<double>(winter.triangles.size()), 0.1 * static_cast<double>(summer.triangles.size()), 10);
}

}  // namespace
}  // namespace vdbmap::simulator

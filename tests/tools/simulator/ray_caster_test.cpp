// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/ray_caster.h"

#include <gtest/gtest.h>

#include "tests/support/threads.h"
#include "tools/simulator/random.h"

namespace vdbmap::simulator {
namespace {

Eigen::Vector3d random_point(Random& random) {
  return {random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5)};
}

Mesh random_triangles(int count) {
  Random random(5);
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d a = random_point(random);
    add_triangle({&mesh}, a, a + 0.2 * random_point(random), a + 0.2 * random_point(random));
  }
  return mesh;
}

// The ray's distance to the triangle by solving o + t d = a + u (b - a) + v (c - a).
std::optional<double> distance_to(const Mesh& mesh, const Triangle& triangle, const Ray& ray) {
  const Eigen::Vector3d a = mesh.vertices[triangle.a].cast<double>();
  Eigen::Matrix3d system;
  system << -ray.direction, mesh.vertices[triangle.b].cast<double>() - a, mesh.vertices[triangle.c].cast<double>() - a;
  const Eigen::Vector3d tuv = system.fullPivLu().solve(ray.origin - a);
  if (tuv[1] < 0 || tuv[2] < 0 || tuv[1] + tuv[2] > 1) return std::nullopt;
  return tuv[0] >= ray.nearest && tuv[0] <= ray.farthest ? std::optional(tuv[0]) : std::nullopt;
}

std::optional<double> brute_force(const Mesh& mesh, const Ray& ray) {
  std::optional<double> nearest;
  for (const Triangle& triangle : mesh.triangles) {
    const std::optional<double> distance = distance_to(mesh, triangle, ray);
    if (distance && (!nearest || *distance < *nearest)) nearest = distance;
  }
  return nearest;
}

TEST(RayCaster, FindsWhatTryingEveryTriangleFinds) {
  const Mesh mesh = random_triangles(300);
  const RayCaster caster(mesh);
  Random random(6);
  int num_hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Ray ray = {random_point(random), (random_point(random) - random_point(random)).normalized(), 0.01, 9};
    const std::optional<Hit> hit = caster.first_hit(ray);
    const std::optional<double> expected = brute_force(mesh, ray);
    ASSERT_EQ(hit.has_value(), expected.has_value()) << i;
    EXPECT_EQ(caster.is_blocked(ray), expected.has_value()) << i;
    if (!hit) continue;
    ++num_hits;
    EXPECT_NEAR(hit->distance, *expected, 2e-5);  // Embree computes in floats
    EXPECT_LE(hit->normal.dot(ray.direction), 0);
    EXPECT_NEAR(hit->normal.norm(), 1, 1e-6);
  }
  EXPECT_GT(num_hits, 300);
}

TEST(RayCaster, CoincidingSurfacesAreHitAlikeForAnyNumberOfThreads) {
  Mesh mesh = random_triangles(300);
  mesh.append(random_triangles(300));  // each twice
  const auto hits = [&](int threads) {
    return test::on_threads(threads, [&] {
      const RayCaster caster(mesh);
      Random random(6);
      std::vector<std::uint32_t> triangles;
      for (int i = 0; i < 1000; ++i) {
        const auto hit = caster.first_hit({random_point(random), Eigen::Vector3d::UnitX(), 0, 9});
        if (hit) triangles.push_back(hit->triangle);
      }
      return triangles;
    });
  };
  EXPECT_EQ(hits(1), hits(4));
}

}  // namespace
}  // namespace vdbmap::simulator

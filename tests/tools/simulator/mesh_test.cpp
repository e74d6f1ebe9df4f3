// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/mesh.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace vdbmap::simulator {
namespace {

using std::numbers::pi;

struct Triangle3 {
  Eigen::Vector3d a, b, c;
};

Triangle3 corners(const Mesh& mesh, const Triangle& t) {
  return {mesh.vertices[t.a].cast<double>(), mesh.vertices[t.b].cast<double>(), mesh.vertices[t.c].cast<double>()};
}

double area_of(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& triangle : mesh.triangles) {
    const Triangle3 t = corners(mesh, triangle);
    sum += (t.b - t.a).cross(t.c - t.a).norm() / 2;
  }
  return sum;
}

Eigen::AlignedBox3f bounds(const Mesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex);
  return box;
}

TEST(Mesh, BoxHasSixFacesOfTheRightArea) {
  Mesh mesh;
  add_box({&mesh}, {-1, 0, 2}, {1, 3, 6});
  EXPECT_EQ(mesh.triangles.size(), 12U);
  EXPECT_NEAR(area_of(mesh), 2 * (2 * 3 + 3 * 4 + 2 * 4), 1e-5);
  EXPECT_EQ(bounds(mesh).min(), Eigen::Vector3f(-1, 0, 2));
  EXPECT_EQ(bounds(mesh).max(), Eigen::Vector3f(1, 3, 6));
}

// A prism with n sides inscribed in the tube: n chords of 2 r sin(pi / n) by its length, and two n-gons.
TEST(Mesh, TubeIsAnInscribedPrism) {
  Mesh mesh;
  add_tube({&mesh}, {{0, 0, 0}, {0, 0, 2}, 0.5, 0.5, 12, true});
  const double chord = 2 * 0.5 * std::sin(pi / 12);
  const double cap = 12 * 0.5 * 0.5 * std::sin(2 * pi / 12) / 2;
  EXPECT_NEAR(area_of(mesh), 12 * chord * 2 + 2 * cap, 1e-5);
}

TEST(Mesh, EllipsoidLiesOnItsEquation) {
  Mesh mesh;
  const Eigen::Vector3d center(1, 2, 3), radii(0.5, 1, 2);
  add_ellipsoid({&mesh}, center, radii, 16);
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    EXPECT_NEAR((vertex.cast<double>() - center).cwiseQuotient(radii).norm(), 1, 1e-5);
  }
}

TEST(Mesh, BrushMovesAndTurnsWhatItDraws) {
  Mesh mesh;
  const Brush brush = Brush{&mesh, Eigen::Isometry3d::Identity(), 3, 4}.at({10, 0, 0}, pi / 2).with(5);
  add_triangle(brush, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  EXPECT_TRUE(mesh.vertices[0].isApprox(Eigen::Vector3f(10, 1, 0), 1e-6F));
  EXPECT_TRUE(mesh.vertices[1].isApprox(Eigen::Vector3f(9, 0, 0), 1e-6F));
  EXPECT_EQ(mesh.triangles[0].material, 5);
  EXPECT_EQ(mesh.triangles[0].object, 4);
}

TEST(Mesh, AppendKeepsTheTrianglesOfBoth) {
  Mesh a, b;
  add_box({&a}, {0, 0, 0}, {1, 1, 1});
  add_box({&b}, {5, 5, 5}, {6, 6, 6});
  a.append(b);
  EXPECT_NEAR(area_of(a), 12, 1e-5);
  EXPECT_EQ(bounds(a).max(), Eigen::Vector3f(6, 6, 6));
}

}  // namespace
}  // namespace vdbmap::simulator

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/plane_solver.h"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"
#include "vdbmap/core/eigen_features.h"

namespace vdbmap {
namespace {

constexpr double kTenthOfACode = 0.1 / 255;

Symmetric3<double> elements_of(const Eigen::Matrix3d& m) {
  return {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)};
}

void expect_plane(const SolvedPlane<double>& solved, const Eigen::Matrix3d& covariance) {
  const PlaneFit exact = fit_plane(covariance);
  const Eigen::Vector3d normal(solved.x, solved.y, solved.z);
  EXPECT_NEAR(solved.planarity, exact.planarity, kTenthOfACode);
  EXPECT_NEAR(normal.norm(), 1, 1e-12);
  if (exact.planarity < 0.01) return;  // no direction to compare
  EXPECT_LT(normal.cross(exact.normal).norm(), 1e-5) << covariance;
}

// Eigenvalues 1, l2, l3 of every ratio, alike ones too, from a metre to a tenth of a millimetre.
Eigen::Matrix3d random_covariance(std::mt19937& random) {
  std::uniform_real_distribution<double> share(0, 1);
  const double scale = std::pow(10, -8 * share(random));
  const double l2 = share(random) < 0.1 ? 1 : share(random);
  const double l3 = share(random) < 0.1 ? l2 : share(random) < 0.1 ? 0 : l2 * share(random);
  const Eigen::Matrix3d rotation = test::random_motion(0, 77, random).linear();
  return scale * rotation * Eigen::Vector3d(1, l2, l3).asDiagonal() * rotation.transpose();
}

TEST(PlaneSolver, AgreesWithTheExactFit) {
  std::mt19937 random(4);
  for (int i = 0; i < 20'000; ++i) {
    const Eigen::Matrix3d covariance = random_covariance(random);
    expect_plane(solve_plane(elements_of(covariance)), covariance);
  }
}

TEST(PlaneSolver, SolvesFourSideBySideAsOne) {
  std::mt19937 random(5);
  for (int i = 0; i < 1000; ++i) {
    Symmetric3<Eigen::Array4d> four;
    std::array<Symmetric3<double>, 4> one;
    for (int lane = 0; lane < 4; ++lane) {
      const Symmetric3<double> m = one[static_cast<std::size_t>(lane)] = elements_of(random_covariance(random));
      four.xx[lane] = m.xx, four.yy[lane] = m.yy, four.zz[lane] = m.zz;
      four.xy[lane] = m.xy, four.xz[lane] = m.xz, four.yz[lane] = m.yz;
    }
    const SolvedPlane<Eigen::Array4d> planes = solve_plane(four);
    for (int lane = 0; lane < 4; ++lane) {
      // Multiply-and-add may be fused on one side only.
      EXPECT_NEAR(planes.planarity[lane], solve_plane(one[static_cast<std::size_t>(lane)]).planarity, 1e-6);
    }
  }
}

TEST(PlaneSolver, NoExtentHasAnUprightNormal) {
  const SolvedPlane<double> plane = solve_plane(Symmetric3<double>{0, 0, 0, 0, 0, 0});
  EXPECT_EQ(plane.planarity, 0);
  EXPECT_EQ(plane.z, 1);
}

}  // namespace
}  // namespace vdbmap

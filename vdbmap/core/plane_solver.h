// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

namespace vdbmap {

/// A symmetric 3x3 matrix, one or several side by side: Real is double or Eigen::Array4d.
template <typename Real>
struct Symmetric3 {
  Real xx, yy, zz, xy, xz, yz;
};

/// The plane of a distribution, one or several side by side.
template <typename Real>
struct SolvedPlane {
  Real x, y, z;    ///< normal, either sign, unit; (0, 0, 1) where the two thinnest directions are alike
  Real planarity;  ///< (l2 - l3) / l1 of the eigenvalues l1 >= l2 >= l3, 0 to 1
};

namespace plane_solver {

inline double select(bool condition, double yes, double no) { return condition ? yes : no; }
inline double square_root(double value) { return std::sqrt(value); }
inline double at_least(double value, double least) { return std::max(value, least); }
inline double at_most(double value, double most) { return std::min(value, most); }
inline double minimum(double a, double b) { return std::min(a, b); }

using Array4b = Eigen::Array<bool, 4, 1>;
inline Eigen::Array4d select(const Array4b& condition, const Eigen::Array4d& yes, const Eigen::Array4d& no) {
  return condition.select(yes, no);
}
inline Eigen::Array4d square_root(const Eigen::Array4d& value) { return value.sqrt(); }
inline Eigen::Array4d at_least(const Eigen::Array4d& value, double least) { return value.max(least); }
inline Eigen::Array4d at_most(const Eigen::Array4d& value, double most) { return value.min(most); }
inline Eigen::Array4d minimum(const Eigen::Array4d& a, const Eigen::Array4d& b) { return a.min(b); }

/// Smallest root of t^3 - t^2 + b t - c, which has three real roots and none below 0. Laguerre's method climbs to it
/// from 0: cubically to a single root, by a factor of four a step to a double one, at once to a triple one.
template <typename Real>
Real smallest_root(const Real& minors, const Real& determinant) {
  constexpr int kSteps = 6;  // leaves a double root 0.02 % off, a tenth of what a planarity code tells apart
  constexpr double kMinDivisor = 1e-10;  // rounding alone makes it smaller, where a step no longer matters
  // Rounding can leave a needle's b and c where no three real roots are (Newton: b^2 >= 3 c).
  const Real b = at_least(minors, 0.0);
  const Real c = at_least(minimum(determinant, Real(b * b / 3.0)), 0.0);
  Real root = 0.0 * b;
  for (int i = 0; i < kSteps; ++i) {
    const Real value = ((root - 1.0) * root + b) * root - c;
    const Real slope = (3.0 * root - 2.0) * root + b;
    const Real curvature = 6.0 * root - 2.0;
    const Real discriminant = at_least(Real(4.0 * slope * slope - 6.0 * value * curvature), 0.0);
    const Real divisor = slope + square_root(discriminant);
    root = at_least(Real(root - 3.0 * value / at_least(divisor, kMinDivisor)), 0.0);
  }
  return root;
}

}  // namespace plane_solver

/// Normal and planarity of a covariance, or of any positive multiple of it, without a branch: for many at a time, where
/// fit_plane() is exact. Planarity to 4e-4, a tenth of the step in which voxels store it, and far better except where
/// the two thinnest directions are alike; normals to 1e-5 from a planarity of 0.01 on.
template <typename Real>
SolvedPlane<Real> solve_plane(const Symmetric3<Real>& covariance) {
  using namespace plane_solver;
  const Real scale = 1.0 / at_least(Real(covariance.xx + covariance.yy + covariance.zz), 1e-150);
  const Real xx = covariance.xx * scale, yy = covariance.yy * scale, zz = covariance.zz * scale;
  const Real xy = covariance.xy * scale, xz = covariance.xz * scale, yz = covariance.yz * scale;

  // Characteristic polynomial of a matrix of trace 1, and its smallest root l3.
  const Real minors = xx * yy + xx * zz + yy * zz - xy * xy - xz * xz - yz * yz;
  const Real determinant = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  const Real l3 = smallest_root<Real>(minors, determinant);

  // The normal is orthogonal to the rows of the matrix less l3: the longest of their cross products.
  const Real a = xx - l3, b = yy - l3, c = zz - l3;
  const Real ux = xy * yz - xz * b, uy = xz * xy - a * yz, uz = a * b - xy * xy;
  const Real vx = xy * c - xz * yz, vy = xz * xz - a * c, vz = a * yz - xy * xz;
  const Real wx = b * c - yz * yz, wy = yz * xz - xy * c, wz = xy * yz - b * xz;
  const Real u = ux * ux + uy * uy + uz * uz, v = vx * vx + vy * vy + vz * vz, w = wx * wx + wy * wy + wz * wz;
  const auto v_is_longer = v > u;
  const Real uv = select(v_is_longer, v, u);
  const auto w_is_longest = w > uv;
  const Real squared = select(w_is_longest, w, uv);
  const Real x = select(w_is_longest, wx, select(v_is_longer, vx, ux));
  const Real y = select(w_is_longest, wy, select(v_is_longer, vy, uy));
  const Real z = select(w_is_longest, wz, select(v_is_longer, vz, uz));
  const auto is_determined = squared > 1e-26;
  const Real length = square_root(at_least(squared, 1e-150));

  // The two other roots add up to 1 - l3 and multiply to minors - l3 (1 - l3).
  const Real sum = 1.0 - l3;
  const Real root = square_root(at_least(Real(sum * sum - 4.0 * (minors - l3 * sum)), 0.0));
  const Real l1 = 0.5 * (sum + root), l2 = 0.5 * (sum - root);
  const Real zero = 0.0 * l3, one = zero + 1.0;
  return {select(is_determined, Real(x / length), zero), select(is_determined, Real(y / length), zero),
          select(is_determined, Real(z / length), one), at_most(at_least(Real((l2 - l3) / l1), 0.0), 1.0)};
}

}  // namespace vdbmap

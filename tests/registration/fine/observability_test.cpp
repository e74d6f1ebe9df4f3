// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/observability.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "tests/support/random_points.h"
#include "tests/support/synthetic_scene.h"

namespace vdbmap::registration {
namespace {

using test::Rectangle;
using test::Scene;

// Exact matches of points on the surfaces, as many on each, with the plane's point in the middle of the surface.
struct Matches {
  std::vector<PlaneMatch> matches;
  std::vector<double> weights;
  Eigen::Isometry3d map_from_scan;
};

Matches exact_matches(const Scene& scene, std::size_t count_each, const Eigen::Isometry3d& map_from_scan) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  Matches result{{}, {}, map_from_scan};
  for (const Rectangle& surface : scene) {
    for (std::size_t i = 0; i < count_each; ++i) {
      const double a = share(random);
      const double b = share(random);
      const Eigen::Vector3d point = surface.corner + a * surface.edge_a + b * surface.edge_b;
      const Eigen::Vector3d middle = surface.corner + 0.5 * (surface.edge_a + surface.edge_b);
      result.matches.push_back({map_from_scan.inverse() * point, middle, surface.normal(), 1.0});
      result.weights.push_back(0.3 + 0.7 * share(random));
    }
  }
  return result;
}

std::vector<UnobservableDirection> unobservable(const Scene& scene, const Eigen::Isometry3d& map_from_scan) {
  const Matches exact = exact_matches(scene, 200, map_from_scan);
  return unobservable_directions(exact.matches, exact.weights, map_from_scan);
}

Eigen::Isometry3d inside() {
  return Eigen::Translation3d(0.7, -0.4, 1.3) * Eigen::AngleAxisd(0.6, Eigen::Vector3d(1, 2, 9).normalized());
}

// Standard deviations of the guesses that fine registration accepts: 2 m and 10 degrees.
Matrix6d covariance_of_guesses() {
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(std::pow(10 * EIGEN_PI / 180, 2)), Eigen::Vector3d::Constant(4);
  return variances.asDiagonal();
}

TEST(Observability, AClosedRoomHoldsTheScan) { EXPECT_TRUE(unobservable(test::room(), inside()).empty()); }

TEST(Observability, ACorridorDoesNotHoldTheScanAlongIt) {
  const auto directions = unobservable(test::corridor(), inside());
  ASSERT_EQ(directions.size(), 1U);
  EXPECT_NEAR(std::abs(directions[0].motion[3]), 1, 1e-9);
  EXPECT_NEAR(directions[0].motion.norm(), 1, 1e-12);
  EXPECT_EQ(directions[0].description.find("translation along ("), 0U) << directions[0].description;
  EXPECT_NE(directions[0].description.find("1.00, "), std::string::npos) << directions[0].description;
}

TEST(Observability, ATurnedCorridorIsNamedInTheAxesOfTheMap) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Scene turned = test::corridor();
  for (Rectangle& side : turned) side = {turn * side.corner, turn * side.edge_a, turn * side.edge_b};
  const auto directions = unobservable(turned, inside());
  ASSERT_EQ(directions.size(), 1U);
  EXPECT_NEAR(std::abs(directions[0].motion.tail<3>().dot(turn.col(0))), 1, 1e-9);
}

TEST(Observability, APlaneAloneLeavesThreeDirectionsOpen) {
  const auto directions = unobservable({{{-20, -20, 0}, {40, 0, 0}, {0, 40, 0}}}, inside());
  ASSERT_EQ(directions.size(), 3U);
  for (const UnobservableDirection& direction : directions) {
    EXPECT_NEAR(direction.motion.segment<2>(0).norm(), 0, 1e-6);  // no tilt is open
    EXPECT_NEAR(direction.motion[5], 0, 1e-6);                    // nor the height
  }
}

TEST(Observability, ARoundRoomDoesNotHoldTheHeading) {
  Scene scene;
  constexpr int kSides = 200;  // seen from the axis every side of them is at a right angle
  for (int i = 0; i < kSides; ++i) {
    const Eigen::AngleAxisd turn(2 * EIGEN_PI * i / kSides, Eigen::Vector3d::UnitZ());
    scene.push_back({turn * Eigen::Vector3d(5, -0.08, 0), turn * Eigen::Vector3d(0, 0.16, 0), {0, 0, 3}});
  }
  scene.push_back({{-4, -4, 0}, {8, 0, 0}, {0, 8, 0}});
  const Matches exact = exact_matches(scene, 20, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1.5)));
  const auto directions = unobservable_directions(exact.matches, exact.weights, exact.map_from_scan);
  // One of 201 surfaces is the floor; its share of the weights, 0.07 of root mean square, still holds the height.
  ASSERT_EQ(directions.size(), 1U);
  EXPECT_GT(std::abs(directions[0].motion[2]), 0.999);
  EXPECT_EQ(directions[0].description.find("rotation about"), 0U) << directions[0].description;
}

TEST(Observability, NothingMatchedLeavesAllSixDirectionsOpen) {
  EXPECT_EQ(unobservable_directions({}, {}, inside()).size(), 6U);
}

TEST(MotionCovariance, IsThatOfTheGuessesWhereNothingIsMatched) {
  EXPECT_TRUE(motion_covariance({}, {}, inside()).isApprox(covariance_of_guesses(), 1e-3));
}

// Moves every point off its plane by normal noise of `sigma`, ten times as much on every third surface.
Matches with_noise(Matches exact, double sigma, std::size_t count_each, std::mt19937& random) {
  std::normal_distribution<double> normal(0, sigma);
  for (std::size_t i = 0; i < exact.matches.size(); ++i) {
    const double scale = i / count_each % 3 == 0 ? 10 : 1;
    PlaneMatch& match = exact.matches[i];
    match.point += exact.map_from_scan.linear().transpose() * (scale * normal(random) * match.normal);
  }
  return exact;
}

// The motion that fits the points to their planes best.
Vector6d solved(const Matches& noisy) {
  const PlaneResiduals residuals(noisy.matches, noisy.weights, noisy.map_from_scan);
  Vector6d motion = Vector6d::Zero();
  for (int i = 0; i < 4; ++i) {
    Eigen::VectorXd values(residuals.NumResiduals());
    Eigen::Matrix<double, Eigen::Dynamic, 6> jacobian(residuals.NumResiduals(), 6);
    residuals(motion.data(), values.data(), jacobian.data());
    motion -= Matrix6d(jacobian.transpose() * jacobian).ldlt().solve(Vector6d(jacobian.transpose() * values));
  }
  return motion;
}

TEST(MotionCovariance, AgreesWithMonteCarloForUnequalNoise) {
  constexpr std::size_t kCountEach = 60;
  constexpr int kTrials = 400;
  const Matches exact = exact_matches(test::room(), kCountEach, inside());
  std::mt19937 random(2);
  double chi_squared = 0;
  Matrix6d sum_of_squares = Matrix6d::Zero();
  Matrix6d sum_of_covariances = Matrix6d::Zero();
  for (int i = 0; i < kTrials; ++i) {
    const Matches noisy = with_noise(exact, 0.005, kCountEach, random);
    const Vector6d error = solved(noisy);
    const Matrix6d covariance = motion_covariance(noisy.matches, noisy.weights, moved_by(noisy.map_from_scan, error));
    chi_squared += error.dot(covariance.ldlt().solve(error));
    sum_of_squares += error * error.transpose();
    sum_of_covariances += covariance;
  }
  // 2400 degrees of freedom: standard deviation sqrt(4800) = 69. Four of them, and 2 % since residuals of fitted
  // planes are that much too small.
  EXPECT_NEAR(chi_squared, 6 * kTrials, 4 * 69 + 0.02 * 6 * kTrials);
  for (int i = 0; i < 6; ++i) {
    // A variance of 400 samples is known to sqrt(2 / 400) = 7 %; four times that.
    EXPECT_NEAR(sum_of_covariances(i, i) / sum_of_squares(i, i), 1, 0.28) << i;
  }
}

// Moves the points of each of 36 sectors off their planes together, and each a little by itself.
Matches with_noise_of_sectors(Matches exact, double sigma, std::mt19937& random) {
  std::normal_distribution<double> normal(0, sigma);
  std::array<double, 36> of_sector;
  for (double& offset : of_sector) offset = normal(random);
  for (PlaneMatch& match : exact.matches) {
    const double turn = std::atan2(match.point.y(), match.point.x()) / (2 * std::numbers::pi) + 0.5;
    const double offset = of_sector[std::min(static_cast<std::size_t>(turn * 36), std::size_t{35})];
    match.point += exact.map_from_scan.linear().transpose() * ((offset + 0.1 * normal(random)) * match.normal);
  }
  return exact;
}

TEST(MotionCovariance, CountsErrorsThatBelongTogetherAsOne) {
  constexpr int kTrials = 200;
  const Matches exact = exact_matches(test::room(), 300, inside());
  std::mt19937 random(5);
  double chi_squared = 0;
  for (int i = 0; i < kTrials; ++i) {
    const Matches noisy = with_noise_of_sectors(exact, 0.005, random);
    const Vector6d error = solved(noisy);
    const Matrix6d covariance = motion_covariance(noisy.matches, noisy.weights, moved_by(noisy.map_from_scan, error));
    chi_squared += error.dot(covariance.ldlt().solve(error));
  }
  // Taken one by one, some fifty points a sector would make it fifty times 6. Of 36 sums it is known roughly only.
  EXPECT_LT(chi_squared / kTrials, 2 * 6);
  EXPECT_GT(chi_squared / kTrials, 0.4 * 6);
}

TEST(MotionCovariance, IsThatOfTheGuessesAlongACorridor) {
  constexpr std::size_t kCountEach = 100;
  std::mt19937 random(3);
  const Matches noisy = with_noise(exact_matches(test::corridor(), kCountEach, inside()), 0.005, kCountEach, random);
  const Matrix6d covariance = motion_covariance(noisy.matches, noisy.weights, noisy.map_from_scan);
  EXPECT_NEAR(std::sqrt(covariance(3, 3)), 2, 0.01);  // along
  EXPECT_LT(std::sqrt(covariance(4, 4)), 0.02);       // across
  EXPECT_LT(std::sqrt(covariance(5, 5)), 0.02);       // up
  EXPECT_TRUE(covariance.isApprox(covariance.transpose()));
  EXPECT_GT(covariance.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0);
}

}  // namespace
}  // namespace vdbmap::registration

// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the covariance that align_scan() states is that of its errors.
#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "registration/fine/point_to_plane.h"
#include "tests/support/random_points.h"
#include "tests/support/synthetic_scene.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap::registration {
namespace {

struct NoisyPlace {
  std::string name;
  test::Scene scene;
  double points_per_square_metre;
  double map_noise;   // [m] on each axis
  double scan_noise;  // [m] along the ray
};

std::ostream& operator<<(std::ostream& stream, const NoisyPlace& place) { return stream << place.name; }

VoxelMap noisy_map(const NoisyPlace& place, unsigned seed) {
  PointCloud cloud = test::sample_scene(place.scene, place.points_per_square_metre, seed);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, place.map_noise);
  for (Eigen::Vector3d& point : cloud.positions) point += test::vector_of([&] { return noise(random); });
  return build_map(cloud);
}

Eigen::Isometry3d random_pose(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const Eigen::Vector3d shares = test::vector_of([&] { return unit(random); });
  const Eigen::Translation3d place(1.5 * shares.x(), 0.8 * shares.y(), 1.5 + 0.3 * shares.z());
  return place * Eigen::AngleAxisd(3 * unit(random), Eigen::Vector3d(0.02, -0.01, 1).normalized());
}

Vector6d random_motion(double rotation, double translation, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Vector6d motion;
  for (int i = 0; i < 6; ++i) motion[i] = (i < 3 ? rotation : translation) * unit(random);
  return motion;
}

Vector6d error_of(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth) {
  const Eigen::AngleAxisd turn(estimate.linear() * truth.linear().transpose());
  Vector6d error;
  error << turn.angle() * turn.axis(), estimate.translation() - truth.translation();
  return error;
}

class HonestCovariance : public testing::TestWithParam<NoisyPlace> {};

TEST_P(HonestCovariance, NormalizedErrorsStayWithinTheir95PercentBounds) {
  constexpr unsigned kTrials = 24;
  const NoisyPlace place = GetParam();
  std::mt19937 random(1234);  // other maps, scans and poses than those the systematic part was estimated from
  double squared_error = 0;
  for (unsigned trial = 0; trial < kTrials; ++trial) {
    // A map each: scans in one map share its errors, which the bounds do not allow for.
    const VoxelMap map = noisy_map(place, 7000 + trial);
    const Eigen::Isometry3d truth = random_pose(random);
    const test::Scanner scanner{.range_noise = place.scan_noise, .seed = 9000 + trial};
    const Eigen::Isometry3d guess = moved_by(truth, random_motion(0.01, 0.1, random));
    const FineResult result = align_scan(test::scan_scene(place.scene, truth, scanner), map, guess);
    const Vector6d error = error_of(result.map_from_scan, truth);
    squared_error += error.dot(result.covariance.ldlt().solve(error));
  }
  // Chi-squared of 6 degrees of freedom a scan; so many are normally distributed.
  constexpr double kDegrees = 6.0 * kTrials;
  EXPECT_NEAR(squared_error, kDegrees, 1.96 * std::sqrt(2 * kDegrees));
}

INSTANTIATE_TEST_SUITE_P(Places, HonestCovariance,
                         testing::Values(NoisyPlace{"room", test::room(), 500, 0.01, 0.01},
                                         NoisyPlace{"room of much noise", test::room(), 500, 0.02, 0.03},
                                         NoisyPlace{"street", test::street(), 300, 0.01, 0.02},
                                         NoisyPlace{"street of much noise", test::street(), 300, 0.02, 0.03}));

}  // namespace
}  // namespace vdbmap::registration

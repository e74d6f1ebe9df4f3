// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_record.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"
#include "vdbmap/core/srgb.h"

namespace vdbmap {
namespace {

constexpr double kSize = 0.1;  // [m]
constexpr double kDegPerRad = 180 / 3.14159265358979323846;

Eigen::Vector3d stored(const Eigen::Vector3d& normal) {
  VoxelRecord record;
  set_normal(record, normal);
  return normal_of(record);
}

double angle_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * kDegPerRad;
}

TEST(VoxelRecord, KeepsAMeanToHalfAStep) {
  const VoxelIndex voxel(-3, 1'000'000, 0);
  const Eigen::Vector3d corner = corner_of_voxel(voxel, kSize);
  const Eigen::AlignedBox3d box(corner, corner + Eigen::Vector3d::Constant(kSize));
  const double half_step = kSize / kMeanSteps / 2 + 1e-10;  // and the rounding of 100 km
  for (const Eigen::Vector3d& mean : test::random_points(10'000, box, 1)) {
    VoxelRecord record;
    set_moments(record, {.count = 1, .mean = mean}, voxel, kSize);
    EXPECT_LT((mean_of(record, voxel, kSize) - mean).cwiseAbs().maxCoeff(), half_step);
  }
}

TEST(VoxelRecord, KeepsAMeanWithinItsVoxel) {
  const VoxelIndex voxel(-1, 0, 5);
  for (const double outside : {-1.0, -1e-9, 0.0, kSize, kSize + 1e-9, 1.0}) {
    VoxelRecord record;
    const Eigen::Vector3d mean = corner_of_voxel(voxel, kSize) + Eigen::Vector3d::Constant(outside);
    set_moments(record, {.count = 1, .mean = mean}, voxel, kSize);
    EXPECT_EQ(voxel_of_point(mean_of(record, voxel, kSize), 10), voxel) << outside;
  }
}

TEST(VoxelRecord, KeepsMomentsThroughSetAndGet) {
  const VoxelIndex voxel(2, -2, 7);
  Moments moments;
  moments.count = 9;
  moments.mean = center_of_voxel(voxel, kSize);
  moments.scatter << 8, 1, 2, 1, 16, 3, 2, 3, 24;
  moments.scatter *= 1e-4;
  VoxelRecord record;
  set_moments(record, moments, voxel, kSize);

  const Moments kept = moments_of(record, voxel, kSize);
  EXPECT_EQ(kept.count, 9);
  EXPECT_TRUE(kept.scatter.isApprox(moments.scatter, 0x1p-8));  // 8 bits
  EXPECT_TRUE(covariance_of(record).isApprox(moments.scatter / 8, 0x1p-8));
  EXPECT_EQ(covariance_of(record), covariance_of(record).transpose());
}

TEST(VoxelRecord, OfOnePointOrNoneHasNoScatter) {
  VoxelRecord record;
  EXPECT_EQ(moments_of(record, {0, 0, 0}, kSize).scatter, Eigen::Matrix3d::Zero());
  set_moments(record, {.count = 1, .mean = {0.05, 0.05, 0.05}}, {0, 0, 0}, kSize);
  EXPECT_EQ(moments_of(record, {0, 0, 0}, kSize).scatter, Eigen::Matrix3d::Zero());
}

TEST(VoxelRecord, CountsEndAtTheFilesLargestNumber) {
  VoxelRecord record;
  set_moments(record, {.count = std::int64_t{1} << 40}, {0, 0, 0}, kSize);
  EXPECT_EQ(record.count, 2'147'483'647U);
}

// Whether all significant bits of a value are among the first `bits`.
bool fits(double value, int bits) {
  int exponent = 0;
  const double whole = std::ldexp(std::frexp(value, &exponent), bits);
  return whole == std::round(whole);
}

struct CovarianceRounding {
  std::int64_t count;
  int bits;
};

class RoundedCovariance : public testing::TestWithParam<CovarianceRounding> {};

TEST_P(RoundedCovariance, IsTheNearestOfItsBits) {
  const auto [count, bits] = GetParam();
  std::mt19937 random(2);
  std::uniform_real_distribution<double> exponent(-10, 1);
  double worst = 0;
  for (int i = 0; i < 100'000; ++i) {
    const double value = (i % 2 == 0 ? 1 : -1) * std::pow(10, exponent(random));
    const double rounded = round_covariance(value, count);
    worst = std::max(worst, std::abs(rounded - value) / std::abs(value));
    EXPECT_TRUE(fits(rounded, bits)) << rounded;
  }
  // Half a step of the last bit, and the rounding to float before it.
  EXPECT_LT(worst, std::ldexp(1, -bits) + 0x1p-24);
  EXPECT_GT(worst, std::ldexp(1, -bits - 1));
}

INSTANTIATE_TEST_SUITE_P(FewAndManyPoints, RoundedCovariance,
                         testing::Values(CovarianceRounding{2, 8}, CovarianceRounding{256, 8},
                                         CovarianceRounding{257, 16}, CovarianceRounding{std::int64_t{1} << 40, 16}));

TEST(VoxelRecord, RoundingACovarianceKeepsZeroAndSign) {
  for (const std::int64_t count : {2, 1000}) {
    EXPECT_EQ(round_covariance(0, count), 0);
    EXPECT_EQ(round_covariance(-0.25, count), -0.25f);
    EXPECT_EQ(round_covariance(0.25, count), 0.25f);
    EXPECT_EQ(round_covariance(1.9999999, count), 2.0f);  // carries into the exponent
  }
}

TEST(VoxelRecord, KeepsNormalsToTwoThirdsOfADegreeInAllDirections) {
  std::mt19937 random(3);
  double worst = 0;
  for (int i = 0; i < 200'000; ++i) {
    const Eigen::Vector3d normal = test::random_direction(random);
    const Eigen::Vector3d kept = stored(normal);
    EXPECT_NEAR(kept.norm(), 1, 1e-6);  // float
    worst = std::max(worst, angle_deg(kept, normal));
  }
  EXPECT_LT(worst, 0.65);  // corners of the hexagons that share a code: sqrt(2 / 3) * sqrt(3) / 126 rad
}

TEST(VoxelRecord, KeepsNormalsWithoutBias) {
  std::mt19937 random(4);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d sum_of_magnitudes = Eigen::Vector3d::Zero();
  constexpr int kCount = 200'000;
  for (int i = 0; i < kCount; ++i) {
    const Eigen::Vector3d normal = test::random_direction(random);
    const Eigen::Vector3d kept = stored(normal);
    sum += kept - normal;
    sum_of_magnitudes += kept.cwiseAbs() - normal.cwiseAbs();
  }
  // Errors of up to 0.7 degrees, 0.004 rms, average out to 0.004 / sqrt(200,000) = 1e-5; four times that at most.
  // Rounding down instead, as OpenVDB's own pack() does, shows as 3e-3 towards z.
  EXPECT_LT(sum.cwiseAbs().maxCoeff() / kCount, 4e-5);
  EXPECT_LT(sum_of_magnitudes.cwiseAbs().maxCoeff() / kCount, 2e-4);  // second order of the error's square
}

TEST(VoxelRecord, KeepsTheNormalsOfTheAxesExactly) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const Eigen::Vector3d normal = sign * Eigen::Vector3d::Unit(axis);
      EXPECT_TRUE(stored(normal).isApprox(normal, 1e-6)) << normal.transpose();
    }
  }
}

TEST(VoxelRecord, KeepsNormalsOnTheSeamsOfTheCode) {
  // |x| + |y| is all of it, where rounding both up would leave the code.
  for (int i = 0; i <= 2000; ++i) {
    const double angle = i * 3.14159265358979323846 / 1000;
    const Eigen::Vector3d normal(std::cos(angle), std::sin(angle), 0);
    EXPECT_LT(angle_deg(stored(normal), normal), 0.7) << angle;
  }
}

TEST(VoxelRecord, WhatIsNoDirectionPointsUp) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& none :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(nan, 0, 1), Eigen::Vector3d(0, infinity, 0)}) {
    VoxelRecord record;
    set_normal(record, {1, 0, 0});
    set_normal(record, none);
    EXPECT_EQ(normal_of(record), Eigen::Vector3d::UnitZ()) << none.transpose();
  }
}

TEST(VoxelRecord, KeepsColorsToEightBitsAndClampsTheRest) {
  const Eigen::AlignedBox3d unit(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones());
  for (const Eigen::Vector3d& color : test::random_points(1000, unit, 5)) {
    VoxelRecord record;
    set_color(record, color);
    const Eigen::Array3d error = (color_of(record) - color).array().abs();
    EXPECT_TRUE((error <= (0x1p-8 + 0x1p-24) * color.array()).all()) << color.transpose();
  }
  VoxelRecord record;
  set_color(record, {-0.5, 1.5, 1});
  EXPECT_EQ(color_of(record), Eigen::Vector3d(0, 1, 1));
  set_color(record, {std::nan(""), -0.0, 0.5});
  EXPECT_EQ(record.color_code, (std::array<std::uint16_t, 3>{0, 0, 0x3f00}));
}

TEST(VoxelRecord, KeepsEveryColorOfEightBitsInSrgb) {
  for (int level = 0; level <= 255; ++level) {
    VoxelRecord record;
    set_color(record, Eigen::Vector3d::Constant(linear_from_srgb(static_cast<std::uint16_t>(257 * level)) / 65535.0));
    const double linear = color_of(record).x();
    const double srgb = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    EXPECT_EQ(std::lround(255 * srgb), level);
  }
}

}  // namespace
}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/camera.h"

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"

namespace vdbmap {
namespace {

const ImageSize kSize{400, 300};

TEST(Camera, PointsAreOnTheRayOfTheirPixel) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0, 300);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Isometry3d pose = test::random_motion(20, 50, random);
    for (const Camera& camera : {Camera::perspective(pose, 70, kSize), Camera::orthographic(pose, 30, kSize)}) {
      const Eigen::Vector2d pixel(place(random), place(random));
      const Ray ray = camera.ray_through(pixel);
      EXPECT_NEAR(ray.direction.norm(), 1, 1e-12);
      const auto seen = camera.project(ray.origin + 7 * ray.direction);
      ASSERT_TRUE(seen.has_value());
      EXPECT_NEAR((seen->pixel - pixel).norm(), 0, 1e-9);
    }
  }
}

TEST(Camera, TheEdgesOfThePictureAreHalfTheFieldOfViewOff) {
  const Camera camera = Camera::perspective(map_from_camera_at({1, 2, 3}, 0, 0), 60, kSize);
  const Eigen::Vector3d left = camera.ray_through({0, 150}).direction;
  EXPECT_NEAR(std::acos(left.x()) * 180 / std::numbers::pi, 30, 1e-9);
  EXPECT_GT(left.y(), 0);  // a view along +x has +y on its left
}

TEST(Camera, HeadingTurnsLeftAndElevationUp) {
  const Eigen::Vector3d forward = map_from_camera_at({0, 0, 0}, 90, 30).linear().col(2);
  EXPECT_TRUE(forward.isApprox(Eigen::Vector3d(0, std::sqrt(0.75), 0.5), 1e-12));
  const Eigen::Matrix3d axes = map_from_camera_at({0, 0, 0}, 33, -20).linear();
  EXPECT_NEAR(axes.determinant(), 1, 1e-12);
  EXPECT_NEAR(axes(2, 0), 0, 1e-15);  // the horizon is level
  EXPECT_LT(axes(2, 1), 0);           // and down is down
}

TEST(Camera, APixelOfAPlanIsItsShareOfTheWidth) {
  const Camera camera = Camera::orthographic(map_from_camera_at({10, 20, 50}, 90, -90), 40, kSize);
  EXPECT_DOUBLE_EQ(camera.pixel_width(), 0.1);
  EXPECT_NEAR((camera.project({10, 20, 0})->pixel - Eigen::Vector2d(200, 150)).norm(), 0, 1e-9);
  EXPECT_NEAR((camera.project({11, 22, 5})->pixel - Eigen::Vector2d(210, 130)).norm(), 0, 1e-9);  // north is up
}

TEST(Camera, WhatIsBehindAPinholeIsNotSeen) {
  const Camera camera = Camera::perspective(map_from_camera_at({0, 0, 0}, 0, 0), 60, kSize);
  EXPECT_FALSE(camera.project({-1, 0, 0}).has_value());
  EXPECT_FALSE(camera.project({0, 0, 0}).has_value());
}

// Whatever box: where one of its points appears, it may be seen; boxes behind a pinhole and far to its sides are not.
TEST(Camera, MaySeeEveryBoxOfWhichAPointAppears) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> number(-1, 1);
  const auto vector = [&] { return Eigen::Vector3d(number(random), number(random), number(random)); };
  const Eigen::Isometry3d eye = map_from_camera_at({3, -2, 5}, 30, -10);
  int num_hidden = 0;
  for (const Camera& camera : {Camera::perspective(eye, 60, {200, 100}), Camera::orthographic(eye, 40, {200, 100})}) {
    for (int i = 0; i < 2000; ++i) {
      Eigen::AlignedBox3d box(Eigen::Vector3d(100 * vector()));
      box.extend(box.min() + 10 * vector());
      bool appears = false;
      for (int j = 0; j < 20; ++j) {
        const Eigen::Vector3d share = (Eigen::Vector3d::Ones() + vector()) / 2;
        const auto point = camera.project(box.min() + share.cwiseProduct(box.sizes()));
        appears |= point && point->pixel.x() >= 0 && point->pixel.x() <= 200 && point->pixel.y() >= 0 &&
                   point->pixel.y() <= 100;
      }
      EXPECT_TRUE(camera.may_see(box) || !appears);
      num_hidden += camera.may_see(box) ? 0 : 1;
    }
  }
  EXPECT_GT(num_hidden, 2000);  // of 4000: the pictures show far less than half of all that is around
}

TEST(Camera, ImpossibleCamerasAreRefused) {
  const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (const double bad : {0.0, -1.0, 171.0, std::nan("")}) {
    EXPECT_THROW(Camera::perspective(pose, bad, kSize), std::invalid_argument);
  }
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(Camera::orthographic(pose, bad, kSize), std::invalid_argument);
  }
  EXPECT_THROW(Camera::perspective(pose, 60, {0, 100}), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap

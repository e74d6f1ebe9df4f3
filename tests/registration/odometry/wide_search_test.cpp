// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/wide_search.h"

#include <gtest/gtest.h>

#include "registration/fine/scan_sample.h"
#include "tests/support/pose_distance.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/threads.h"

namespace vdbmap::registration {
namespace {

class WideSearch : public testing::Test {
 protected:
  WideSearch() {
    map_.insert(test::sample_scene(test::street(), 60, 1).positions);
    points_ = sample_points(test::scan_scene(test::street(), map_from_scan_).positions, 1.5, {1, 100});
  }

  PointToPointResult search(const Eigen::Isometry3d& guess) const {
    PointToPointOptions alignment;
    alignment.limits = {3, 1.0 / 3, 0.5};
    return search_widely(points_, map_, guess, alignment);
  }

  Eigen::Isometry3d off(double x, double y, double turn_deg) const {
    Eigen::Isometry3d guess = map_from_scan_;
    guess.translation() += Eigen::Vector3d(x, y, 0);
    guess.rotate(Eigen::AngleAxisd(turn_deg * EIGEN_PI / 180, Eigen::Vector3d::UnitZ()));
    return guess;
  }

  Eigen::Isometry3d map_from_scan_ = Eigen::Isometry3d(Eigen::Translation3d(2.3, -0.6, 1.7));
  LocalMap map_{LocalMapOptions{}};
  std::vector<Eigen::Vector3d> points_;
};

TEST_F(WideSearch, FindsAScanManyMetresFromTheGuess) {
  for (const Eigen::Isometry3d& guess : {off(11.4, 1.2, 0), off(-7.7, -2.5, 14), off(0.2, 5.6, -20)}) {
    const PointToPointResult found = search(guess);
    const test::PoseDistance error = test::distance_between(found.map_from_scan, map_from_scan_);
    EXPECT_LT(error.translation, 0.05);
    EXPECT_LT(error.rotation_deg, 0.3);
    EXPECT_EQ(found.matches.num_inliers, points_.size());
  }
}

TEST_F(WideSearch, FindsNothingOutsideTheMap) {
  const PointToPointResult found = search(off(5000, 0, 0));
  EXPECT_EQ(found.matches.num_inliers, 0U);
  EXPECT_EQ(found.map_from_scan.matrix(), off(5000, 0, 0).matrix());
}

TEST_F(WideSearch, IsTheSameForAnyNumberOfThreads) {
  const auto found = [&] { return search(off(6, 2, 5)).map_from_scan.matrix().eval(); };
  EXPECT_EQ(test::on_threads(1, found), test::on_threads(4, found));
}

}  // namespace
}  // namespace vdbmap::registration

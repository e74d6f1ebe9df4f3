// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/evidence.h"

#include <gtest/gtest.h>

#include "registration/fine/scan_sample.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/threads.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap::registration {
namespace {

struct Case {
  VoxelMap map = build_map(test::sample_scene(test::street(), 150, 1));
  Eigen::Isometry3d map_from_scan{Eigen::Translation3d(-10, 0.5, 1.8)};
  std::vector<Eigen::Vector3d> points =
      sample_points(test::scan_scene(test::street(), map_from_scan).positions, 0.5, {});
  std::vector<MeasuredRay> rays;

  Case() {
    for (const Eigen::Vector3d& point : points) rays.push_back({Eigen::Vector3d::Zero(), point});
  }
};

TEST(Evidence, SpeaksForTheTruePose) {
  const Case c;
  const Evidence evidence = weigh(c.points, c.rays, c.map, c.map_from_scan);
  EXPECT_EQ(evidence.num_points, c.points.size());
  EXPECT_EQ(evidence.overlap, 1);
  EXPECT_GT(evidence.on_surface_share, 0.9);  // edges of boxes are not flat
  EXPECT_LT(evidence.blocked_share, 0.02);    // voxels stand out by up to 10 cm at corners
}

TEST(Evidence, SpeaksAgainstAPoseBeyondTheFacade) {
  const Case c;
  Eigen::Isometry3d beyond = c.map_from_scan;
  beyond.translation().y() += 12;
  const Evidence evidence = weigh(c.points, c.rays, c.map, beyond);
  EXPECT_GT(evidence.blocked_share, 0.2);
  EXPECT_LT(evidence.explained_share(), 0.5 * weigh(c.points, c.rays, c.map, c.map_from_scan).explained_share());
}

// Ground and facades fit wherever one stands along the street; what counts is what stands across.
TEST(SurfaceAgreement, NoticesAShiftThatGroundAndFacadesAllow) {
  const Case c;
  const std::vector<SurfacePiece> pieces = flat_pieces(c.map.coarsest());
  Eigen::Isometry3d shifted = Eigen::Isometry3d::Identity();
  EXPECT_GT(surface_agreement(pieces, c.map, shifted), 0.99);
  shifted.translation().x() = 3;
  EXPECT_LT(surface_agreement(pieces, c.map, shifted), 0.75);
  EXPECT_GT(surface_agreement(pieces, c.map, shifted), 0.5);  // two directions of three
}

TEST(SurfaceAgreement, CountsThreeDirectionsAlike) {
  // Much floor, little wall: the floor fits, the walls do not.
  const VoxelMap map = build_map(test::sample_scene(test::box({0, 0, 0}, {20, 20, 4}), 200, 1));
  std::vector<SurfacePiece> pieces;
  for (int x = 2; x < 18; ++x) {
    for (int y = 2; y < 18; ++y) pieces.push_back({{x + 0.5, y + 0.5, 0}, Eigen::Vector3d::UnitZ()});
  }
  for (int z = 1; z < 3; ++z) {
    pieces.push_back({{0.5, 10.5, z + 0.5}, Eigen::Vector3d::UnitX()});
    pieces.push_back({{10.5, 0.5, z + 0.5}, Eigen::Vector3d::UnitY()});
  }
  EXPECT_NEAR(surface_agreement(pieces, map, Eigen::Isometry3d::Identity()), 1.0 / 3, 0.05);
}

TEST(SurfaceAgreement, OfNothingIsNone) {
  const Case c;
  EXPECT_EQ(surface_agreement({}, c.map, c.map_from_scan), 0);
}

TEST(Evidence, ARayThroughAWallIsBlockedAndOneBeforeItIsNot) {
  const VoxelMap map = build_map(test::sample_scene({{{5, -5, 0}, {0, 10, 0}, {0, 0, 4}}}, 400, 1));
  const auto blocked = [&](const MeasuredRay& ray) {
    return weigh({}, std::vector{ray}, map, Eigen::Isometry3d::Identity()).blocked_share;
  };
  EXPECT_EQ(blocked({{0, 0, 2}, {9, 0.3, 2.2}}), 1);
  EXPECT_EQ(blocked({{0, 0, 2}, {5, 0.3, 2.2}}), 0);  // ends on it
  EXPECT_EQ(blocked({{0, 0, 2}, {9, 0.3, 12}}), 0);   // passes above it
  EXPECT_EQ(blocked({{0, 0, 2}, {0, 0, 2}}), 0);      // of no length
}

TEST(Evidence, OutsideTheMapIsNone) {
  const Case c;
  Eigen::Isometry3d far = c.map_from_scan;
  far.translation().x() += 1e9;
  const Evidence evidence = weigh(c.points, c.rays, c.map, far);
  EXPECT_EQ(evidence.overlap, 0);
  EXPECT_EQ(evidence.explained_share(), 0);
  EXPECT_EQ(weigh({}, {}, c.map, c.map_from_scan).explained_share(), 0);
}

TEST(Evidence, DoesNotDependOnTheNumberOfThreads) {
  const Case c;
  const auto weighed = [&] { return weigh(c.points, c.rays, c.map, c.map_from_scan); };
  EXPECT_EQ(test::on_threads(1, weighed).explained_share(), test::on_threads(4, weighed).explained_share());
}

}  // namespace
}  // namespace vdbmap::registration

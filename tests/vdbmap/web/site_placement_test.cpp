// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/site_placement.h"

#include <gtest/gtest.h>

#include "tests/support/sample_maps.h"

namespace vdbmap {
namespace {

constexpr double kMillimetre = 1e-3;

// How far the affine map of a box is from PROJ: at its corners, and in its middle.
double error_at_corners(const SitePlacement& placement, const Eigen::AlignedBox3d& box) {
  const Eigen::Affine3d world_from_local = placement.world_from_local(box);
  double error = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d point = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
    error = std::max(error, (world_from_local * point - placement.world_of(point)).norm());
  }
  return error;
}

TEST(SitePlacement, MeetsTheCornersOfTilesToAMillimetre) {
  // Zones far from their central meridian and in the north are the worst: the projection is curved most there.
  struct Place {
    int epsg;
    Eigen::Vector3d anchor;
  };
  for (const Place& place : {Place{25832, test::kUtm}, Place{25832, {256'000, 5'248'000, 0}},
                             Place{25833, {768'000, 7'680'000, 0}}, Place{3857, {1'082'368, 6'868'992, 0}}}) {
    const SitePlacement placement({place.anchor, place.epsg}, 43);
    for (const double edge : {16.0, 32.0, 64.0, 128.0}) {
      const Eigen::AlignedBox3d box(Eigen::Vector3d(-edge, 3 * edge, 20), Eigen::Vector3d(0, 4 * edge, 60));
      EXPECT_LT(error_at_corners(placement, box), kMillimetre) << place.epsg << " " << edge;
    }
  }
}

TEST(SitePlacement, InsideOfATileTheEarthIsFlatToAMillimetre) {
  const SitePlacement placement({test::kUtm, 25832}, 43);
  const Eigen::AlignedBox3d box(Eigen::Vector3d(0, 0, 50), Eigen::Vector3d(128, 128, 70));
  const Eigen::Vector3d middle = box.center();
  // The sagitta of a chord of 181 m, the diagonal, is 0.64 mm.
  EXPECT_LT((placement.world_from_local(box) * middle - placement.world_of(middle)).norm(), kMillimetre);
}

TEST(SitePlacement, AddsTheGeoidOffsetToHeights) {
  const Eigen::Vector3d point(10, 20, 55);
  const Eigen::Vector3d low = SitePlacement({test::kUtm, 25832}, 0).world_of(point);
  const Eigen::Vector3d high = SitePlacement({test::kUtm, 25832}, 43.5).world_of(point);
  EXPECT_NEAR((high - low).norm(), 43.5, 1e-6);
  EXPECT_GT((high - low).dot(low), 0);
}

TEST(SitePlacement, WithoutAnEpsgCodeIsTheLocalFrame) {
  const SitePlacement placement({test::kUtm, std::nullopt}, 43);
  const Eigen::AlignedBox3d box(Eigen::Vector3d(0, 0, 50), Eigen::Vector3d(16, 16, 70));
  EXPECT_FALSE(placement.is_on_globe());
  EXPECT_EQ(placement.world_of({1, 2, 3}), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(placement.world_from_local(box).matrix(), Eigen::Matrix4d::Identity());
}

}  // namespace
}  // namespace vdbmap

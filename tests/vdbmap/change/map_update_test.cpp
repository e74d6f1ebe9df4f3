// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/change/map_update.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/sample_maps.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/threads.h"
#include "vdbmap/change/map_visibility.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap {
namespace {

const std::vector<Eigen::Vector3d> kSensor = {Eigen::Vector3d::Zero()};

test::Scene ground() { return {{{-15, -10, 0.03}, {40, 0, 0}, {0, 20, 0}}, {{-15, 8, 0}, {40, 0, 0}, {0, 0, 5}}}; }

test::Scene with(test::Scene scene, const test::Scene& more) {
  scene.insert(scene.end(), more.begin(), more.end());
  return scene;
}

test::Scene car_at(double x, double y) { return test::box({x, y, 0.25}, {x + 4, y + 1.8, 1.6}); }

// Scans from a straight way along x; what stands there may change from scan to scan.
struct Drive {
  std::vector<PointCloud> scans;
  std::vector<Eigen::Isometry3d> poses;
  std::vector<double> times;

  CloudSource source() const {
    return [this](const std::function<void(const PosedCloud&)>& take) {
      for (std::size_t i = 0; i < scans.size(); ++i) take({scans[i], poses[i], kSensor, times[i]});
    };
  }
};

Drive drive_through(int num_scans, const std::function<test::Scene(double seconds)>& scene_at, double speed = 5) {
  Drive drive;
  for (int i = 0; i < num_scans; ++i) {
    const double seconds = 0.1 * i;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Eigen::Vector3d(-8 + speed * seconds, 0.013 * i, 1.9);
    test::Scanner scanner{
        .num_beams = 48, .num_azimuths = 720, .min_elevation_deg = -24, .max_elevation_deg = 8, .range_noise = 0.01};
    scanner.seed = static_cast<unsigned>(i);
    drive.scans.push_back(test::scan_scene(scene_at(seconds), pose, scanner));
    drive.poses.push_back(pose);
    drive.times.push_back(seconds);
  }
  return drive;
}

UpdateOptions epoch_two() {
  UpdateOptions options;
  options.epoch = 2;
  return options;
}

VoxelMap map_of(const test::Scene& scene) {
  return build_map(test::sample_scene(scene, 2000, 4), test::anchored(Eigen::Vector3d::Zero()));
}

// Of the voxels in a box [m], how many a map has.
std::size_t count_in(const VoxelMap& map, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  std::size_t count = 0;
  for_each_voxel(map.finest(), [&](const VoxelIndex& voxel, std::size_t /*record*/) {
    const Eigen::Vector3d center = center_of_voxel(voxel, map.finest().voxel_size());
    count += (center.array() > low.array()).all() && (center.array() < high.array()).all();
  });
  return count;
}

// All of a car above the clearance that rays need over the road.
std::size_t voxels_of_car(const VoxelMap& map, double x, double y) {
  return count_in(map, {x - 0.15, y - 0.15, 0.5}, {x + 4.15, y + 1.95, 1.75});
}

// The side that the scanner's way passes, and the roof: what rays can have gone through.
std::size_t near_side_of_car(const VoxelMap& map, double x, double y) {
  return count_in(map, {x + 0.2, y - 0.15, 0.5}, {x + 3.8, y + 0.15, 1.5});
}

TEST(MapUpdate, ACarThatLeftIsGoneAndOneThatCameIsThere) {
  const VoxelMap before = map_of(with(ground(), car_at(0, 4)));
  const Drive drive = drive_through(40, [](double) { return with(ground(), car_at(6, -6)); });
  const UpdatedMap updated = update_map(before, std::nullopt, drive.source());

  const std::size_t was = near_side_of_car(before, 0, 4);
  ASSERT_GT(was, 200U);
  EXPECT_LT(near_side_of_car(updated.map, 0, 4), was / 50);
  EXPECT_EQ(voxels_of_car(before, 6, -6), 0U);
  EXPECT_GT(voxels_of_car(updated.map, 6, -6), 300U);
  EXPECT_GT(updated.counts.gone, was);
}

TEST(MapUpdate, WhatStaysIsKept) {
  const test::Scene scene = with(ground(), car_at(0, 4));
  const VoxelMap before = map_of(scene);
  const Drive drive = drive_through(40, [&](double) { return scene; });
  const UpdatedMap updated = update_map(before, std::nullopt, drive.source());
  EXPECT_LT(updated.counts.gone, before.finest().size() / 2000);
  EXPECT_LT(updated.counts.num_moved_points, updated.counts.num_points / 1000);
  EXPECT_GE(updated.map.finest().size(), before.finest().size() - updated.counts.gone);
}

TEST(MapUpdate, WhatNobodyCouldSeeStays) {
  // A wall hides the car from the whole way.
  const test::Scene wall = {{{-15, 3, 0}, {40, 0, 0}, {0, 0, 5}}};
  const VoxelMap before = map_of(with(ground(), car_at(0, 5)));
  const Drive drive = drive_through(20, [&](double) { return with(ground(), wall); });
  const UpdatedMap updated = update_map(before, std::nullopt, drive.source());
  EXPECT_EQ(voxels_of_car(updated.map, 0, 5), voxels_of_car(before, 0, 5));
}

TEST(MapUpdate, WhatMovesLeavesNoTrail) {
  const VoxelMap before = map_of(ground());
  const Drive drive = drive_through(40, [](double seconds) { return with(ground(), car_at(-4 + 8 * seconds, 3)); });
  const UpdatedMap updated = update_map(before, std::nullopt, drive.source());
  // Where it drove while it was seen and the place was seen again: x from -4 to 16.
  const std::size_t trail = count_in(updated.map, {-4, 2.8, 0.5}, {14, 5, 1.75});
  MapBuilder all(test::anchored(Eigen::Vector3d::Zero()));
  for (std::size_t i = 0; i < drive.scans.size(); ++i) all.add(drive.scans[i], drive.poses[i]);
  const std::size_t without_update = count_in(all.finish(), {-4, 2.8, 0.5}, {14, 5, 1.75});
  ASSERT_GT(without_update, 2000U);
  EXPECT_LT(trail, without_update / 33);
}

TEST(MapUpdate, AWallThatMovedReplacesTheOldOne) {
  const test::Scene old_wall = {{{-15, 5.04, 0}, {40, 0, 0}, {0, 0, 3}}};
  const test::Scene new_wall = {{{-15, 4.9, 0}, {40, 0, 0}, {0, 0, 3}}};  // 14 cm towards the scanner
  const VoxelMap before = map_of(with(ground(), old_wall));
  const Drive drive = drive_through(30, [&](double) { return with(ground(), new_wall); });
  const UpdatedMap updated = update_map(before, std::nullopt, drive.source());
  EXPECT_GT(count_in(updated.map, {-5, 4.8, 0.5}, {10, 4.99, 2.5}), 1000U);
}

TEST(MapUpdate, CutsOrderAndThreadsChangeNothing) {
  const VoxelMap before = map_of(with(ground(), car_at(0, 4)));
  const Drive drive = drive_through(12, [](double seconds) { return with(ground(), car_at(6 + 3 * seconds, -6)); });
  Drive halves;
  for (std::size_t i = drive.scans.size(); i-- > 0;) {
    const std::size_t half = drive.scans[i].size() / 2;
    for (const bool is_second : {true, false}) {
      PointCloud part;
      const auto begin = drive.scans[i].positions.begin();
      const auto middle = begin + static_cast<std::ptrdiff_t>(half);
      part.positions.assign(is_second ? middle : begin, is_second ? drive.scans[i].positions.end() : middle);
      halves.scans.push_back(std::move(part));
      halves.poses.push_back(drive.poses[i]);
      halves.times.push_back(drive.times[i]);
    }
  }
  const auto run = [&](const Drive& source, int threads) {
    return test::on_threads(threads, [&] { return update_map(before, std::nullopt, source.source(), epoch_two()); });
  };
  const UpdatedMap once = run(drive, 1);
  const UpdatedMap again = run(halves, 4);
  EXPECT_EQ(test::difference(once.map, again.map), "");
  EXPECT_EQ(once.visibility.hits, again.visibility.hits);
  EXPECT_EQ(once.visibility.passes, again.visibility.passes);
  ASSERT_EQ(once.visibility.seen_empty.leaves().size(), again.visibility.seen_empty.leaves().size());
}

TEST(MapUpdate, WhatADriveWithoutColorsFoundIsGrey) {
  PointCloud survey = test::sample_scene(ground(), 2000, 4);
  survey.colors.assign(survey.size(), {0, 0, 65535});
  const VoxelMap before = build_map(survey, test::anchored(Eigen::Vector3d::Zero()));
  const Drive drive = drive_through(10, [](double) { return with(ground(), car_at(0, 4)); });
  const UpdatedMap updated = update_map(before, std::nullopt, drive.source());
  const VoxelFinder old(before.finest());
  std::size_t num_grey = 0;
  for_each_voxel(updated.map.finest(), [&](const VoxelIndex& voxel, std::size_t record) {
    const Eigen::Vector3d color = color_of(updated.map.finest().records()[record]);
    const bool is_grey = (color - kUnknownColor).norm() < 0.01;
    const bool is_blue = color.z() > 0.99 && color.x() < 0.01;
    ASSERT_TRUE(is_blue || is_grey) << color.transpose();
    if (is_blue) {
      ASSERT_NE(old.find(voxel), nullptr);
    }
    num_grey += is_grey ? 1 : 0;
  });
  EXPECT_GT(num_grey, 300U);
}

TEST(MapUpdate, EpochsSayWhenEachPartWasSeen) {
  BuildOptions first = test::anchored(Eigen::Vector3d::Zero());
  first.epoch = 1;
  const VoxelMap before = build_map(test::sample_scene(with(ground(), car_at(0, 4)), 2000, 4), first);
  const Drive drive = drive_through(20, [](double) { return with(ground(), car_at(6, -6)); });
  const UpdatedMap updated = update_map(before, std::nullopt, drive.source(), epoch_two());
  const VoxelChannels& channels = updated.map.finest().channels();
  const auto is_old = [&](std::size_t i) { return channels.last_epochs[i] == 1; };
  const auto is_new = [&](std::size_t i) { return channels.first_epochs[i] == 2; };
  std::size_t num_old = 0;
  std::size_t num_new = 0;
  std::size_t num_both = 0;
  for (std::size_t i = 0; i < updated.map.finest().size(); ++i) {
    num_old += is_old(i);
    num_new += is_new(i);
    num_both += channels.first_epochs[i] == 1 && channels.last_epochs[i] == 2;
  }
  EXPECT_EQ(num_old, updated.counts.unseen);
  EXPECT_EQ(num_both, updated.counts.confirmed);
  EXPECT_EQ(num_new, updated.counts.added + updated.counts.replaced);
}

TEST(MapUpdate, FreeSpaceAddsUpAndOccupiedVoxelsAreNotInIt) {
  const test::Scene scene = with(ground(), car_at(0, 4));
  const VoxelMap before = map_of(scene);
  const Drive first = drive_through(10, [&](double) { return scene; });
  const Drive second = drive_through(10, [](double) { return ground(); });
  const Visibility seen_first = find_visibility(before, first.source());
  const UpdatedMap updated = update_map(before, seen_first, second.source());
  const SightFinder sight(updated.map.finest(), updated.visibility);
  std::size_t num_lost = 0;
  for (const VoxelLeaf& leaf : seen_first.seen_empty.leaves()) {
    for (auto it = leaf.getValueMask().beginOn(); it; ++it) {
      num_lost += sight.find(leaf.offsetToGlobalCoord(it.pos())) == Sight::kNeverSeen;
    }
  }
  EXPECT_EQ(num_lost, 0U);
  for_each_voxel(updated.map.finest(), [&](const VoxelIndex& voxel, std::size_t /*record*/) {
    const VoxelLeaf* leaf = updated.visibility.seen_empty.find_leaf(voxel);
    ASSERT_FALSE(leaf && leaf->getValueMask().isOn(VoxelLeaf::coordToOffset(voxel)));
  });
}

TEST(MapUpdate, VisibilityOfAnotherMapIsRefused) {
  const VoxelMap map = map_of(ground());
  Visibility other;
  other.voxel_size = 0.1;
  const Drive drive = drive_through(2, [](double) { return ground(); });
  EXPECT_THROW(update_map(map, other, drive.source()), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap

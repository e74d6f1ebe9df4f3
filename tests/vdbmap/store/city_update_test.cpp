// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/city_update.h"

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/city_folders.h"
#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "tests/support/sample_maps.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/threads.h"
#include "vdbmap/change/map_visibility.h"
#include "vdbmap/core/error.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/io/ply/ply.h"
#include "vdbmap/store/city_build.h"
#include "vdbmap/store/city_check.h"
#include "vdbmap/store/city_diff.h"
#include "vdbmap/store/city_of_map.h"
#include "vdbmap/store/seen_window.h"

namespace vdbmap {
namespace {

using test::Scene;

Scene together(std::vector<Scene> parts) {
  Scene scene;
  for (const Scene& part : parts) scene.insert(scene.end(), part.begin(), part.end());
  return scene;
}

// A road beside the corner of four tiles, a facade along it in the next row of tiles, and a tower two rows away, whose
// row in between nobody sees a point of, though rays go through it.
Scene place_at_the_corner() {
  return {{{-15, 40, 0.03}, {40, 0, 0}, {0, 23, 0}},
          {{-15, 66, 0}, {10, 0, 0}, {0, 0, 5}},
          {{-60, 129, 0}, {120, 0, 0}, {0, 0, 30}}};
}

Scene car_at_x(double x, double y) { return test::box({x, y, 0.25}, {x + 4, y + 1.8, 1.6}); }

// Scans along x at y = 55, of what stands and moves there.
class CornerDrive {
 public:
  CornerDrive(int num_scans, const std::function<Scene(double seconds)>& more_at, unsigned seed = 0) {
    for (int i = 0; i < num_scans; ++i) {
      const double seconds = 0.1 * i;
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.translation() = Eigen::Vector3d(-6 + 7 * seconds, 55 + 0.013 * i, 1.9);
      test::Scanner scanner{
          .num_beams = 32, .num_azimuths = 480, .min_elevation_deg = -24, .max_elevation_deg = 14, .range_noise = 0.01};
      scanner.seed = seed + static_cast<unsigned>(i);
      scans_.push_back(test::scan_scene(together({place_at_the_corner(), more_at(seconds)}), pose, scanner));
      poses_.push_back(pose);
    }
  }

  CloudSource source() const {
    return [this](const std::function<void(const PosedCloud&)>& take) {
      static const std::vector<Eigen::Vector3d> kSensor = {Eigen::Vector3d::Zero()};
      for (std::size_t i = 0; i < scans_.size(); ++i) {
        take({scans_[i], poses_[i], kSensor, 0.1 * static_cast<double>(i)});
      }
    };
  }

 private:
  std::vector<PointCloud> scans_;
  std::vector<Eigen::Isometry3d> poses_;
};

// A car across the border of two tiles that leaves, one that comes, and one that drives by over the border.
const CornerDrive& first_drive() {
  static const CornerDrive drive(10, [](double) { return car_at_x(-2, 59); });
  return drive;
}

const CornerDrive& second_drive() {
  static const CornerDrive drive(
      24,
      [](double seconds) {
        return together({car_at_x(5, 60), car_at_x(-10 + 13 * seconds, 50)});
      },
      100);
  return drive;
}

struct SeenByFirst {
  VoxelMap map;
  Visibility visibility;
};

const SeenByFirst& before() {
  static const SeenByFirst seen = [] {
    BuildOptions options = test::anchored(Eigen::Vector3d::Zero());
    options.epoch = 1;
    MapBuilder builder(options);
    first_drive().source()([&](const PosedCloud& posed) { builder.add(posed.cloud, posed.map_from_cloud); });
    SeenByFirst made{builder.finish(), {}};
    made.visibility = find_visibility(made.map, first_drive().source());
    return made;
  }();
  return seen;
}

UpdateOptions in_epoch_two() {
  UpdateOptions options;
  options.epoch = 2;
  return options;
}

const UpdatedMap& in_one_piece() {
  static const UpdatedMap updated =
      update_map(before().map, before().visibility, second_drive().source(), in_epoch_two());
  return updated;
}

void expect_same_tree(const VoxelTree& a, const VoxelTree& b) {
  ASSERT_EQ(a.leaves().size(), b.leaves().size());
  for (std::size_t i = 0; i < a.leaves().size(); ++i) {
    ASSERT_EQ(a.leaves()[i].origin(), b.leaves()[i].origin());
    ASSERT_TRUE(a.leaves()[i].getValueMask() == b.leaves()[i].getValueMask()) << a.leaves()[i].origin();
  }
}

void expect_same(const LoadedMap& city, const VoxelMap& map, const Visibility& visibility) {
  EXPECT_EQ(test::difference(city.map, map), "");
  ASSERT_TRUE(city.visibility);
  EXPECT_TRUE(city.visibility->hits == visibility.hits);
  EXPECT_TRUE(city.visibility->passes == visibility.passes);
  expect_same_tree(city.visibility->seen_empty, visibility.seen_empty);
}

class CityUpdateTest : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name = "city") const { return folder_ / name; }

  void save_before(const std::string& name = "city") const {
    save_city(path(name), before().map, {before().visibility, {}});
  }

  // With --memory of so many bytes.
  CityUpdateOptions options(std::size_t memory_bytes = std::size_t{1} << 20) const {
    CityUpdateOptions options;
    options.update = in_epoch_two();
    options.memory_bytes = memory_bytes;
    options.date = "2023-09-14";
    return options;
  }

  UpdatedCity update(const CityUpdateOptions& options, const std::string& name = "city") const {
    return update_city(path(name), path(name), second_drive().source(), {source()}, options);
  }

  static MapSource source() { return {"0.bin", std::string(32, 'a'), 0, 0}; }

  test::TemporaryFolder folder_;
};

using CityUpdate = CityUpdateTest;

TEST_F(CityUpdate, IsThatOfTheMapInOnePieceForAnyWindowAndNumberOfThreads) {
  const UpdatedMap& expected = in_one_piece();
  ASSERT_GT(expected.counts.gone, 100U);
  ASSERT_GT(expected.counts.moved, 100U);
  std::map<std::string, std::string> first;
  for (const auto& way :
       {std::pair<std::size_t, int>{std::size_t{2} << 30, 2}, {std::size_t{1} << 20, 1}, {std::size_t{100} << 20, 4}}) {
    std::filesystem::remove_all(path());
    save_before();
    const UpdatedCity updated = test::on_threads(way.second, [&] { return update(options(way.first)); });
    expect_same(load_seen_map_or_city(path()), expected.map, expected.visibility);
    EXPECT_EQ(changes_of(updated.counts), changes_of(expected.counts));
    EXPECT_EQ(updated.counts.num_points, expected.counts.num_points);
    EXPECT_EQ(updated.counts.num_moved_points, expected.counts.num_moved_points);
    if (first.empty()) first = test::files_of_city(path());
    EXPECT_TRUE(test::files_of_city(path()) == first) << way.first;
  }
  EXPECT_TRUE(check_city(path()).problems.empty());
}

TEST_F(CityUpdate, RowsThatOnlyRaysEnteredHaveATile) {
  save_before();
  update(options());
  const CityManifest manifest = open_city(path()).manifest;
  std::size_t num_empty = 0;
  for (const CityTile& tile : manifest.tiles) num_empty += tile.num_voxels.front() == 0;
  EXPECT_GT(num_empty, 0U);
  EXPECT_TRUE(extent(manifest)->min.allFinite());
  const CityCheckResult checked = check_city(path());
  EXPECT_TRUE(checked.problems.empty()) << checked.problems.front().file << ": " << checked.problems.front().what;
}

TEST_F(CityUpdate, TheEpochBeforeStaysAsItWas) {
  save_before();
  update(options());
  expect_same(load_seen_map_or_city(path().string() + "@1"), before().map, before().visibility);
  const CityManifest now = open_city(path()).manifest;
  ASSERT_EQ(now.epochs.size(), 1U);
  EXPECT_EQ(now.epochs[0].date, "2023-09-14");
  EXPECT_EQ(now.epochs[0].changes.gone, in_one_piece().counts.gone);
}

TEST_F(CityUpdate, DiffOfTheEpochsIsThatOfTheMaps) {
  save_before();
  update(options());
  const MapDiff expected =
      map_diff({before().map, &before().visibility}, {in_one_piece().map, &in_one_piece().visibility});
  ASSERT_GT(expected.counts.vanished, 50U);
  ASSERT_GT(expected.counts.appeared, 50U);
  for (const int tiles_at_once : {1, 4}) {
    StoredDiffOptions options;
    options.tiles_at_once = tiles_at_once;
    const StoredDiff diff = diff_stored_maps(path().string() + "@1", path().string() + "@2", options);
    EXPECT_EQ(diff.diff.counts, expected.counts);
    EXPECT_TRUE(diff.earlier_has_rays);
    EXPECT_TRUE(diff.later_has_rays);
  }
}

TEST_F(CityUpdate, WithoutRaysBeforeItIsThatOfTheMapWithoutRaysToo) {
  save_city(path(), before().map);
  const UpdatedMap expected = update_map(before().map, std::nullopt, second_drive().source(), in_epoch_two());
  update(options());
  expect_same(load_seen_map_or_city(path()), expected.map, expected.visibility);
}

TEST_F(CityUpdate, ACityWithoutEpochsGetsThemEverywhere) {
  MapBuilder builder(test::anchored(Eigen::Vector3d::Zero()));
  first_drive().source()([&](const PosedCloud& posed) { builder.add(posed.cloud, posed.map_from_cloud); });
  PointCloud far;
  far.positions = {{500.25, 500.25, 1}, {500.35, 500.25, 1}};
  builder.add(far);
  const VoxelMap map = builder.finish();
  const UpdatedMap expected = update_map(map, std::nullopt, second_drive().source(), in_epoch_two());
  save_city(path(), map);
  update(options());
  expect_same(load_seen_map_or_city(path()), expected.map, expected.visibility);
}

TEST_F(CityUpdate, TilesThatNoRayCameNearAreNotRead) {
  BuildOptions with_epoch = test::anchored(Eigen::Vector3d::Zero());
  with_epoch.epoch = 1;
  MapBuilder builder(with_epoch);
  first_drive().source()([&](const PosedCloud& posed) { builder.add(posed.cloud, posed.map_from_cloud); });
  PointCloud far;
  far.positions = {{500.25, 500.25, 1}, {500.35, 500.25, 1}};
  builder.add(far);
  const CityManifest made = save_city(path(), builder.finish());
  const CityTile* tile = find_tile(made, {7, 7});
  ASSERT_NE(tile, nullptr);
  test::write_raw(tile_path(path(), *tile), "not read");
  update(options());
  EXPECT_EQ(*find_tile(open_city(path()).manifest, {7, 7}), *tile);
}

TEST_F(CityUpdate, IntoAnotherFolderLeavesTheCityAsItIs) {
  save_before();
  save_before("same");
  update(options(), "same");
  const auto files = test::files_of_city(path());
  update_city(path(), path("other"), second_drive().source(), {source()}, options());
  EXPECT_TRUE(test::files_of_city(path()) == files);
  EXPECT_EQ(open_city(path("other")).manifest, open_city(path("same")).manifest);
  EXPECT_TRUE(check_city(path("other")).problems.empty());
  EXPECT_THROW(update_city(path(), path("other"), second_drive().source(), {source()}, options()), IoError);
}

TEST_F(CityUpdate, WhatCannotBeLeavesTheCityAsItIs) {
  save_before();
  const auto files = test::files_of_city(path());
  CityUpdateOptions early = options();
  early.update.epoch = 0;
  EXPECT_THROW(update(early), std::invalid_argument);
  CityUpdateOptions doubted = options();
  doubted.check = [](const UpdateCounts&) { throw IoError::malformed("poses.txt", "are of another place"); };
  EXPECT_THROW(update(doubted), IoError);
  EXPECT_TRUE(test::files_of_city(path()) == files);
  update(options());
  EXPECT_THROW(update(options()), std::invalid_argument);  // the same source
}

TEST_F(CityUpdate, ACityThatKeepsPartsIsLeftAsItIs) {
  write_ply(folder_ / "a.ply", test::sample_scene(test::street(), 6, 1));
  CityBuildOptions build;
  build.keeps_parts = true;
  build_city(path(), {{{folder_ / "a.ply", std::nullopt}}}, build);
  const auto files = test::files_of_city(path());
  EXPECT_THROW(update(options()), std::invalid_argument);
  EXPECT_TRUE(test::files_of_city(path()) == files);
  EXPECT_THROW(update_city(path(), path("other"), second_drive().source(), {source()}, options()),
               std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(path("other")));
}

TEST_F(CityUpdate, ADamagedTileIsNamed) {
  save_before();
  const CityManifest manifest = open_city(path()).manifest;
  const auto most = std::ranges::max_element(manifest.tiles, {}, &CityTile::num_points);
  test::write_raw(tile_path(path(), *most), "damaged");
  try {
    update(options());
    FAIL();
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find(tile_file_name(*most)), std::string::npos) << error.what();
  }
  EXPECT_EQ(open_city(path()).manifest, manifest);
}

}  // namespace
}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/city_folders.h"
#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "tests/support/sample_maps.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/threads.h"
#include "vdbmap/core/error.h"
#include "vdbmap/core/map_merge.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/io/las/las.h"
#include "vdbmap/io/map_from_files.h"
#include "vdbmap/io/ply/ply.h"
#include "vdbmap/store/city_build.h"
#include "vdbmap/store/city_check.h"
#include "vdbmap/store/city_window.h"

namespace vdbmap {
namespace {

// A piece of street, moved along x: pieces overlap, and lie across tiles.
PointCloud stretch_at(double x, unsigned seed) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x, -20, 5);
  return test::moved(test::sample_scene(test::street(), 6, seed), pose);
}

PointCloud with_more(PointCloud cloud) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.intensities.push_back(static_cast<float>(i % 200));
    cloud.labels.push_back(static_cast<std::uint16_t>(i % 5));
    cloud.colors.push_back({static_cast<std::uint16_t>(257 * (i % 256)), 257 * 40, 257 * 80});
  }
  return cloud;
}

class CityPartsTest : public testing::Test {
 protected:
  MapInput file(const std::string& name, const PointCloud& cloud) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    write_ply(folder_ / name, cloud);
    return {{folder_ / name, std::nullopt}};
  }

  // Four surveys, the first far from the last.
  std::vector<MapInput> four_files() const {
    return {file("a.ply", stretch_at(0, 1)), file("b.ply", with_more(stretch_at(50, 2))),
            file("c.ply", with_more(stretch_at(-70, 3))), file("d.ply", stretch_at(600, 4))};
  }

  std::filesystem::path city() const { return folder_ / "city"; }

  static CityBuildOptions options(std::optional<std::int32_t> epoch = std::nullopt) {
    CityBuildOptions options;
    options.files.build.epoch = epoch;
    options.files.build.anchor = Eigen::Vector3d(0, 0, 0);
    options.keeps_parts = true;
    return options;
  }

  // For what is added to a city, which has its anchor.
  static CityBuildOptions changes(std::optional<std::int32_t> epoch = std::nullopt) {
    CityBuildOptions changes;
    changes.files.build.epoch = epoch;
    return changes;
  }

  // The city must be, file by file, the one that is built at once of these inputs.
  void expect_fresh(const std::vector<MapInput>& inputs, std::optional<std::int32_t> epoch = std::nullopt) const {
    std::filesystem::remove_all(folder_ / "fresh");
    build_city(folder_ / "fresh", inputs, options(epoch));
    EXPECT_TRUE(test::files_of_city(city()) == test::files_of_city(folder_ / "fresh"));
  }

  std::vector<std::filesystem::path> part_files() const {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(city() / "parts")) files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
  }

  test::TemporaryFolder folder_;
};

using CityParts = CityPartsTest;

TEST_F(CityParts, TilesAreThoseOfACityWithoutThem) {
  const std::vector<MapInput> inputs = four_files();
  const CityBuilt built = build_city(city(), inputs, options(2));
  CityBuildOptions without = options(2);
  without.keeps_parts = false;
  const CityBuilt plain = build_city(folder_ / "plain", inputs, without);
  EXPECT_EQ(built.manifest.tiles, plain.manifest.tiles);
  EXPECT_EQ(built.manifest.layout, plain.manifest.layout);
  EXPECT_EQ(built.manifest.sources, plain.manifest.sources);
  EXPECT_EQ(built.added, plain.added);
  EXPECT_EQ(built.notes.num_points, plain.notes.num_points);
  EXPECT_TRUE(keeps_parts(built.manifest));
  EXPECT_FALSE(keeps_parts(plain.manifest));
  EXPECT_EQ(part_files().size(), 4U);
  EXPECT_TRUE(check_city(city()).problems.empty());
  EXPECT_EQ(check_city(city()).num_parts, 4U);
}

TEST_F(CityParts, WithoutAnAnchorItIsThatOfTheFirstSource) {
  PointCloud far = stretch_at(3e5, 1);
  const std::vector<MapInput> inputs = {file("b.ply", stretch_at(3e5, 2)), file("a.ply", stretch_at(3e5 + 300, 1))};
  CityBuildOptions anywhere;
  anywhere.keeps_parts = true;
  build_city(city(), inputs, anywhere);
  anywhere.keeps_parts = false;
  build_city(folder_ / "plain", inputs, anywhere);
  EXPECT_EQ(open_city(city()).manifest.layout, open_city(folder_ / "plain").manifest.layout);
}

TEST_F(CityParts, AddingIsBuildingAnew) {
  const std::vector<MapInput> inputs = four_files();
  build_city(city(), {inputs[0], inputs[1]}, options());
  const CityBuilt added = add_to_city(city(), {inputs[3], inputs[2]}, changes());
  EXPECT_EQ(added.added.size(), 2U);
  EXPECT_TRUE(added.removed.empty());
  expect_fresh(inputs);

  const auto before = test::files_of_city(city());
  EXPECT_EQ(add_to_city(city(), {inputs[2]}, changes()).not_counted, (std::vector<std::string>{"c.ply"}));
  EXPECT_TRUE(test::files_of_city(city()) == before);
}

TEST_F(CityParts, RemovingIsBuildingAnew) {
  const std::vector<MapInput> inputs = four_files();
  build_city(city(), inputs, options(1));
  CityBuildOptions without_b = changes();
  without_b.removed = {"b.ply"};
  const CityBuilt removed = add_to_city(city(), {}, without_b);
  ASSERT_EQ(removed.removed.size(), 1U);
  EXPECT_EQ(removed.removed[0].name, "b.ply");
  expect_fresh({inputs[0], inputs[2], inputs[3]}, 1);

  // Once more, it is not there.
  const auto before = test::files_of_city(city());
  EXPECT_EQ(add_to_city(city(), {}, without_b).not_found, (std::vector<std::string>{"b.ply"}));
  EXPECT_TRUE(test::files_of_city(city()) == before);

  // Without c, by its hash, no source knows colours, labels and intensities: all tiles are others.
  CityBuildOptions without_c = changes();
  without_c.removed = {open_city(city()).manifest.sources[1].hash};
  EXPECT_EQ(add_to_city(city(), {}, without_c).removed[0].name, "c.ply");
  EXPECT_FALSE(open_city(city()).manifest.layout.has_color);
  expect_fresh({inputs[0], inputs[3]}, 1);

  CityBuildOptions without_d = changes();
  without_d.removed = {"d.ply"};
  add_to_city(city(), {}, without_d);
  expect_fresh({inputs[0]}, 1);
}

TEST_F(CityParts, ReplacingIsBuildingAnew) {
  std::vector<MapInput> inputs = four_files();
  build_city(city(), inputs, options(1));
  const MapInput corrected = file("corrected/b.ply", with_more(stretch_at(50.3, 2)));
  CityBuildOptions replacing = changes();
  replacing.replaced = {{"b.ply", corrected}};
  const CityBuilt replaced = add_to_city(city(), {}, replacing);
  EXPECT_EQ(replaced.added.size(), 1U);
  EXPECT_EQ(replaced.removed.size(), 1U);
  inputs[1] = corrected;
  expect_fresh(inputs, 1);

  const auto before = test::files_of_city(city());
  EXPECT_EQ(add_to_city(city(), {}, replacing).not_counted, (std::vector<std::string>{"b.ply"}));
  EXPECT_TRUE(test::files_of_city(city()) == before);

  // All at once: one comes, one goes, another takes a place.
  const MapInput e = file("e.ply", stretch_at(90, 5));
  const MapInput f = file("f.ply", stretch_at(610, 6));
  CityBuildOptions all = changes();
  all.removed = {"a.ply"};
  all.replaced = {{"d.ply", f}};
  add_to_city(city(), {e}, all);
  expect_fresh({inputs[1], inputs[2], e, f}, 1);
}

TEST_F(CityParts, WhatIsReplacedOnceIsReplacedOnceMore) {
  const std::vector<MapInput> inputs = four_files();
  build_city(city(), {inputs[0]}, options());
  const MapInput e = file("e.ply", stretch_at(1, 1));
  CityBuildOptions replacing = changes();
  replacing.replaced = {{"a.ply", e}};
  add_to_city(city(), {}, replacing);
  expect_fresh({e});
  add_to_city(city(), {}, replacing);  // a.ply is gone, but e.ply is there: nothing is left to do
  expect_fresh({e});
}

TEST_F(CityParts, MemoryAndThreadsChangeNoByte) {
  const std::vector<MapInput> inputs = four_files();
  const MapInput e = file("e.ply", with_more(stretch_at(20, 7)));
  const auto change = [&](const std::filesystem::path& folder, std::size_t memory_bytes) {
    CityBuildOptions first = options(1);
    first.memory_bytes = memory_bytes;
    build_city(folder, inputs, first);
    CityBuildOptions second = changes(2);
    second.memory_bytes = memory_bytes;
    second.removed = {"c.ply"};
    second.replaced = {{"b.ply", e}};
    return add_to_city(folder, {}, second).manifest.tiles.size();
  };
  EXPECT_GT(change(city(), std::size_t{1} << 30), 3U);
  const auto expected = test::files_of_city(city());
  for (const int threads : {1, 4}) {
    const std::filesystem::path other = folder_ / ("other" + std::to_string(threads));
    test::on_threads(threads, [&] { return change(other, 1 << 20); });
    EXPECT_TRUE(test::files_of_city(other) == expected) << threads;
  }
}

TEST_F(CityParts, OnlyTilesThatAChangedSourceTouchesAreMadeAnew) {
  const std::vector<MapInput> inputs = four_files();
  const CityManifest before = build_city(city(), inputs, options()).manifest;
  CityBuildOptions without_d = changes();
  without_d.removed = {"d.ply"};
  std::size_t num_made = 0;
  without_d.on_tiles_begun = [&](std::size_t count) { num_made = count; };
  const CityManifest after = add_to_city(city(), {}, without_d).manifest;
  EXPECT_EQ(num_made, 0U);  // d.ply lies alone
  EXPECT_LT(after.tiles.size(), before.tiles.size());
  for (const CityTile& tile : after.tiles) EXPECT_TRUE(*find_tile(before, tile.id) == tile);

  std::size_t num_of_b = 0;
  CityBuildOptions without_b = changes();
  without_b.removed = {"b.ply"};
  without_b.on_tiles_begun = [&](std::size_t count) { num_of_b = count; };
  add_to_city(city(), {}, without_b);
  EXPECT_GT(num_of_b, 0U);
  EXPECT_LT(num_of_b, after.tiles.size());
}

// The epochs of a voxel are the first and the last of all sources in it, as merging finds them; all else is as if the
// sources were of one epoch.
TEST_F(CityParts, EpochsAreThoseOfTheSourcesInAVoxel) {
  const MapInput a = file("a.ply", stretch_at(0, 1));
  const MapInput b = file("b.ply", stretch_at(5, 2));
  const MapInput c = file("c.ply", stretch_at(10, 3));
  build_city(city(), {b}, options(3));
  add_to_city(city(), {c}, changes(4));
  add_to_city(city(), {a}, changes(7));
  const auto map_of = [&](const MapInput& input, std::int32_t epoch) {
    MapFromFilesOptions files;
    files.build.epoch = epoch;
    files.build.anchor = Eigen::Vector3d(0, 0, 0);
    return build_map_from_files({input}, files).map;
  };
  const VoxelMap merged = merge_maps(merge_maps(map_of(b, 3), map_of(c, 4)), map_of(a, 7));
  const VoxelMap map = load_map_or_city(city());
  for (std::size_t i = 0; i < map.levels.size(); ++i) {
    EXPECT_EQ(map.levels[i].channels().first_epochs, merged.levels[i].channels().first_epochs) << i;
    EXPECT_EQ(map.levels[i].channels().last_epochs, merged.levels[i].channels().last_epochs) << i;
  }
  const std::vector<std::int32_t>& first = map.finest().channels().first_epochs;
  const std::vector<std::int32_t>& last = map.finest().channels().last_epochs;
  std::size_t num_seen_twice = 0;
  for (std::size_t i = 0; i < first.size(); ++i) num_seen_twice += first[i] == 3 && last[i] == 7 ? 1 : 0;
  EXPECT_GT(num_seen_twice, 100U);
  EXPECT_EQ(open_city(city()).manifest.epoch, 7);

  // What comes for a source is of that source's epoch: here, no other way leads to this city.
  const MapInput d = file("d.ply", stretch_at(12, 3));
  CityBuildOptions replacing = changes(7);
  replacing.replaced = {{"c.ply", d}};
  add_to_city(city(), {}, replacing);
  const auto changed = test::files_of_city(city());
  std::filesystem::remove_all(city());
  build_city(city(), {b}, options(3));
  add_to_city(city(), {d}, changes(4));
  add_to_city(city(), {a}, changes(7));
  EXPECT_TRUE(test::files_of_city(city()).at("map.json") == changed.at("map.json"));
}

TEST_F(CityParts, EarlierEpochsStayAndGoWithTheirParts) {
  const std::vector<MapInput> inputs = four_files();
  build_city(city(), inputs, options(1));
  const VoxelMap first = load_map_or_city(city());
  CityBuildOptions without_b = changes(2);
  without_b.removed = {"b.ply"};
  add_to_city(city(), {}, without_b);
  EXPECT_EQ(test::difference(load_map_or_city(city().string() + "@1"), first), "");
  EXPECT_EQ(part_files().size(), 4U);
  EXPECT_TRUE(check_city(city()).problems.empty());

  CityBuildOptions without_c = changes(3);
  without_c.removed = {"c.ply"};
  without_c.keep_epochs = 2;
  add_to_city(city(), {}, without_c);
  EXPECT_EQ(part_files().size(), 3U);  // b.ply's was in epoch 1 alone
  CityBuildOptions more = changes(4);
  more.keep_epochs = 1;
  add_to_city(city(), {file("e.ply", stretch_at(9, 9))}, more);
  EXPECT_EQ(part_files().size(), 3U);
  EXPECT_TRUE(check_city(city()).problems.empty());
}

TEST_F(CityParts, AnEpsgCodeThatWasGivenIsKnownLater) {
  write_las(folder_ / "a.las", stretch_at(0, 5), {.epsg = 25832});
  const MapInput a{{folder_ / "a.las", {}}};
  const MapInput b = file("b.ply", stretch_at(3, 6));
  CityBuildOptions with_code = options();
  with_code.files.build.epsg = 25832;
  build_city(city(), {a, b}, with_code);
  CityBuildOptions without_a = changes();
  without_a.removed = {"a.las"};
  add_to_city(city(), {}, without_a);
  EXPECT_EQ(open_city(city()).manifest.layout.frame.epsg, 25832);

  // Said by a file alone, it goes with that file.
  build_city(folder_ / "told", {a, b}, options());
  EXPECT_EQ(open_city(folder_ / "told").manifest.layout.frame.epsg, 25832);
  add_to_city(folder_ / "told", {}, without_a);
  EXPECT_EQ(open_city(folder_ / "told").manifest.layout.frame.epsg, std::nullopt);

  write_las(folder_ / "c.las", stretch_at(0, 6), {.epsg = 25833});
  const auto before = test::files_of_city(city());
  EXPECT_EQ(test::io_error_of([&] {
              add_to_city(city(), {{{folder_ / "c.las", {}}}}, changes());
            }),
            "c.las: is in EPSG:25833, files before it are in EPSG:25832");
  EXPECT_TRUE(test::files_of_city(city()) == before);
}

TEST_F(CityParts, WithoutThemNothingCanBeTakenOut) {
  const std::vector<MapInput> inputs = four_files();
  CityBuildOptions plain = options();
  plain.keeps_parts = false;
  build_city(city(), {inputs[0], inputs[1]}, plain);
  const auto before = test::files_of_city(city());
  CityBuildOptions removing = changes();
  removing.removed = {"a.ply"};
  CityBuildOptions replacing = changes();
  replacing.replaced = {{"a.ply", inputs[3]}};
  for (const CityBuildOptions& change : {removing, replacing}) {
    try {
      add_to_city(city(), {}, change);
      ADD_FAILURE();
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(error.what(), city().string() +
                                  ": does not keep the sums of its sources, so none can be taken out: build it anew "
                                  "with --keep-parts");
    }
  }
  CityBuildOptions keeping = changes();
  keeping.keeps_parts = true;
  EXPECT_THROW(add_to_city(city(), {inputs[2]}, keeping), std::invalid_argument);
  EXPECT_TRUE(test::files_of_city(city()) == before);
  EXPECT_FALSE(std::filesystem::exists(city() / "parts"));
  add_to_city(city(), {inputs[2]}, changes());
  EXPECT_FALSE(keeps_parts(open_city(city()).manifest));
}

TEST_F(CityParts, WhatCannotBeChangesNothing) {
  const std::vector<MapInput> inputs = four_files();
  const MapInput namesake = file("other/a.ply", stretch_at(30, 9));
  build_city(city(), {inputs[0], namesake, inputs[1]}, options());
  const auto before = test::files_of_city(city());
  CityBuildOptions several = changes();
  several.removed = {"a.ply"};
  EXPECT_THROW(add_to_city(city(), {}, several), std::invalid_argument);
  CityBuildOptions nothing_left = changes();
  for (const MapSource& source : open_city(city()).manifest.sources) nothing_left.removed.push_back(source.hash);
  EXPECT_THROW(add_to_city(city(), {}, nothing_left), std::invalid_argument);
  CityBuildOptions unknown = changes();
  unknown.replaced = {{"z.ply", inputs[2]}};
  EXPECT_THROW(add_to_city(city(), {}, unknown), std::invalid_argument);
  CityBuildOptions missing = changes();
  missing.replaced = {{"b.ply", {{folder_ / "none.ply", {}}}}};
  EXPECT_THROW(add_to_city(city(), {}, missing), IoError);
  test::write_raw(folder_ / "cut.ply", test::read_raw(folder_ / "b.ply").substr(0, 90));
  missing.replaced = {{"b.ply", {{folder_ / "cut.ply", {}}}}};
  EXPECT_THROW(add_to_city(city(), {}, missing), IoError);
  EXPECT_TRUE(test::files_of_city(city()) == before);
}

TEST_F(CityParts, BadPartsAreNamedAndNothingIsWritten) {
  const std::vector<MapInput> inputs = four_files();
  build_city(city(), {inputs[0], inputs[1]}, options());
  build_city(folder_ / "other", {inputs[2]}, options());
  const std::filesystem::path other = *std::filesystem::directory_iterator(folder_ / "other/parts");
  const CityManifest manifest = open_city(city()).manifest;
  const std::filesystem::path path = kept_part_path(city(), *find_part(manifest, manifest.sources[1].hash));
  const std::string name = path.filename().string();
  const std::string whole = test::read_raw(path);
  CityBuildOptions without_a = changes();
  without_a.removed = {"a.ply"};

  const auto expect_refused = [&](const std::string& reason, const std::vector<CityBuildOptions>& refused) {
    const auto before = test::files_of_city(city());
    for (const CityBuildOptions& change : refused) {
      std::vector<MapInput> added;
      if (change.removed.empty()) added.push_back(inputs[2]);
      try {
        add_to_city(city(), added, change);
        ADD_FAILURE() << reason;
      } catch (const IoError& error) {
        EXPECT_EQ(error.kind(), IoError::Kind::kMalformed);
        EXPECT_NE(std::string(error.what()).find(name + ":"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
      }
    }
    EXPECT_TRUE(test::files_of_city(city()) == before) << reason;
    const CityCheckResult checked = check_city(city());
    ASSERT_EQ(checked.problems.size(), 1U) << reason;
    EXPECT_EQ(checked.problems[0].file, path);
    EXPECT_NE(checked.problems[0].what.find(reason), std::string::npos) << checked.problems[0].what;
  };

  const std::vector<CityBuildOptions> both = {without_a, changes()};
  std::filesystem::remove(path);
  expect_refused("is missing: the sums of b.ply", both);
  test::write_raw(path, whole.substr(0, whole.size() / 2));
  expect_refused("was cut", both);
  std::string changed = whole;
  changed[changed.size() - 100] ^= 1;
  test::write_raw(path, changed);
  expect_refused("is damaged", both);
  std::filesystem::copy_file(other, path, std::filesystem::copy_options::overwrite_existing);
  expect_refused("is not the part that its name says: the sums of b.ply", both);
  std::filesystem::copy_file(kept_part_path(city(), *find_part(manifest, manifest.sources[0].hash)), path,
                             std::filesystem::copy_options::overwrite_existing);
  expect_refused("is not the part that its name says: the sums of b.ply", both);

  // Its sums are looked at where they are needed: beside those of a.ply.
  changed = whole;
  for (std::size_t i = 10; i < whole.find("{\"format\""); i += 40) changed[i] ^= 1;
  test::write_raw(path, changed);
  expect_refused("the sums of a tile are damaged", {without_a});
  test::write_raw(path, whole);
  EXPECT_TRUE(check_city(city()).problems.empty());
}

TEST_F(CityParts, HaveNoRays) {
  const std::vector<MapInput> inputs = four_files();
  CityBuildOptions with_rays = options();
  with_rays.rays = [](const auto&, const auto&) {};
  EXPECT_THROW(build_city(city(), inputs, with_rays), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(city()));
  build_city(city(), {inputs[0]}, options());
  const auto before = test::files_of_city(city());
  with_rays = changes();
  with_rays.rays = [](const auto&, const auto&) {};
  EXPECT_THROW(add_to_city(city(), {inputs[1]}, with_rays), std::invalid_argument);
  EXPECT_TRUE(test::files_of_city(city()) == before);
}

TEST_F(CityParts, DatesOfEpochsStay) {
  const std::vector<MapInput> inputs = four_files();
  CityBuildOptions first = options(1);
  first.date = "2023-03-02";
  build_city(city(), {inputs[0]}, first);
  CityBuildOptions second = changes(2);
  second.date = "2023-09-14";
  const CityManifest manifest = add_to_city(city(), {inputs[1]}, second).manifest;
  EXPECT_EQ(date_of(manifest), "2023-09-14");
  ASSERT_NE(find_epoch(manifest, 1), nullptr);
  EXPECT_EQ(find_epoch(manifest, 1)->date, "2023-03-02");
  EXPECT_EQ(find_epoch(manifest, 3), nullptr);
}

TEST_F(CityParts, AnEarlierEpochIsNotAddedTo) {
  const std::vector<MapInput> inputs = four_files();
  build_city(city(), {inputs[0]}, options(1));
  add_to_city(city(), {inputs[1]}, changes(2));
  const auto before = test::files_of_city(city());
  EXPECT_THROW(add_to_city(folder_ / "city@1", {inputs[2]}, changes(3)), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "city@1"));
  EXPECT_TRUE(test::files_of_city(city()) == before);
}

}  // namespace
}  // namespace vdbmap

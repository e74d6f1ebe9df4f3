// SPDX-License-Identifier: GPL-3.0-or-later
#include <atomic>
#include <filesystem>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/city_folders.h"
#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "tests/support/sample_maps.h"
#include "tests/support/threads.h"
#include "vdbmap/core/error.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/io/vdb/map_check.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/store/city_of_map.h"
#include "vdbmap/store/city_window.h"
#include "vdbmap/store/city_writer.h"

namespace vdbmap {
namespace {

constexpr std::size_t kAllEpochs = std::numeric_limits<std::size_t>::max();

// A folder with the street as a city.
class CityTest : public testing::Test {
 protected:
  std::filesystem::path path() const { return folder_ / "city"; }
  void save() const { save_city(path(), test::street_of_tiles()); }

  // Saves the street once more without one of its tiles, as another epoch.
  void save_without_first_tile(std::int32_t epoch, std::size_t keep_epochs = kAllEpochs) const {
    CityWriter writer(path());
    CityManifest manifest = writer.current()->manifest;
    manifest.epoch = epoch;
    manifest.tiles.erase(manifest.tiles.begin());
    writer.publish(manifest, keep_epochs);
  }

  std::size_t num_tiles() const {
    std::size_t count = 0;
    for (const auto& [name, bytes] : test::files_of_city(path())) count += name.starts_with("tiles/") ? 1 : 0;
    return count;
  }

  // What loading the whole city says; empty where it works.
  std::string problem() const {
    try {
      City city = open_city(path());
      load_city(city);
      return "";
    } catch (const IoError& error) {
      EXPECT_EQ(error.kind(), IoError::Kind::kMalformed);
      return error.what();
    }
  }

  test::TemporaryFolder folder_;
};

using CityStore = CityTest;

TEST_F(CityStore, GivesBackTheMapItWasMadeOf) {
  save();
  for (const int threads : {1, 4}) {
    EXPECT_EQ(
        test::difference(test::on_threads(threads, [&] { return load_map_or_city(path()); }), test::street_of_tiles()),
        "");
  }
}

TEST_F(CityStore, EachTileIsAMapByItself) {
  save();
  const City city = open_city(path());
  ASSERT_EQ(city.manifest.tiles.size(), tiles_of(test::street_of_tiles()).size());
  for (const CityTile& tile : city.manifest.tiles) {
    const std::filesystem::path file = tile_path(city.folder, tile);
    EXPECT_EQ(file.filename().string(),
              std::to_string(tile.id.x) + "_" + std::to_string(tile.id.y) + "." + tile.hash + ".vdb");
    EXPECT_EQ(std::filesystem::file_size(file), tile.num_bytes);
    EXPECT_EQ(test::difference(load_map(file), cut_tile(test::street_of_tiles(), tile.id)), "");
  }
  EXPECT_TRUE(all_passed(check_map_file(tile_path(city.folder, city.manifest.tiles.front()))));
}

TEST_F(CityStore, AWindowHasTheTilesThatItAsksFor) {
  save();
  City city = open_city(path());
  const VoxelMap window = load_window(city, tiles_in_box({Eigen::Vector3d(3, 3, 0), Eigen::Vector3d(70, 10, 0)}));
  EXPECT_EQ(tiles_of(window), (std::vector<TileId>{{0, 0}, {1, 0}}));
  EXPECT_EQ(test::difference(cut_tile(window, {1, 0}), cut_tile(test::street_of_tiles(), {1, 0})), "");

  const VoxelMap nothing = load_window(city, [](const CityTile&) { return false; });
  EXPECT_EQ(nothing.levels.size(), 3U);
  EXPECT_EQ(nothing.finest().size(), 0U);
}

TEST_F(CityStore, AnEpochStaysAsItWas) {
  save();  // epoch 4, that of its voxels
  save_without_first_tile(7);
  EXPECT_EQ(num_tiles(), tiles_of(test::street_of_tiles()).size());
  EXPECT_EQ(test::difference(load_map_or_city(path().string() + "@4"), test::street_of_tiles()), "");
  EXPECT_EQ(open_city(path()).manifest.tiles.size() + 1, num_tiles());
  EXPECT_EQ(open_city(path().string() + "@7").manifest, open_city(path()).manifest);
  EXPECT_THROW(open_city(path().string() + "@5"), IoError);
  EXPECT_EQ(read_epochs(path()).size(), 2U);
}

TEST_F(CityStore, EpochsThatAreNotKeptGoWithTheirTiles) {
  save();
  save_without_first_tile(7, 1);
  EXPECT_EQ(read_epochs(path()).size(), 1U);
  EXPECT_EQ(num_tiles() + 1, tiles_of(test::street_of_tiles()).size());
}

TEST_F(CityStore, AStateOfTheSameEpochIsReplaced) {
  save();
  save_without_first_tile(4);
  EXPECT_EQ(read_epochs(path()).size(), 1U);
  EXPECT_EQ(num_tiles() + 1, tiles_of(test::street_of_tiles()).size());
}

TEST_F(CityStore, AWriterThatPublishesNothingLeavesTheCityAsItWas) {
  save();
  const auto before = test::files_of_city(path());
  {
    const CityWriter writer(path());
    writer.save_tile({0, 0}, cut_tile(test::street_of_tiles(), {-1, 0}), 50);
    EXPECT_FALSE(test::files_of_city(path()) == before);
  }
  EXPECT_TRUE(test::files_of_city(path()) == before);
  { const CityWriter writer(folder_ / "new"); }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "new"));
}

TEST_F(CityStore, LeftoversAreSweptByTheNextWriter) {
  save();
  const auto before = test::files_of_city(path());
  for (const char* name :
       {"map.json.abcdefgh", "tiles/0_0.vdb", "tiles/-3_12.00000000000000000000.vdb", "tiles/0_0.vdb.abcdefgh"}) {
    test::write_raw(path() / name, "x");
  }
  std::filesystem::create_directory(path() / "sums.abcdefgh");
  test::write_raw(path() / "sums.abcdefgh" / "1", "x");
  std::filesystem::create_directory(path() / "epochs");
  std::filesystem::copy_file(path() / "map.json", path() / "epochs" / "4.json");  // of the epoch that it is still in
  { const CityWriter writer(path()); }
  EXPECT_TRUE(test::files_of_city(path()) == before);
}

TEST_F(CityStore, AReaderGoesOnWithTheStateThatCameInBetween) {
  save();
  City city = open_city(path());
  const VoxelMap tile = cut_tile(test::street_of_tiles(), {0, 0});
  {
    CityWriter writer(path());
    CityManifest manifest = writer.current()->manifest;
    manifest.tiles = {writer.save_tile({0, 0}, tile, 20)};  // another file than before
    writer.publish(manifest, 1);
  }
  EXPECT_EQ(test::difference(load_city(city), tile), "");
  EXPECT_EQ(city.manifest.tiles.size(), 1U);
}

TEST_F(CityStore, ReadersSeeOneStateWhileAWriterReplacesOneAfterTheOther) {
  const auto tile = [](int x) { return cut_tile(test::street_of_tiles(), {x, 0}); };
  const auto publish = [&](float density) {  // two tiles, of one density
    CityWriter writer(path());
    CityManifest manifest{0, layout_of(test::street_of_tiles(), density), {}, {}};
    for (const int x : {-1, 0}) manifest.tiles.push_back(writer.save_tile({x, 0}, tile(x), density));
    writer.publish(manifest, 1);
  };
  const std::vector<VoxelMap> parts = {tile(-1), tile(0)};
  const VoxelMap expected = splice(parts);
  publish(1);
  std::atomic<bool> is_done = false;
  std::thread writer([&] {
    for (int i = 2; i < 30; ++i) publish(static_cast<float>(i));
    is_done = true;
  });
  int num_reads = 0;
  for (; !is_done; ++num_reads) EXPECT_EQ(test::difference(load_map_or_city(path()), expected), "");
  writer.join();
  EXPECT_GT(num_reads, 2);
}

TEST_F(CityStore, ATileThatIsMissingOrNotItsOwnIsNamed) {
  save();
  const City city = open_city(path());
  const std::filesystem::path file = tile_path(city.folder, city.manifest.tiles.front());
  const std::filesystem::path other = tile_path(city.folder, city.manifest.tiles.back());
  const std::string bytes = test::read_raw(file);

  std::filesystem::remove(file);
  EXPECT_EQ(problem(), file.string() + ": is missing");

  std::filesystem::copy_file(other, file);
  EXPECT_EQ(problem(), file.string() + ": is not the tile that its name says");

  std::string changed = bytes;
  changed[bytes.size() / 2] = static_cast<char>(changed[bytes.size() / 2] ^ 1);
  test::write_raw(file, changed);
  EXPECT_EQ(problem(), file.string() + ": is damaged: its content does not match its checksum");

  test::write_raw(file, bytes.substr(0, bytes.size() / 2));
  EXPECT_NE(problem().find(file.string()), std::string::npos);

  test::write_raw(file, "");
  EXPECT_NE(problem().find(file.string()), std::string::npos);

  test::write_raw(file, bytes);
  EXPECT_EQ(problem(), "");
}

TEST_F(CityStore, ATileThatTheManifestCountsOtherwiseIsNamed) {
  save();
  CityManifest manifest = open_city(path()).manifest;
  const auto problem_with = [&](const auto& change) {
    CityManifest changed = manifest;
    change(changed);
    test::write_raw(path() / "map.json", text_of(changed));
    return problem();
  };
  const auto says = [](const std::string& problem, const std::string& part) {
    return problem.find(part) != std::string::npos;
  };
  EXPECT_TRUE(says(problem_with([](CityManifest& m) { m.tiles[0].num_points += 1; }), "holds other voxels"));
  EXPECT_TRUE(says(problem_with([](CityManifest& m) { m.layout.channels.pop_back(); }), "has other attributes"));
  EXPECT_TRUE(says(problem_with([](CityManifest& m) { m.layout.has_color = true; }), "has other attributes"));
  EXPECT_TRUE(says(problem_with([](CityManifest& m) { m.layout.frame.epsg = 25832; }), "has another anchor"));
  EXPECT_TRUE(says(problem_with([](CityManifest& m) { m.layout.voxel_sizes = {0.1, 1, 4}; }), "has other levels"));
  EXPECT_EQ(problem_with([](CityManifest&) {}), "");
}

TEST_F(CityStore, FoldersOfSomethingElseAreRefused) {
  std::filesystem::create_directory(path());
  EXPECT_EQ(problem(), path().string() + ": is no city: it has no map.json");
  test::write_raw(path() / "letter.txt", "x");
  EXPECT_THROW(CityWriter{path()}, IoError);
  EXPECT_TRUE(std::filesystem::exists(path() / "letter.txt"));
  EXPECT_THROW(open_city(folder_ / "none"), IoError);
  EXPECT_FALSE(is_city(folder_ / "none"));
  EXPECT_FALSE(is_city((folder_ / "none").string() + "@1"));
}

TEST_F(CityStore, ASecondWriterIsRefusedAndReadersAreNot) {
  save();
  const CityWriter writer(path());
  EXPECT_THROW(CityWriter{path()}, IoError);
  EXPECT_EQ(problem(), "");
}

TEST_F(CityStore, ADamagedManifestIsLeftAsItIs) {
  save();
  test::write_raw(path() / "map.json", "{");
  const auto before = test::files_of_city(path());
  EXPECT_THROW(CityWriter{path()}, IoError);
  EXPECT_TRUE(test::files_of_city(path()) == before);
}

}  // namespace
}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/map_file.h"

#include <csignal>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "tests/support/sample_maps.h"
#include "tests/support/sanitizers.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/io/vdb/map_channels.h"
#include "vdbmap/io/vdb/map_metadata.h"
#include "vdbmap/io/vdb/vdb_file.h"

namespace vdbmap {
namespace {

constexpr unsigned kWhite = 0x3f80;  // largest code of a colour: upper half of 1.0f

using test::io_error_of;

// While it lives no file may grow beyond a size; write() then fails as it does on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  sighandler_t handler_;
};

class MapFile : public testing::Test {
 protected:
  std::string bytes_of(const VoxelMap& map) const {
    save_map(folder_ / "bytes.vdb", map);
    return test::read_raw(folder_ / "bytes.vdb");
  }

  std::string load_error(const std::string& bytes) const {
    return io_error_of([&] { load_map(test::write_raw(folder_ / "damaged.vdb", bytes)); });
  }

  std::size_t num_files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_.path()), {}));
  }

  test::TemporaryFolder folder_;
};

// Bytes 21 to 56 of a .vdb file are its id; ours is a checksum, any other id is not compared with anything.
std::string with_foreign_id(std::string bytes) { return bytes.replace(21, 36, "01234567-89ab-4def-8123-456789abcdef"); }

TEST_F(MapFile, ComesBackBitForBit) {
  for (const VoxelMap& map : {test::sample_map(), test::sample_map_without_attributes()}) {
    save_map(folder_ / "map.vdb", map);
    EXPECT_EQ(test::difference(load_map(folder_ / "map.vdb"), map), "");
  }
}

TEST_F(MapFile, EveryCodeComesBack) {
  VoxelMap map = test::sample_map();
  std::mt19937 random(3);
  for (VoxelLevel& level : map.levels) {
    for (VoxelRecord& record : level.records()) {
      record.count = static_cast<std::uint32_t>(1 + random() % 0x7fffffffu);
      for (int i = 0; i < 3; ++i) record.mean_code[i] = static_cast<std::uint16_t>(random() % kMeanSteps);
      for (int i = 0; i < 3; ++i) record.color_code[i] = static_cast<std::uint16_t>(random() % (kWhite + 1));
      record.normal_code = static_cast<std::uint16_t>(random());
      record.planarity_code = static_cast<std::uint8_t>(random());
    }
  }
  map.levels[0].records()[0].mean_code = {0, 0, 0};
  map.levels[0].records()[1].mean_code = {kMeanSteps - 1, kMeanSteps - 1, kMeanSteps - 1};
  save_map(folder_ / "map.vdb", map);
  EXPECT_EQ(test::difference(load_map(folder_ / "map.vdb"), map), "");
}

TEST_F(MapFile, ThreadsAndAnotherRoundTripDoNotChangeItsBytes) {
  const std::string expected = bytes_of(test::sample_map());
  for (const std::size_t num_threads : {1, 2, 7}) {
    const ThreadLimit limit(num_threads);
    EXPECT_TRUE(bytes_of(test::sample_map()) == expected) << num_threads << " threads";
  }
  EXPECT_TRUE(bytes_of(load_map(test::write_raw(folder_ / "map.vdb", expected))) == expected);
}

TEST_F(MapFile, EveryTruncationIsAnError) {
  const std::string bytes = bytes_of(test::sample_map());
  for (const std::string& whole : {bytes, with_foreign_id(bytes)}) {
    for (std::size_t size = 0; size < whole.size(); size += size < 4096 ? 1 : 101) {
      const std::string message = load_error(whole.substr(0, size));
      EXPECT_TRUE(message.starts_with("damaged.vdb: ")) << size << " of " << whole.size() << " bytes: " << message;
    }
  }
}

TEST_F(MapFile, IsKnownWithoutBeingRead) {
  save_map(folder_ / "map.vdb", test::sample_map());
  EXPECT_TRUE(is_map_file(folder_ / "map.vdb"));
  test::write_raw(folder_ / "text.vdb", "no grids here");
  EXPECT_EQ(io_error_of([&] { is_map_file(folder_ / "text.vdb"); }), "text.vdb: is not an OpenVDB file");
}

TEST_F(MapFile, StandardGridsWithTheMetadataOfAMapAreNoMap) {
  auto grid = openvdb::FloatGrid::create();
  grid->setName("voxels");
  write_vdb(folder_ / "channels.vdb", {grid}, metadata_of_map({}));
  EXPECT_FALSE(is_map_file(folder_ / "channels.vdb"));
}

TEST_F(MapFile, ASchemeOfLabelsNobodyKnowsIsUnknown) {
  openvdb::MetaMap metadata;
  EXPECT_EQ(label_scheme_of_metadata(metadata), LabelScheme::kUnknown);
  metadata.insertMeta("label_scheme", openvdb::StringMetadata("cityscapes"));
  EXPECT_EQ(label_scheme_of_metadata(metadata), LabelScheme::kUnknown);
  metadata.removeMeta("label_scheme");
  metadata.insertMeta("label_scheme", openvdb::StringMetadata("asprs"));
  EXPECT_EQ(label_scheme_of_metadata(metadata), LabelScheme::kAsprs);
}

TEST_F(MapFile, EveryFlippedByteIsAnError) {
  const std::string bytes = bytes_of(test::sample_map());
  const std::size_t step = test::kIsSanitized ? 11 : 1;
  for (std::size_t i = 0; i < bytes.size(); i += step * (i < 4096 ? 1 : 37)) {
    std::string flipped = bytes;
    flipped[i] = static_cast<char>(~flipped[i]);
    if (i >= 21 && i < 35) continue;  // then the id does not say that it is a checksum
    EXPECT_NE(load_error(flipped), "no error") << "byte " << i;
  }
}

TEST_F(MapFile, OtherFilesAreRefusedWithTheReason) {
  EXPECT_EQ(load_error(""), "damaged.vdb: is not an OpenVDB file");
  EXPECT_EQ(load_error("ply\nformat ascii 1.0\n"), "damaged.vdb: is not an OpenVDB file");
  EXPECT_EQ(io_error_of([&] { load_map(folder_ / "missing.vdb"); }),
            "missing.vdb: cannot open: No such file or directory");
  EXPECT_NE(io_error_of([&] { load_map(folder_.path()); }).find("cannot read: Is a directory"), std::string::npos);
}

TEST_F(MapFile, FilesOfOtherProgramsAreRefusedWithTheReason) {
  const auto data = test::real_data_folder();
  if (!data) GTEST_SKIP() << test::kNeedsRealData;
  std::size_t num_files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(*data / "vdb")) {
    const std::string message = io_error_of([&] { load_map(entry.path()); });
    EXPECT_EQ(message, entry.path().filename().string() +
                           ": is an OpenVDB file but not a map of vdbmap: it has no 'map_format'");
    ++num_files;
  }
  EXPECT_EQ(num_files, 3u);
}

// What another OpenVDB program may do with a grid of ours, and say nothing.
using Change = void (*)(openvdb::GridBase& grid);

struct ChangedGrid {
  const char* name;
  Change change;
};

class ChangedMap : public MapFile, public testing::WithParamInterface<ChangedGrid> {
 protected:
  // The error of loading a map of which one level's voxels were changed; those of the other stay.
  std::string error_after(const std::string& grid_name) const {
    save_map(folder_ / "map.vdb", test::sample_map());
    const VdbContent content = read_vdb(folder_ / "map.vdb");
    openvdb::GridCPtrVec grids;
    for (const openvdb::GridBase::Ptr& grid : content.grids) {
      if (grid->getName() == grid_name) GetParam().change(*grid);
      grids.push_back(grid);
    }
    write_vdb(folder_ / "map.vdb", grids, *content.metadata);
    return io_error_of([&] { load_map(folder_ / "map.vdb"); });
  }
};

TEST_P(ChangedMap, IsRefused) {
  for (const std::string name : {"voxels", "voxels_1m"}) {
    const std::string message = error_after(name);
    EXPECT_EQ(message.find("map.vdb: grid '" + name + "' has "), 0U) << message;
  }
}

const ChangedGrid kChangedGrids[] = {
    {"Moved",
     [](auto& grid) {
       grid.transform().postTranslate({10, 0, 0});
     }},
    {"MovedByHalfAVoxel",
     [](auto& grid) {
       grid.transform().preTranslate({0, 0.5, 0});
     }},
    {"MovedByAMillimetre",
     [](auto& grid) {
       grid.transform().postTranslate({0, 0, 1e-3});
     }},
    {"Turned", [](auto& grid) { grid.transform().postRotate(0.1, openvdb::math::Z_AXIS); }},
    {"TurnedByAQuarter", [](auto& grid) { grid.transform().postRotate(1.5707963267948966, openvdb::math::Z_AXIS); }},
    {"Mirrored",
     [](auto& grid) {
       grid.transform().postScale({1, 1, -1});
     }},
    {"TwiceAsLarge", [](auto& grid) { grid.transform().postScale(2.0); }},
    {"InMillimetres", [](auto& grid) { grid.transform().postScale(1000.0); }},
    {"HigherOnly",
     [](auto& grid) {
       grid.transform().postScale({1, 1, 2});
     }},
    {"Sheared", [](auto& grid) { grid.transform().postShear(0.2, openvdb::math::X_AXIS, openvdb::math::Y_AXIS); }},
    {"InAFrustum", [](auto& grid) {
       grid.setTransform(
           openvdb::math::Transform::createFrustumTransform(openvdb::BBoxd({0, 0, 0}, {9, 9, 9}), 0.5, 10, 0.4));
     }}};

INSTANTIATE_TEST_SUITE_P(Changes, ChangedMap, testing::ValuesIn(kChangedGrids),
                         [](const auto& change) { return std::string(change.param.name); });

TEST_F(MapFile, NumbersThatAreNoneAreRefusedAsByImport) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  std::vector<std::pair<std::size_t, float>> bad_elements = {{0, infinity}, {5, -infinity}};
  for (std::size_t element = 0; element < 6; ++element) bad_elements.emplace_back(element, nan);
  for (const auto& [element, bad] : bad_elements) {
    VoxelMap map = test::sample_map();
    map.levels[0].records()[3].covariance[element] = bad;
    save_map(folder_ / "map.vdb", map);
    EXPECT_EQ(io_error_of([&] { load_map(folder_ / "map.vdb"); }),
              "map.vdb: grid 'voxels' has a voxel whose covariance is not finite");
    export_channels(folder_ / "channels.vdb", map);
    EXPECT_NE(io_error_of([&] { import_channels(folder_ / "channels.vdb"); }).find("is not finite"), std::string::npos);
  }
  VoxelMap map = test::sample_map();
  map.levels[0].records()[3].covariance[1] = -1;
  save_map(folder_ / "map.vdb", map);
  EXPECT_EQ(io_error_of([&] { load_map(folder_ / "map.vdb"); }),
            "map.vdb: grid 'voxels' has a voxel whose variance is negative");
}

TEST_F(MapFile, LevelsThatAreNoMultiplesAreRefused) {
  VoxelMap map = test::sample_map();
  map.levels.push_back(map.levels.front());
  save_map(folder_ / "map.vdb", map);
  EXPECT_NE(io_error_of([&] { load_map(folder_ / "map.vdb"); }), "no error");
}

TEST_F(MapFile, AFullDiskLeavesTheOldFile) {
  const VoxelMap map = test::sample_map();
  const std::size_t size = bytes_of(map).size();
  std::filesystem::remove(folder_ / "bytes.vdb");
  test::write_raw(folder_ / "map.vdb", "old");
  for (const std::size_t limit : {std::size_t{0}, std::size_t{30}, size / 2, size - 1}) {
    const FileSizeLimit full(limit);
    try {
      save_map(folder_ / "map.vdb", map);
      ADD_FAILURE() << "no error at " << limit << " bytes";
    } catch (const IoError& error) {
      EXPECT_EQ(error.kind(), IoError::Kind::kSystem) << error.what();
      EXPECT_NE(std::string(error.what()).find("map.vdb: cannot write"), std::string::npos) << error.what();
    }
    EXPECT_TRUE(test::read_raw(folder_ / "map.vdb") == "old");
    EXPECT_EQ(num_files(), 1u);
  }
}

TEST_F(MapFile, AFullTemporaryFileSystemLeavesNothing) {
  const std::filesystem::path mount = folder_ / "full";
  std::filesystem::create_directory(mount);
  if (::mount("tmpfs", mount.c_str(), "tmpfs", 0, "size=16k") != 0) GTEST_SKIP() << "may not mount a tmpfs";
  EXPECT_EQ(io_error_of([&] { save_map(mount / "map.vdb", test::sample_map()); }).substr(0, 21),
            "map.vdb: cannot write");
  EXPECT_TRUE(std::filesystem::is_empty(mount));
  ::umount(mount.c_str());
}

TEST_F(MapFile, AFolderThatIsNotThereIsASystemError) {
  try {
    save_map(folder_ / "missing" / "map.vdb", test::sample_map());
    ADD_FAILURE() << "no error";
  } catch (const IoError& error) {
    EXPECT_EQ(error.kind(), IoError::Kind::kSystem);
  }
}

}  // namespace
}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/laz_bytes.h"
#include "tests/support/laz_records.h"
#include "tests/support/raw_files.h"
#include "tests/support/run_command.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/io/las/las.h"
#include "vdbmap/io/vdb/map_file.h"

namespace vdbmap {
namespace {

using test::point_records;
using test::read_raw;

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder, const std::string& extension) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == extension) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

// Real files of several writers: $VDBMAP_DATA/laz.
class LazData : public testing::Test {
 protected:
  void SetUp() override {
    const auto folder = test::real_data_folder();
    if (!folder) GTEST_SKIP() << test::kNeedsRealData;
    data_ = *folder;
    files_ = files_in(data_ / "laz", ".laz");
    ASSERT_FALSE(files_.empty());
  }

  // The LAS file with the same points; an empty path where there is none.
  std::filesystem::path twin(const std::filesystem::path& laz) const {
    for (const char* folder : {"laz", "las"}) {
      const auto las = (data_ / folder / laz.stem()).concat(".las");
      if (std::filesystem::exists(las)) return las;
    }
    return {};
  }

  std::string map_of(const std::filesystem::path& file) const {
    const ReadResult read = read_las(file);
    EXPECT_TRUE(read.findings.empty()) << file << ": " << read.findings.at(0).text();
    BuildOptions options;
    options.voxel_sizes = {1, 8};
    options.epsg = read.epsg;
    const auto map = folder_ / "map.vdb";
    std::filesystem::remove(map);
    save_map(map, build_map(read.cloud, options));
    return read_raw(map);
  }

  std::filesystem::path data_;
  std::vector<std::filesystem::path> files_;
  test::TemporaryFolder folder_;
};

TEST_F(LazData, EveryFileGivesTheSameMapAsItsLasByteForByte) {
  int num_compared = 0;
  for (const auto& laz : files_) {
    const auto las = twin(laz);
    if (las.empty()) continue;
    SCOPED_TRACE(laz.filename());
    ++num_compared;
    EXPECT_TRUE(point_records(laz) == point_records(las));
    if (point_records(las).empty()) {
      EXPECT_THROW(read_las(laz), IoError);
      continue;
    }
    EXPECT_TRUE(map_of(laz) == map_of(las));
  }
  EXPECT_GE(num_compared, 9);
}

TEST_F(LazData, CopcHoldsThePointsOfItsLasInAnotherOrder) {
  const auto sorted = [](const std::filesystem::path& file) {
    const PointCloud cloud = read_las(file).cloud;
    std::vector<std::vector<double>> points;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Eigen::Vector3d& p = cloud.positions[i];
      const Rgb16& c = cloud.colors[i];
      points.push_back({cloud.times[i], p.x(), p.y(), p.z(), cloud.intensities[i], 1. * cloud.labels[i], 1. * c.r,
                        1. * c.g, 1. * c.b});
    }
    std::ranges::sort(points);
    return points;
  };
  const auto copc = sorted(data_ / "laz/simple.copc.laz");
  const auto las = sorted(data_ / "laz/simple.las");
  ASSERT_EQ(copc.size(), las.size());
  for (std::size_t i = 0; i < las.size(); ++i) {
    for (std::size_t k = 0; k < las[i].size(); ++k) ASSERT_NEAR(copc[i][k], las[i][k], 1e-6) << i << " " << k;
  }
}

// --- laz-perf, another reader of LAZ: npm ci in tests/exchange installs it

const std::string kExchange = VDBMAP_SOURCE_DIR "/tests/exchange/";

class LazPerf : public testing::Test {
 protected:
  void SetUp() override {
    const bool is_installed = std::filesystem::exists(kExchange + "node_modules/laz-perf") &&
                              test::run_command("/usr/bin/env", {"node", "--version"}).exit_code == 0;
    if (!is_installed) GTEST_SKIP() << "laz-perf is not installed (npm ci in tests/exchange)";
  }

  void expect_same_records(const std::filesystem::path& laz) const {
    const auto result =
        test::run_command("/usr/bin/env", {"node", kExchange + "laz_perf.js", laz, folder_ / "records"});
    ASSERT_EQ(result.exit_code, 0) << laz << ": " << result.err;
    EXPECT_TRUE(point_records(laz) == read_raw(folder_ / "records")) << laz;
  }

  test::TemporaryFolder folder_;
};

TEST_F(LazPerf, ReadsEveryFieldOfEveryPointOfOurOwnFilesTheSame) {
  for (const unsigned format : {0, 1, 2, 3, 6, 7, 8}) {
    for (const std::size_t num_extra_bytes : {0, 4}) {
      const std::string las = test::random_las(format, 10000, num_extra_bytes, 21 + format);
      test::LazLayout layout;
      layout.points_per_chunk = 3000;
      if (num_extra_bytes > 0) layout.chunk_sizes = {1, 4000, 5999};
      expect_same_records(test::write_raw(folder_ / "a.laz", test::compress_las(las, layout)));
    }
  }
}

TEST_F(LazPerf, ReadsEveryFieldOfEveryPointOfRealFilesTheSame) {
  const auto data = test::real_data_folder();
  if (!data) GTEST_SKIP() << test::kNeedsRealData;
  for (const auto& laz : files_in(*data / "laz", ".laz")) {
    // laz-perf does not read the first LASzip's files.
    if (laz.stem() != "point-version-1-point-wise") expect_same_records(laz);
  }
}

}  // namespace
}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
// What all formats that can be written have in common.
#include <algorithm>
#include <functional>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "vdbmap/io/kitti/kitti_bin.h"
#include "vdbmap/io/las/las.h"
#include "vdbmap/io/pcd/pcd.h"
#include "vdbmap/io/ply/ply.h"
#include "vdbmap/io/table/xyz.h"

namespace vdbmap {
namespace {

namespace fs = std::filesystem;

struct Format {
  std::string name;
  std::string extension;
  std::function<void(const fs::path&, const PointCloud&)> write;
  double tolerance = 0;      ///< [m] of a coordinate near the origin
  double far_tolerance = 0;  ///< [m] of a coordinate of 5800 km
  bool keeps_colors = true;
  bool keeps_times = true;
  bool keeps_rings = true;
  bool keeps_labels = true;
  bool may_be_shorter = false;  ///< the format states no number of points, or what is left of them is read
  bool is_text = false;         ///< the last number may lose digits unnoticed
};

void PrintTo(const Format& format, std::ostream* stream) { *stream << format.name; }

std::vector<Format> all_formats() {
  Format ply_ascii{"PlyAscii", ".ply", [](auto& path, auto& cloud) { write_ply(path, cloud, PlyEncoding::kAscii); }};
  ply_ascii.is_text = true;
  Format ply_binary{"PlyBinary", ".ply", [](auto& path, auto& cloud) { write_ply(path, cloud); }};
  Format pcd_ascii{"PcdAscii", ".pcd", [](auto& path, auto& cloud) { write_pcd(path, cloud, PcdEncoding::kAscii); }};
  pcd_ascii.is_text = true;
  Format pcd_binary{"PcdBinary", ".pcd", [](auto& path, auto& cloud) { write_pcd(path, cloud); }};
  Format pcd_compressed{"PcdCompressed", ".pcd",
                        [](auto& path, auto& cloud) { write_pcd(path, cloud, PcdEncoding::kBinaryCompressed); }};
  Format xyz{"Xyz", ".xyz", [](auto& path, auto& cloud) { write_xyz(path, cloud); }};
  xyz.is_text = true;
  xyz.may_be_shorter = true;

  Format las{"Las", ".las", [](auto& path, auto& cloud) { write_las(path, cloud); }};
  las.tolerance = las.far_tolerance = 0.00005001;  // half its resolution, and the rounding of doubles
  las.keeps_rings = false;
  las.may_be_shorter = true;

  Format kitti{"KittiBin", ".bin", [](auto& path, auto& cloud) { write_kitti_bin(path, cloud); }};
  kitti.far_tolerance = 0.25;  // half a float's step at 5800 km
  kitti.keeps_colors = kitti.keeps_times = kitti.keeps_rings = kitti.keeps_labels = false;
  kitti.may_be_shorter = true;
  return {ply_ascii, ply_binary, pcd_ascii, pcd_binary, pcd_compressed, xyz, las, kitti};
}

// Numbers that each format can hold: fractions of two, colours of 8 bits, labels below 32.
PointCloud small_cloud() {
  PointCloud cloud;
  cloud.positions = {{1.5, -2.25, 0.125}, {-30, 40.5, 2}, {0, 0, 0}};
  cloud.colors = {{0, 257, 65535}, {257 * 128, 257 * 17, 0}, {65535, 65535, 65535}};
  cloud.intensities = {0, 17, 255};
  cloud.times = {1000.5, 1000.75, 1001.25};
  cloud.rings = {0, 15, 63};
  cloud.labels = {2, 6, 31};
  return cloud;
}

class PointFormats : public testing::TestWithParam<Format> {
 protected:
  fs::path path() const { return folder_ / ("scan" + GetParam().extension); }

  ReadResult round_trip(const PointCloud& cloud) const {
    GetParam().write(path(), cloud);
    return read_points(path());
  }

  // Reads bytes that may be damaged: what is whole, or nothing where that is refused in one clear line.
  std::optional<ReadResult> try_read(const std::string& bytes) const {
    try {
      return read_points(test::write_raw(path(), bytes));
    } catch (const IoError& error) {
      const std::string message = error.what();
      EXPECT_TRUE(message.starts_with(path().string() + ":")) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      return std::nullopt;
    }
  }

  test::TemporaryFolder folder_;
};

TEST_P(PointFormats, ReadBackWhatTheyWrote) {
  const Format& format = GetParam();
  const PointCloud cloud = small_cloud();
  const ReadResult result = round_trip(cloud);

  EXPECT_EQ(result.dropped.size(), 0u);
  ASSERT_EQ(result.cloud.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d error = result.cloud.positions[i] - cloud.positions[i];
    EXPECT_LE(error.cwiseAbs().maxCoeff(), format.tolerance);
  }
  EXPECT_EQ(result.cloud.intensities, cloud.intensities);
  EXPECT_EQ(result.cloud.colors, format.keeps_colors ? cloud.colors : std::vector<Rgb16>{});
  EXPECT_EQ(result.cloud.times, format.keeps_times ? cloud.times : std::vector<double>{});
  EXPECT_EQ(result.cloud.rings, format.keeps_rings ? cloud.rings : std::vector<std::uint16_t>{});
  EXPECT_EQ(result.cloud.labels, format.keeps_labels ? cloud.labels : std::vector<std::uint16_t>{});
}

TEST_P(PointFormats, KeepCoordinatesFarFromTheOrigin) {
  PointCloud cloud;
  cloud.positions = {{500000.1234, 5800000.4567, 61.789}, {500100.0001, 5800000.3, -1.001}};
  const PointCloud read = round_trip(cloud).cloud;

  ASSERT_EQ(read.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_LE((read.positions[i] - cloud.positions[i]).cwiseAbs().maxCoeff(), GetParam().far_tolerance);
  }
}

TEST_P(PointFormats, KeepManyPointsInOrder) {
  PointCloud cloud;
  for (int i = 0; i < 3000; ++i) cloud.positions.emplace_back(i, -i, 0.25 * i);
  const PointCloud read = round_trip(cloud).cloud;

  ASSERT_EQ(read.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_LE((read.positions[i] - cloud.positions[i]).cwiseAbs().maxCoeff(), GetParam().tolerance);
  }
}

TEST_P(PointFormats, WriteTheSameBytesAgain) {
  GetParam().write(folder_ / "first", small_cloud());
  GetParam().write(folder_ / "second", small_cloud());
  EXPECT_EQ(test::read_raw(folder_ / "first"), test::read_raw(folder_ / "second"));
}

TEST_P(PointFormats, AreRefusedOrFoundDamagedWhenCutAnywhere) {
  const Format& format = GetParam();
  format.write(path(), small_cloud());
  const std::string bytes = test::read_raw(path());

  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::optional<ReadResult> read = try_read(bytes.substr(0, size));
    if (!read) continue;
    const bool is_damaged = std::ranges::any_of(read->findings, &ReadFinding::is_damage);
    const bool may_have_lost_digits = format.is_text && bytes.find('\n', size) + 1 == bytes.size();
    EXPECT_TRUE(is_damaged || format.may_be_shorter || may_have_lost_digits)
        << "read from " << size << " of " << bytes.size();
    EXPECT_LE(read->cloud.size(), small_cloud().size());
  }
}

TEST_P(PointFormats, SurviveAnyDamagedByte) {
  GetParam().write(path(), small_cloud());
  const std::string bytes = test::read_raw(path());

  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (const int damage : {0x00, 0x39, 0x7f, 0x80, 0xff}) {
      std::string damaged = bytes;
      damaged[i] = static_cast<char>(damage);
      const auto read = try_read(damaged);
      EXPECT_LE(read ? read->cloud.size() : 0, bytes.size());
    }
  }
}

TEST_P(PointFormats, WriteNothingWhereTheyCannotFinish) {
  EXPECT_THROW(GetParam().write(path(), PointCloud{}), std::invalid_argument);

  PointCloud uneven = small_cloud();
  uneven.rings.pop_back();
  EXPECT_THROW(GetParam().write(path(), uneven), std::invalid_argument);

  PointCloud infinite = small_cloud();
  infinite.positions[1].z() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(GetParam().write(path(), infinite), std::invalid_argument);

  EXPECT_THROW(GetParam().write(folder_ / "missing" / "scan", small_cloud()), IoError);
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

INSTANTIATE_TEST_SUITE_P(, PointFormats, testing::ValuesIn(all_formats()),
                         [](const auto& format) { return format.param.name; });

}  // namespace
}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/las/las_pieces.h"

#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/las_bytes.h"
#include "tests/support/laz_bytes.h"
#include "tests/support/raw_files.h"
#include "vdbmap/core/cloud_append.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/las/las.h"

namespace vdbmap {
namespace {

// Only points late in the file have an intensity, a class and a colour above 8 bits, as `late` says.
test::LasBytes file_of(std::size_t num_points, const test::LasPoint& late) {
  test::LasBytes file;
  file.format = 3;
  for (std::size_t i = 0; i < num_points; ++i) {
    test::LasPoint point;
    point.x = static_cast<std::int32_t>(i);
    point.y = static_cast<std::int32_t>(7 * i);
    point.time = static_cast<double>(i);
    point.green = 100;
    if (i + 3 == num_points) {
      const auto x = point.x;
      point = late;
      point.x = x;
    }
    file.points.push_back(point);
  }
  return file;
}

class LasPiecesTest : public testing::Test {
 protected:
  std::filesystem::path write(const test::LasBytes& file) const {
    return test::write_raw(folder_ / "large.las", file.bytes());
  }

  std::filesystem::path write(const std::string& las, const test::LazLayout& layout) const {
    return test::write_raw(folder_ / "large.laz", test::compress_las(las, layout));
  }

  // All pieces together must be what reading the whole file gives.
  static void expect_whole(const std::filesystem::path& path, std::size_t most_points, std::size_t num_pieces,
                           std::size_t largest_piece) {
    const ReadResult whole = read_points(path);
    std::optional<LasPieces> pieces = LasPieces::open(path, {}, most_points);
    ASSERT_TRUE(pieces);
    PointCloud cloud;
    std::size_t count = 0;
    while (!pieces->is_at_end()) {
      const ReadResult piece = pieces->next();
      EXPECT_LE(piece.cloud.size(), largest_piece);
      EXPECT_EQ(piece.findings, whole.findings);
      EXPECT_EQ(piece.epsg, whole.epsg);
      EXPECT_EQ(piece.label_scheme, whole.label_scheme);
      EXPECT_EQ(piece.metres_per_unit, whole.metres_per_unit);
      if (count++ == 0) {
        cloud = piece.cloud;
      } else {
        append_cloud(cloud, piece.cloud, Eigen::Isometry3d::Identity());
      }
    }
    EXPECT_EQ(count, num_pieces);
    EXPECT_EQ(cloud.positions, whole.cloud.positions);
    EXPECT_EQ(cloud.colors, whole.cloud.colors);
    EXPECT_EQ(cloud.intensities, whole.cloud.intensities);
    EXPECT_EQ(cloud.labels, whole.cloud.labels);
    EXPECT_EQ(cloud.times, whole.cloud.times);
  }

  static void expect_whole(const std::filesystem::path& path, std::size_t most_points, std::size_t num_pieces) {
    expect_whole(path, most_points, num_pieces, most_points);
  }

  test::TemporaryFolder folder_;
};

TEST_F(LasPiecesTest, AreTogetherTheWholeFile) {
  expect_whole(write(file_of(100, {.intensity = 5, .classification = 6, .red = 60'000})), 30, 4);
  expect_whole(write(file_of(90, {.blue = 255})), 30, 3);  // 8 bits
  expect_whole(write(file_of(91, {})), 90, 2);
  test::LasBytes dark = file_of(100, {});
  for (test::LasPoint& point : dark.points) point.green = 0;
  expect_whole(write(dark), 99, 2);
}

TEST_F(LasPiecesTest, OfMoreBytesThanAreReadAtOnce) {
  expect_whole(write(file_of(200'000, {.intensity = 5})), 60'000, 4);
}

TEST_F(LasPiecesTest, OfCompressedPointsAreChunks) {
  const std::string las = file_of(100, {.intensity = 5, .classification = 6, .red = 60'000}).bytes();
  expect_whole(write(las, {.points_per_chunk = 10, .chunk_sizes = {}}), 30, 4);
  expect_whole(write(las, {.points_per_chunk = 20, .chunk_sizes = {}}), 45, 3);
  expect_whole(write(las, {.points_per_chunk = 40, .chunk_sizes = {}}), 30, 3, 40);
  expect_whole(write(las, {.chunk_sizes = {5, 70, 10, 1, 14}}), 30, 3, 70);
  expect_whole(write(las, {.points_per_chunk = 10, .chunk_sizes = {}, .has_offset_behind = true}), 30, 4);
  expect_whole(write(file_of(90, {.blue = 255}).bytes(), {.points_per_chunk = 30, .chunk_sizes = {}}), 30,
               3);  // 8 bits
  for (const unsigned format : {0, 2, 6, 7, 8}) {
    expect_whole(write(test::random_las(format, 30'000, 3, format), {.points_per_chunk = 999, .chunk_sizes = {}}),
                 7'000, 5);
  }
}

TEST_F(LasPiecesTest, AreNotOfCompressedPointsThatAreNotWhole) {
  const std::string las = file_of(100, {}).bytes();
  const test::LazLayout tens = {.points_per_chunk = 10, .chunk_sizes = {}};
  ASSERT_TRUE(LasPieces::open(write(las, tens), {}, 30));
  EXPECT_FALSE(LasPieces::open(write(las, tens), {}, 50));
  EXPECT_FALSE(LasPieces::open(write(las, {.version = 1, .is_chunked = false, .chunk_sizes = {}}), {}, 30));
  EXPECT_FALSE(LasPieces::open(write(file_of(100, {.classification = 0x80}).bytes(), tens), {}, 30));  // withheld
  EXPECT_FALSE(LasPieces::open(write(las, {.points_per_chunk = 10, .chunk_sizes = {}, .has_table = false}), {}, 30));
  const std::string laz = test::compress_las(las, tens);
  std::size_t num_damaged = 0;
  for (std::size_t i = laz.size() / 2; i < laz.size() - 60; i += 7) {
    std::string changed = laz;
    changed[i] = static_cast<char>(changed[i] ^ 0x10);
    const auto path = test::write_raw(folder_ / "changed.laz", changed);
    if (read_points(path).findings.empty()) continue;  // what the byte says is possible, too
    ++num_damaged;
    EXPECT_FALSE(LasPieces::open(path, {}, 30)) << i;
  }
  EXPECT_GT(num_damaged, 5U);
}

TEST_F(LasPiecesTest, OfAFileThatEndsTooEarlyAreThosePointsThatAreThere) {
  std::string bytes = file_of(100, {}).bytes();
  bytes.resize(bytes.size() - 100);
  test::write_raw(folder_ / "large.las", bytes);
  expect_whole(folder_ / "large.las", 30, 4);
  EXPECT_THROW(LasPieces::open(folder_ / "large.las", {.strict = true}, 30), IoError);
}

TEST_F(LasPiecesTest, AreNotOfFilesThatMustBeReadWhole) {
  EXPECT_FALSE(LasPieces::open(write(file_of(100, {})), {}, 100));
  EXPECT_FALSE(LasPieces::open(write(file_of(100, {})), {.is_in_sensor_frame = true}, 30));
  EXPECT_FALSE(LasPieces::open(write(file_of(100, {.classification = 0x80})), {}, 30));  // withheld
  EXPECT_FALSE(LasPieces::open(test::write_raw(folder_ / "a.xyz", "1 2 3\n4 5 6\n7 8 9\n"), {}, 1));
}

}  // namespace
}  // namespace vdbmap

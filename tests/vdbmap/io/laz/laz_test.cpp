// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/las_bytes.h"
#include "tests/support/laz_bytes.h"
#include "tests/support/laz_records.h"
#include "tests/support/raw_files.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/io/las/las.h"

namespace vdbmap {
namespace {

using test::compress_las;
using test::io_error_of;
using test::LazLayout;
using test::point_records;
using test::random_las;
using test::write_raw;

void expect_same_points(const ReadResult& a, const ReadResult& b) {
  EXPECT_EQ(a.cloud.positions, b.cloud.positions);
  EXPECT_EQ(a.cloud.intensities, b.cloud.intensities);
  EXPECT_EQ(a.cloud.labels, b.cloud.labels);
  EXPECT_EQ(a.cloud.times, b.cloud.times);
  EXPECT_EQ(a.cloud.colors, b.cloud.colors);
  EXPECT_EQ(a.dropped, b.dropped);
  EXPECT_EQ(a.findings, b.findings);
  EXPECT_EQ(a.epsg, b.epsg);
  EXPECT_EQ(a.label_scheme, b.label_scheme);
  EXPECT_EQ(a.metres_per_unit, b.metres_per_unit);
}

class Laz : public testing::Test {
 protected:
  std::filesystem::path las_file(const std::string& las) const { return write_raw(folder_ / "a.las", las); }
  std::filesystem::path laz_file(const std::string& laz) const { return write_raw(folder_ / "a.laz", laz); }
  std::string error_of(const std::string& laz) const {
    return io_error_of([&] { read_las(laz_file(laz)); });
  }

  test::TemporaryFolder folder_;
};

// Point format and version of the items.
using Kind = std::tuple<unsigned, unsigned>;

class LazKinds : public Laz, public testing::WithParamInterface<Kind> {
 protected:
  unsigned format() const { return std::get<0>(GetParam()); }
  LazLayout layout() const { return {.version = std::get<1>(GetParam()), .chunk_sizes = {}}; }
  bool is_layered() const { return format() >= 6; }
};

INSTANTIATE_TEST_SUITE_P(, LazKinds,
                         testing::Values(Kind{0, 1}, Kind{1, 1}, Kind{2, 1}, Kind{3, 1}, Kind{0, 2}, Kind{1, 2},
                                         Kind{2, 2}, Kind{3, 2}, Kind{6, 3}, Kind{7, 3}, Kind{8, 3}, Kind{6, 4},
                                         Kind{7, 4}, Kind{8, 4}),
                         [](const auto& kind) {
                           return "Format" + std::to_string(std::get<0>(kind.param)) + "Version" +
                                  std::to_string(std::get<1>(kind.param));
                         });

TEST_P(LazKinds, EveryFieldOfEveryPointIsThatOfTheLasFile) {
  for (const std::size_t num_extra_bytes : {0, 5}) {
    const std::string las = random_las(format(), 20000, num_extra_bytes, 1 + num_extra_bytes);
    const std::string records = point_records(las_file(las));
    EXPECT_TRUE(point_records(laz_file(compress_las(las, layout()))) == records) << num_extra_bytes;
  }
}

TEST_P(LazKinds, ACloudIsThatOfTheLasFileHoweverItIsCutIntoChunks) {
  const std::string las = random_las(format(), 3000, 3, 7);
  const ReadResult expected = read_las(las_file(las));
  ASSERT_TRUE(expected.findings.empty());
  for (const std::size_t points_per_chunk : {1, 2, 999, 1000, 3000, 5000}) {
    LazLayout chunks = layout();
    chunks.points_per_chunk = points_per_chunk;
    SCOPED_TRACE(points_per_chunk);
    expect_same_points(read_las(laz_file(compress_las(las, chunks))), expected);
  }
  LazLayout variable = layout();
  variable.chunk_sizes = {1, 1499, 2, 1000, 498};
  expect_same_points(read_las(laz_file(compress_las(las, variable))), expected);
  LazLayout behind = layout();
  behind.has_offset_behind = true;
  expect_same_points(read_las(laz_file(compress_las(las, behind))), expected);
}

TEST_P(LazKinds, ChunksAreFoundWithoutTheirTableUnlessTheirSizesAreUnknown) {
  const std::string las = random_las(format(), 3000, 0, 8);
  ReadResult expected = read_las(las_file(las));
  LazLayout cut = layout();
  cut.points_per_chunk = 700;
  cut.has_table = false;
  const ReadResult fixed = read_las(laz_file(compress_las(las, cut)));
  expected.findings = {{"the table of the LAZ chunks is missing or damaged: they are searched one after the other", 0,
                        fixed.findings.at(0).first, true}};
  expect_same_points(fixed, expected);

  cut.chunk_sizes = {1000, 2000};
  const std::string variable = compress_las(las, cut);
  if (is_layered()) {
    expect_same_points(read_las(laz_file(variable)), expected);
  } else {
    const std::string error = error_of(variable);
    EXPECT_EQ(error.substr(0, error.find(" (byte")),
              "a.laz: no point can be read: the table of the LAZ chunks is missing or damaged, and nothing else says "
              "where they end");
  }
}

TEST_P(LazKinds, OneThreadAndTwoReadTheSame) {
  LazLayout chunks = layout();
  chunks.points_per_chunk = 100;
  const auto file = laz_file(compress_las(random_las(format(), 5000, 1, 9), chunks));
  const auto read_with = [&](std::size_t num_threads) {
    const ThreadLimit limit(num_threads);
    return read_las(file);
  };
  expect_same_points(read_with(1), read_with(2));
}

TEST_P(LazKinds, WithheldPointsAreLeftOutAcrossChunks) {
  std::string las = random_las(format(), 1000, 0, 10);
  const std::size_t points_at = load<std::uint32_t>(las.data() + 96);
  const std::size_t length = load<std::uint16_t>(las.data() + 105);
  for (const std::size_t place : {0, 99, 100, 555}) {
    char& flags = las[points_at + place * length + 15];
    flags = static_cast<char>(flags | (is_layered() ? 0x04 : 0x80));
  }
  LazLayout chunks = layout();
  chunks.points_per_chunk = 100;
  const ReadResult result = read_las(laz_file(compress_las(las, chunks)));
  EXPECT_EQ(result.dropped, (std::vector<std::size_t>{0, 99, 100, 555}));
  EXPECT_EQ(result.findings, (std::vector<ReadFinding>{{"withheld points left out", 4, "point 1"}}));
  expect_same_points(result, read_las(las_file(las)));
}

TEST_F(Laz, AFileOfTheFirstLaszipIsOneChunkWithoutATable) {
  for (const unsigned format : {0, 1, 2, 3}) {
    const std::string las = random_las(format, 2000, 2, 11);
    const std::string laz = compress_las(las, {.version = 1, .is_chunked = false, .chunk_sizes = {}});
    expect_same_points(read_las(laz_file(laz)), read_las(las_file(las)));
  }
}

TEST_F(Laz, ExtendedRecordsBehindTheTableAreRead) {
  test::LasBytes las;
  las.minor_version = 4;
  las.format = 6;
  las.global_encoding = 1 << 4;
  las.points = {{1, 2, 3}, {4, 5, 6}};
  las.extended_records = {
      {"LASF_Projection", 2112, "PROJCS[\"\",UNIT[\"foot\",0.3048],AUTHORITY[\"EPSG\",\"25832\"]]"}};
  const ReadResult result = read_las(laz_file(compress_las(las.bytes())));
  EXPECT_EQ(result.cloud.size(), 2U);
  EXPECT_TRUE(result.findings.empty());
  EXPECT_EQ(result.epsg, 25832);
  EXPECT_EQ(result.metres_per_unit, 0.3048);
}

TEST_F(Laz, AFileWithoutPointsIsRefusedAsSuch) {
  for (const unsigned format : {1, 7}) {
    EXPECT_EQ(error_of(compress_las(random_las(format, 0, 0, 1))), "a.laz: the file holds no points");
  }
}

TEST_F(Laz, PointsThatRepeatTakeLessThanAByteEach) {
  for (const unsigned format : {0, 6}) {
    test::LasBytes las;
    las.format = format;
    las.minor_version = format >= 6 ? 4 : 2;
    las.points.resize(100000, {5, 6, 7, 8, 9});
    const std::string laz = compress_las(las.bytes(), {.points_per_chunk = 100000, .chunk_sizes = {}});
    EXPECT_LT(laz.size(), las.points.size() / 50);
    expect_same_points(read_las(laz_file(laz)), read_las(las_file(las.bytes())));
  }
}

// --- What is refused

constexpr std::size_t kFormatAt = 104;

std::string with_byte(std::string bytes, std::size_t at, unsigned value) {
  bytes[at] = static_cast<char>(value);
  return bytes;
}

// Where the data of the record that describes the compression begins.
std::size_t laszip_data_at(const std::string& laz) { return laz.find("laszip encoded") - 2 + 54; }

TEST_F(Laz, PointsWithoutTheRecordOfTheirCompressionAreRefused) {
  EXPECT_EQ(error_of(with_byte(random_las(0, 10, 0, 1), kFormatAt, 0x80)),
            "a.laz: LAZ: the header says that the points are compressed, but the record that says how is missing");
}

TEST_F(Laz, CompressionOlderThanLaszipIsRefused) {
  EXPECT_EQ(error_of(with_byte(random_las(0, 10, 0, 1), kFormatAt, 0xc0)),
            "a.laz: byte 104: compressed by a program older than LASzip, which nothing reads any more");
}

TEST_F(Laz, WaveformsAreRefused) {
  test::LasBytes las;
  las.minor_version = 4;
  las.points = {{1, 2, 3}};
  las.records = {{"laszip encoded", 22204, std::string(40, '\0')}};
  for (const unsigned format : {4, 5, 9, 10}) {
    las.format = format;
    las.num_extra_bytes = format >= 9 ? 37 : 0;  // in place of the waveform and its colour
    EXPECT_EQ(error_of(with_byte(las.bytes(), kFormatAt, 0x80 | format)),
              "a.laz: LAZ: compressed waveforms (point format " + std::to_string(format) + ") are not read");
  }
}

TEST_F(Laz, OtherCompressorsCodersAndItemsAreRefused) {
  const std::string laz = compress_las(random_las(1, 10, 0, 1));
  const std::size_t at = laszip_data_at(laz);
  EXPECT_EQ(error_of(with_byte(laz, at, 3)), "a.laz: LAZ: compressor 3 of point format 1, expected 1 or 2");
  EXPECT_EQ(error_of(with_byte(laz, at + 2, 1)), "a.laz: LAZ: coder 1, expected 0");
  EXPECT_EQ(
      error_of(with_byte(laz, at + 38, 3)),
      "a.laz: LAZ: compressed items 6 of 20 bytes in version 3, 7 of 8 bytes in version 2, expected 6 of 20 bytes in "
      "version 3, 7 of 8 bytes in version 3");
  EXPECT_EQ(
      error_of(with_byte(laz, at + 32, 1)),
      "a.laz: LAZ: compressed items 6 of 20 bytes in version 2, expected 6 of 20 bytes in version 2, 7 of 8 bytes in "
      "version 2");
  std::string no_points = laz;
  no_points.replace(at + 12, 4, 4, '\0');
  EXPECT_EQ(error_of(no_points), "a.laz: LAZ: chunks of no points");
  const std::string layered = compress_las(random_las(6, 10, 0, 1));
  EXPECT_EQ(error_of(with_byte(layered, laszip_data_at(layered), 2)),
            "a.laz: LAZ: compressor 2 of point format 6, expected 3");
}

}  // namespace
}  // namespace vdbmap

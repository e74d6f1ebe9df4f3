// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/las.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/las_bytes.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/byte_reader.h"

namespace vdbmap {
namespace {

using test::geo_keys;
using test::LasBytes;

constexpr const char* kProjection = "LASF_Projection";

LasBytes two_points(unsigned format) {
  LasBytes las;
  las.format = format;
  las.minor_version = format >= 6 ? 4 : format >= 4 ? 3 : 2;
  las.points = {{-1000, 2000, 30, 400, 5, 123456.789, 1000, 2000, 65535},
                {std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::min(), 0, 65535, 31, -0.5,
                 0, 1, 2}};
  return las;
}

class Las : public testing::Test {
 protected:
  ReadResult read(const std::string& bytes) const {
    std::filesystem::remove(path_);
    std::ofstream(path_, std::ios::binary) << bytes;
    return read_las(path_);
  }

  ReadResult read_with_record(const std::string& user, std::uint16_t id, const std::string& data) const {
    LasBytes las = two_points(0);
    las.records = {{user, id, data}};
    return read(las.bytes());
  }

  std::string error_for(const std::string& bytes) const {
    try {
      read(bytes);
    } catch (const IoError& error) {
      EXPECT_EQ(error.kind(), IoError::Kind::kMalformed);
      return std::string(error.what()).substr(path_.string().size());
    }
    return "no error";
  }

  // The error after a number of the header was overwritten.
  template <Scalar T>
  std::string error_with(std::string bytes, std::size_t at, T value) const {
    bytes.replace(at, sizeof(T), std::string(reinterpret_cast<const char*>(&value), sizeof(T)));
    return error_for(bytes);
  }

  test::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "cloud.las";
};

class LasFormats : public Las, public testing::WithParamInterface<unsigned> {
 protected:
  bool has_time() const { return GetParam() == 1 || GetParam() >= 3; }
  bool has_color() const {
    return GetParam() == 2 || GetParam() == 3 || GetParam() == 5 || GetParam() == 7 || GetParam() == 8;
  }
};

INSTANTIATE_TEST_SUITE_P(, LasFormats, testing::Range(0U, 9U));

TEST_P(LasFormats, AttributesStandWhereTheSpecificationPutsThem) {
  for (const std::size_t num_extra_bytes : {0, 7}) {
    LasBytes las = two_points(GetParam());
    las.num_extra_bytes = num_extra_bytes;
    const PointCloud cloud = read(las.bytes()).cloud;

    ASSERT_EQ(cloud.size(), 2U);
    EXPECT_TRUE(cloud.positions[0].isApprox(Eigen::Vector3d(499990, 5800040, -85), 1e-15));
    EXPECT_TRUE(cloud.positions[1].isApprox(Eigen::Vector3d(500000 + 21474836.47, 5800000 - 42949672.96, -100), 1e-15));
    EXPECT_EQ(cloud.intensities, (std::vector<float>{400, 65535}));
    EXPECT_EQ(cloud.labels, (std::vector<std::uint16_t>{5, 31}));
    EXPECT_EQ(cloud.times, has_time() ? std::vector<double>({123456.789, -0.5}) : std::vector<double>());
    EXPECT_EQ(cloud.colors, has_color() ? std::vector<Rgb16>({{1000, 2000, 65535}, {0, 1, 2}}) : std::vector<Rgb16>());
    EXPECT_TRUE(cloud.rings.empty());
  }
}

TEST_P(LasFormats, ClassificationHasFiveBitsBelowFormatSixAndEightFromThere) {
  LasBytes las = two_points(GetParam());
  las.points[0].classification = 0xe2;  // 226, or class 2 with three flags
  EXPECT_EQ(read(las.bytes()).cloud.labels[0], GetParam() >= 6 ? 226 : 2);
}

TEST_P(LasFormats, TruncationAnywhereIsAnError) {
  LasBytes las = two_points(GetParam());
  las.records = {{kProjection, 34735, geo_keys({{3072, 25832}})}, {"somebody", 1, "anything"}};
  if (las.minor_version >= 4) las.extended_records = {{kProjection, 2112, "PROJCS[\"\",UNIT[\"m\",1]]"}};
  read(las.bytes());

  for (std::size_t size = las.bytes().size(); size-- > 0;) {
    std::filesystem::resize_file(path_, size);
    EXPECT_THROW(read_las(path_), IoError) << size;
  }
}

TEST_P(LasFormats, AnyDamagedByteOfHeaderAndRecordsIsReadOrRefusedButNeverCrashes) {
  LasBytes las = two_points(GetParam());
  las.records = {{kProjection, 34735, geo_keys({{3072, 25832}})}};
  if (las.minor_version >= 4) las.extended_records = {{kProjection, 2112, "PROJCS[\"\",UNIT[\"m\",1]]"}};
  const std::string whole = las.bytes();
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const char value : {'\x00', '\x7f', '\xff'}) {
      std::string damaged = whole;
      damaged[at] = value;
      try {
        EXPECT_LE(read(damaged).cloud.size(), 2U);
      } catch (const IoError&) {
      }
    }
  }
}

TEST_F(Las, CountsThatTheFileCannotHoldAreAnErrorBeforeMemoryIsTaken) {
  const std::string las12 = two_points(0).bytes();
  EXPECT_EQ(error_with(las12, 107, std::uint32_t{3}),
            ": byte 107: the header promises 3 points of 20 bytes, the file holds 2");
  EXPECT_NE(error_with(las12, 107, std::uint32_t{0xffffffff}).find("byte 107"), std::string::npos);

  const std::string las14 = two_points(6).bytes();
  // 2^63 points of 30 bytes are 0 bytes modulo 2^64.
  EXPECT_NE(error_with(las14, 247, std::uint64_t{1} << 63).find("byte 247"), std::string::npos);
  EXPECT_NE(error_with(las14, 247, ~std::uint64_t{0}).find("byte 247"), std::string::npos);
}

TEST_F(Las, OffsetsAndLengthsOutsideTheirRangeAreAnError) {
  const std::string las12 = two_points(0).bytes();
  EXPECT_EQ(error_with(las12, 96, std::uint32_t{226}), ": byte 96: points begin at byte 226, expected 227 to 267");
  EXPECT_EQ(error_with(las12, 96, std::uint32_t{268}), ": byte 96: points begin at byte 268, expected 227 to 267");
  EXPECT_EQ(error_with(las12, 94, std::uint16_t{226}),
            ": byte 94: header of 226 bytes, expected at least 227 in LAS 1.2");
  EXPECT_EQ(error_with(las12, 105, std::uint16_t{19}),
            ": byte 105: points of 19 bytes, expected at least 20 in format 0");
  EXPECT_EQ(error_with(las12, 105, std::uint16_t{0}),
            ": byte 105: points of 0 bytes, expected at least 20 in format 0");
  EXPECT_NE(error_with(las12, 100, std::uint32_t{0xffffffff}).find("ends too early"), std::string::npos);
  LasBytes with_record = two_points(0);
  with_record.records = {{"somebody", 1, "anything"}};
  EXPECT_EQ(error_with(with_record.bytes(), 96, std::uint32_t{227 + 54}),
            ": byte 227: variable length record 0 runs into the points, which begin at byte 281");

  LasBytes las14 = two_points(6);
  las14.extended_records = {{"somebody", 1, "anything"}};
  const std::size_t length_at = las14.bytes().size() - 8 - 32 - 8;
  EXPECT_NE(error_with(las14.bytes(), length_at, ~std::uint64_t{0}).find("ends too early"), std::string::npos);
  EXPECT_NE(error_with(las14.bytes(), 235, ~std::uint64_t{0}).find("lies beyond the end"), std::string::npos);
  EXPECT_NE(error_with(las14.bytes(), 243, std::uint32_t{2}).find("ends too early"), std::string::npos);
}

TEST_F(Las, OtherFilesVersionsFormatsAndScalesAreAnError) {
  const std::string las12 = two_points(0).bytes();
  EXPECT_EQ(error_with(las12, 0, 'X'), ": byte 0: not a LAS file: begins with 'XASF', expected 'LASF'");
  EXPECT_EQ(error_with(las12, 25, std::uint8_t{5}), ": byte 24: LAS version 1.5, expected 1.0 to 1.4");
  EXPECT_EQ(error_with(las12, 104, std::uint8_t{11}), ": byte 104: point format 11, expected 0 to 10");
  EXPECT_NE(error_with(las12, 139, 0.0).find(": byte 139: scale 0"), std::string::npos);
  EXPECT_NE(error_with(las12, 131, std::nan("")).find(": byte 131: scale nan"), std::string::npos);
  EXPECT_NE(error_with(las12, 171, HUGE_VAL).find(": byte 171: offset"), std::string::npos);
}

TEST_F(Las, CompressedPointsAreRefusedWithAdvice) {
  EXPECT_NE(
      error_with(two_points(3).bytes(), 104, std::uint8_t{0x83}).find("byte 104: LAZ compression is not supported"),
      std::string::npos);
  LasBytes las = two_points(0);
  las.records = {{"laszip encoded", 22204, std::string(52, '\1')}};
  EXPECT_NE(error_for(las.bytes()).find("LAZ compression is not supported: decompress"), std::string::npos);
}

TEST_F(Las, NoPointsAreAnError) {
  LasBytes las;
  EXPECT_EQ(error_for(las.bytes()), ": the file holds no points");
}

TEST_F(Las, CoordinatesThatOverflowAreDroppedWithTheirAttributesAndCounted) {
  LasBytes las = two_points(3);
  las.scale.x() = 1e304;
  las.points[0].x = 1;
  const ReadResult result = read(las.bytes());

  EXPECT_EQ(result.dropped.size(), 1U);
  EXPECT_EQ(result.cloud.intensities, (std::vector<float>{400}));
  EXPECT_EQ(result.cloud.times.size(), 1U);
}

TEST_F(Las, EightBitColorsAreWidened) {
  LasBytes las = two_points(2);
  las.points[0] = {.red = 255, .green = 1, .blue = 0};
  las.points[1] = {.red = 2, .green = 3, .blue = 4};
  EXPECT_EQ(read(las.bytes()).cloud.colors, (std::vector<Rgb16>{{65535, 257, 0}, {514, 771, 1028}}));
}

TEST_F(Las, AttributesThatAreZeroEverywhereCountAsUnknown) {
  LasBytes las = two_points(3);
  las.points = {{.x = 1}, {.x = 2}};
  const PointCloud cloud = read(las.bytes()).cloud;

  EXPECT_EQ(cloud.size(), 2U);
  EXPECT_TRUE(cloud.intensities.empty());
  EXPECT_TRUE(cloud.labels.empty());
  EXPECT_TRUE(cloud.colors.empty());
}

TEST_F(Las, Version14FallsBackToTheLegacyCount) {
  std::string bytes = two_points(6).bytes();
  bytes[107] = 2;
  bytes[247] = 0;
  EXPECT_EQ(read(bytes).cloud.size(), 2U);
}

TEST_F(Las, GeoTiffKeysGiveCodeAndUnit) {
  const auto result_for = [&](const std::string& keys) { return read_with_record(kProjection, 34735, keys); };

  const ReadResult metres = result_for(geo_keys({{1024, 1}, {2048, 4258}, {3072, 25832}, {3076, 9001}}));
  EXPECT_EQ(metres.epsg, 25832);
  EXPECT_EQ(metres.metres_per_unit, 1.0);
  EXPECT_EQ(result_for(geo_keys({{3072, 2994}, {3076, 9002}})).metres_per_unit, 0.3048);
  EXPECT_EQ(result_for(geo_keys({{3072, 2927}, {3076, 9003}})).metres_per_unit, 1200. / 3937);
  EXPECT_EQ(result_for(geo_keys({{1024, 2}, {2048, 4326}})).epsg, 4326);
  // Projected in a way that has no code: the geographic base is not the system of the coordinates.
  EXPECT_EQ(result_for(geo_keys({{1024, 1}, {2048, 4326}, {3072, 32767}})).epsg, std::nullopt);
  EXPECT_EQ(result_for(geo_keys({{1024, 1}, {2048, 4326}})).epsg, std::nullopt);
  EXPECT_EQ(result_for(geo_keys({})).epsg, std::nullopt);
  EXPECT_EQ(result_for(geo_keys({})).metres_per_unit, 1.0);
}

TEST_F(Las, StatePlaneCodesImplyTheirFeet) {
  const auto metres_per_unit = [&](std::uint16_t epsg) {
    return read_with_record(kProjection, 34735, geo_keys({{3072, epsg}})).metres_per_unit;
  };
  EXPECT_EQ(metres_per_unit(2222), 0.3048);        // Arizona
  EXPECT_EQ(metres_per_unit(2229), 1200. / 3937);  // California 5
  EXPECT_EQ(metres_per_unit(2289), 1200. / 3937);  // Wisconsin South
  EXPECT_EQ(metres_per_unit(2290), 1.0);           // Prince Edward Island
}

TEST_F(Las, GeoTiffKeysThatAreCutOffAreAnError) {
  for (const std::size_t size : {0, 7, 8, 15}) {
    LasBytes las = two_points(0);
    las.records = {{kProjection, 34735, geo_keys({{3072, 25832}}).substr(0, size)}};
    EXPECT_EQ(error_for(las.bytes()), ": the GeoTIFF keys are cut off") << size;
  }
}

TEST_F(Las, WktGivesCodeAndUnit) {
  const std::string wkt =
      "PROJCS[\"x\",GEOGCS[\"y\",AUTHORITY[\"EPSG\",\"4269\"]],UNIT[\"foot\",0.3048],AUTHORITY[\"EPSG\",\"2994\"]]";
  const ReadResult result = read_with_record(kProjection, 2112, wkt + std::string(3, '\0'));
  EXPECT_EQ(result.epsg, 2994);
  EXPECT_EQ(result.metres_per_unit, 0.3048);
  EXPECT_EQ(read_with_record("liblas", 2112, wkt).epsg, std::nullopt);

  LasBytes las14 = two_points(6);
  las14.extended_records = {{kProjection, 2112, wkt}};
  EXPECT_EQ(read(las14.bytes()).epsg, 2994);
}

TEST_F(Las, TheHeaderSaysWhetherWktOrGeoTiffKeysCount) {
  LasBytes las = two_points(0);
  las.records = {{kProjection, 34735, geo_keys({{3072, 25832}})},
                 {kProjection, 2112, "PROJCS[\"\",UNIT[\"foot\",0.3048],AUTHORITY[\"EPSG\",\"2994\"]]"}};
  EXPECT_EQ(read(las.bytes()).epsg, 25832);
  las.global_encoding = 0x10;
  EXPECT_EQ(read(las.bytes()).epsg, 2994);
}

struct Bounds {
  Eigen::Array3d lowest = Eigen::Array3d::Constant(HUGE_VAL);
  Eigen::Array3d highest = -lowest;
};

// What the header of a recorded file says of its points, read without the library under test.
Bounds bounds_of_header(const std::filesystem::path& path) {
  ByteReader file(path);
  file.seek(179);
  Bounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    bounds.highest[axis] = file.read_le<double>();
    bounds.lowest[axis] = file.read_le<double>();
  }
  return bounds;
}

Bounds bounds_of(const PointCloud& cloud) {
  Bounds bounds;
  for (const Eigen::Vector3d& position : cloud.positions) {
    bounds.lowest = bounds.lowest.min(position.array());
    bounds.highest = bounds.highest.max(position.array());
  }
  return bounds;
}

TEST_F(Las, RecordedFileInFeetWithoutCode) {
  const auto data = test::real_data_folder();
  if (!data) GTEST_SKIP() << test::kNeedsRealData;
  const ReadResult result = read_las(*data / "las" / "autzen_trim.las");

  EXPECT_EQ(result.cloud.size(), 110'000U);
  EXPECT_EQ(result.dropped.size(), 0U);
  EXPECT_EQ(result.epsg, std::nullopt);
  EXPECT_EQ(result.metres_per_unit, 0.3048);
  EXPECT_EQ(result.cloud.colors.size(), result.cloud.size());
  EXPECT_EQ(result.cloud.times.size(), result.cloud.size());

  const Bounds expected = bounds_of_header(*data / "las" / "autzen_trim.las");
  const Bounds bounds = bounds_of(result.cloud);
  EXPECT_TRUE(bounds.lowest.isApprox(expected.lowest, 1e-14));
  EXPECT_TRUE(bounds.highest.isApprox(expected.highest, 1e-14));
}

TEST_F(Las, RecordedFileWithCodeThatImpliesFeet) {
  const auto data = test::real_data_folder();
  if (!data) GTEST_SKIP() << test::kNeedsRealData;
  const ReadResult result = read_las(*data / "las" / "color_utm_feet.las");

  EXPECT_EQ(result.cloud.size(), 10'126U);
  EXPECT_EQ(result.epsg, 2229);
  EXPECT_EQ(result.metres_per_unit, 1200. / 3937);
  std::uint16_t brightest = 0;
  for (const Rgb16& color : result.cloud.colors) brightest = std::max({brightest, color.r, color.g, color.b});
  EXPECT_GT(brightest, 255);

  // A thinned file that kept the header of the whole: its points lie inside and nearly fill it.
  const Bounds whole = bounds_of_header(*data / "las" / "color_utm_feet.las");
  const Bounds bounds = bounds_of(result.cloud);
  EXPECT_TRUE((bounds.lowest >= whole.lowest).all() && (bounds.highest <= whole.highest).all());
  EXPECT_TRUE((bounds.highest - bounds.lowest >= 0.5 * (whole.highest - whole.lowest)).all());
}

}  // namespace
}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/las/las.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/las_bytes.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/las/las_header.h"

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

  // All that was found, after reading this number of points.
  std::string findings_of(const std::string& bytes, std::size_t num_points) const {
    const ReadResult result = read(bytes);
    EXPECT_EQ(result.cloud.size(), num_points);
    std::string text;
    for (const ReadFinding& finding : result.findings) {
      EXPECT_TRUE(finding.is_damage) << finding.text();
      text += (text.empty() ? "" : "; ") + finding.text();
    }
    return text;
  }

  template <Scalar T>
  std::string findings_with(std::string bytes, std::size_t at, T value, std::size_t num_points) const {
    bytes.replace(at, sizeof(T), std::string(reinterpret_cast<const char*>(&value), sizeof(T)));
    return findings_of(bytes, num_points);
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
  las.points[0].classification = 0x62;  // 98, or class 2 with two flags
  EXPECT_EQ(read(las.bytes()).cloud.labels[0], GetParam() >= 6 ? 98 : 2);
}

TEST_P(LasFormats, WithheldPointsAreLeftOutAndCounted) {
  LasBytes las = two_points(GetParam());
  las.points.push_back(las.points[0]);
  const bool has_byte_of_flags = GetParam() >= 6;
  las.points[1].classification = has_byte_of_flags ? 0xff : 0xff - 0x80;  // all but what withholds it
  las.points[1].flags = 0xff - 0x04;
  las.points[2].classification = has_byte_of_flags ? 5 : 5 + 0x80;
  las.points[2].flags = 0x04;
  const ReadResult result = read(las.bytes());

  EXPECT_EQ(result.cloud.size(), 2U);
  EXPECT_EQ(result.dropped, std::vector<std::size_t>{2});
  EXPECT_EQ(result.findings, (std::vector<ReadFinding>{{"withheld points left out", 1, "point 3"}}));
}

TEST_P(LasFormats, TruncationAnywhereLeavesTheWholePointsOrIsAnError) {
  LasBytes las = two_points(GetParam());
  las.records = {{kProjection, 34735, geo_keys({{3072, 25832}})}, {"somebody", 1, "anything"}};
  if (las.minor_version >= 4) las.extended_records = {{kProjection, 2112, "PROJCS[\"\",UNIT[\"m\",1]]"}};
  const std::size_t record_length = find_las_point_format(GetParam())->length;
  const std::size_t extended_size = las.minor_version >= 4 ? 60 + las.extended_records[0].data.size() : 0;
  EXPECT_TRUE(read(las.bytes()).findings.empty());
  const std::size_t end_of_points = las.bytes().size() - extended_size;

  for (std::size_t size = las.bytes().size(); size-- > 0;) {
    std::filesystem::resize_file(path_, size);
    if (size < end_of_points - record_length) {
      EXPECT_THROW(read_las(path_), IoError) << size;
      continue;
    }
    const ReadResult result = read_las(path_);
    ASSERT_EQ(result.cloud.size(), size < end_of_points ? 1U : 2U) << size;
    ASSERT_FALSE(result.findings.empty()) << size;
    for (const ReadFinding& finding : result.findings) ASSERT_TRUE(finding.is_damage) << finding.text();
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

TEST_F(Las, ACountThatIsNotTrueGivesThePointsThatAreThere) {
  const std::string las12 = two_points(0).bytes();
  EXPECT_EQ(findings_with(las12, 107, std::uint32_t{3}, 2),
            "1 points are missing that the header counts (the file ends after point 2)");
  EXPECT_EQ(findings_with(las12, 107, std::uint32_t{1}, 1),
            "1 points left out that the header does not count (point 2)");
  for (const std::uint32_t unknown : {0U, 0xffffffffU}) {  // as writers leave it that did not come to their end
    EXPECT_EQ(findings_with(las12, 107, unknown, 2), "2 points read that the header does not count");
    EXPECT_EQ(findings_with(las12 + std::string(19, '\1'), 107, unknown, 2),
              "2 points read that the header does not count");
  }

  const std::string las14 = two_points(6).bytes();
  // 2^63 points of 30 bytes are 0 bytes modulo 2^64.
  EXPECT_EQ(findings_with(las14, 247, std::uint64_t{1} << 63, 2),
            "9223372036854775806 points are missing that the header counts (first: the file ends after point 2)");
  for (const std::uint64_t unknown : {std::uint64_t{0}, ~std::uint64_t{0}}) {
    EXPECT_EQ(findings_with(las14, 247, unknown, 2), "2 points read that the header does not count");
  }
}

TEST_F(Las, OfTwoCountsTheOneCountsThatFitsTheFile) {
  std::string bytes = two_points(6).bytes();
  bytes[107] = 2;  // legacy
  EXPECT_EQ(findings_with(bytes, 247, std::uint64_t{2}, 2), "");
  EXPECT_EQ(findings_with(bytes, 247, std::uint64_t{700}, 2),
            "the header gives two numbers of points, 700 and 2 (2 are read)");
  EXPECT_EQ(findings_with(bytes, 247, std::uint64_t{1}, 2),
            "the header gives two numbers of points, 1 and 2 (2 are read)");
  bytes[107] = 7;
  EXPECT_EQ(findings_with(bytes, 247, std::uint64_t{2}, 2),
            "the header gives two numbers of points, 2 and 7 (2 are read)");
}

TEST_F(Las, PointsEndWhereExtendedRecordsBegin) {
  LasBytes las = two_points(6);
  las.extended_records = {{"somebody", 1, std::string(300, 'x')}};
  EXPECT_EQ(findings_with(las.bytes(), 247, std::uint64_t{0}, 2), "2 points read that the header does not count");
  EXPECT_EQ(findings_with(las.bytes(), 247, std::uint64_t{5}, 2),
            "3 points are missing that the header counts (first: the file ends after point 2)");
}

TEST_F(Las, OffsetsAndLengthsOutsideTheirRangeAreAnError) {
  const std::string las12 = two_points(0).bytes();
  EXPECT_EQ(error_with(las12, 96, std::uint32_t{226}), ": byte 96: points begin at byte 226, expected 227 to 267");
  EXPECT_EQ(error_with(las12, 96, std::uint32_t{268}), ": byte 96: points begin at byte 268, expected 227 to 267");
  EXPECT_EQ(error_with(las12, 105, std::uint16_t{19}),
            ": byte 105: points of 19 bytes, expected at least 20 in format 0");
  EXPECT_EQ(error_with(las12, 105, std::uint16_t{0}),
            ": byte 105: points of 0 bytes, expected at least 20 in format 0");
  EXPECT_EQ(error_with(two_points(6).bytes(), 96, std::uint32_t{374}),
            ": byte 96: points begin at byte 374, expected 375 to 435");
}

TEST_F(Las, PointsNeedNoSizeOfTheHeader) {
  LasBytes las = two_points(0);
  las.records = {{kProjection, 34735, geo_keys({{3072, 25832}})}};
  EXPECT_EQ(
      findings_with(las.bytes(), 94, std::uint16_t{226}, 2),
      "the header cannot be of 226 bytes, expected 227 to 297: its variable length records are not read (byte 94)");
  EXPECT_EQ(findings_with(las.bytes(), 94, std::uint16_t{0xffff}, 2),
            "the header cannot be of 65535 bytes, expected 227 to 297: its variable length records are not read "
            "(byte 94)");
  EXPECT_EQ(findings_with(two_points(6).bytes(), 94, std::uint16_t{0}, 2),
            "the header cannot be of 0 bytes, expected 375 to 375: its variable length records are not read (byte 94)");
}

TEST_F(Las, PointsNeedNoVariableLengthRecords) {
  LasBytes las = two_points(0);
  const std::string records = "variable length records that are damaged or missing left out";
  EXPECT_EQ(findings_with(las.bytes(), 100, std::uint32_t{7}, 2), "7 " + records + " (first: byte 227)");
  EXPECT_EQ(findings_with(las.bytes(), 100, ~std::uint32_t{0}, 2), "4294967295 " + records + " (first: byte 227)");

  las.records = {{kProjection, 34735, geo_keys({{3072, 25832}})}, {"somebody", 1, "anything"}};
  const std::size_t second_at = 227 + 54 + 16;
  std::string overlong = las.bytes();
  overlong[second_at + 20] = 9;  // its length, one byte into the points
  EXPECT_EQ(findings_of(overlong, 2), "1 " + records + " (byte 297)");
  EXPECT_EQ(read(overlong).epsg, 25832);

  LasBytes las14 = two_points(6);
  las14.extended_records = {{kProjection, 2112, "PROJCS[\"x\",AUTHORITY[\"EPSG\",\"25832\"]]"},
                            {"somebody", 1, "anything"}};
  const std::size_t extended_at = 375 + 2 * 30;
  const std::size_t length_at = las14.bytes().size() - 8 - 32 - 8;
  const std::string place = " (byte " + std::to_string(length_at - 20) + ")";
  EXPECT_EQ(findings_with(las14.bytes(), length_at, ~std::uint64_t{0}, 2), "1 extended " + records + place);
  EXPECT_EQ(read(las14.bytes()).epsg, 25832);
  for (const std::uint64_t offset : {std::uint64_t{0}, std::uint64_t{400}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
    EXPECT_EQ(findings_with(las14.bytes(), 235, offset, 2),
              "2 extended " + records + " (first: byte " + std::to_string(offset) + ")");
  }
  EXPECT_EQ(findings_with(las14.bytes(), 243, std::uint32_t{3}, 2),
            "1 extended " + records + " (byte " + std::to_string(las14.bytes().size()) + ")");
  EXPECT_LT(extended_at, length_at);
}

TEST_F(Las, PointsThatAreAllWithheldAreAnError) {
  LasBytes las = two_points(0);
  for (test::LasPoint& point : las.points) point.classification = 0x80;
  EXPECT_EQ(error_for(las.bytes()), ": all of its points are withheld");
}

TEST_F(Las, WithheldAndNonFinitePointsKeepTheirPlacesInTheFile) {
  LasBytes las = two_points(3);
  las.scale.x() = 1e304;
  las.points = {{.x = 1 << 30, .classification = 0x80}, {.x = 0, .classification = 0x80}, {.x = 0, .intensity = 7},
                {.x = 1 << 30, .classification = 0x80}, {.x = 0, .classification = 0x80}, {.x = 0, .intensity = 8}};
  const ReadResult result = read(las.bytes());
  EXPECT_EQ(result.dropped, (std::vector<std::size_t>{0, 1, 3, 4}));
  EXPECT_EQ(result.cloud.intensities, (std::vector<float>{7, 8}));
  EXPECT_EQ(result.num_non_finite, 2U);
  EXPECT_EQ(result.findings, (std::vector<ReadFinding>{{"withheld points left out", 2, "point 2"}}));
}

TEST_F(Las, Version10HasNoWithheldPoints) {
  LasBytes las = two_points(0);
  las.minor_version = 0;
  las.points[0].classification = 0x80;
  EXPECT_EQ(read(las.bytes()).cloud.size(), 2U);
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

TEST_F(Las, GeoTiffKeysThatAreCutOffSayNothing) {
  for (const std::size_t size : {0, 7, 8, 15}) {
    LasBytes las = two_points(0);
    las.records = {{kProjection, 34735, geo_keys({{3072, 25832}}).substr(0, size)}};
    EXPECT_EQ(findings_of(las.bytes(), 2), "the GeoTIFF keys are cut off and not used") << size;
    EXPECT_EQ(read(las.bytes()).epsg, std::nullopt);
  }
}

TEST_F(Las, DamagedWktSaysNothing) {
  const std::string wkt = "PROJCS[\"x\",UNIT[\"m\",1],AUTHORITY[\"EPSG\",\"25832\"]]";
  for (const std::string& damaged :
       {wkt.substr(0, wkt.size() - 1), wkt.substr(0, 20), wkt + "]", std::string("\1\2\3"), std::string()}) {
    LasBytes las = two_points(0);
    las.records = {{kProjection, 2112, damaged}};
    EXPECT_EQ(findings_of(las.bytes(), 2), "the WKT of the reference system is damaged and not used") << damaged;
    EXPECT_EQ(read(las.bytes()).epsg, std::nullopt);
  }
}

// Two points a metre apart in Berlin.
LasBytes points_in_degrees() {
  LasBytes las = two_points(0);
  las.scale = {1e-7, 1e-7, 0.01};
  las.offset.setZero();
  las.points = {{.x = 134000000, .y = 525000000, .z = 3500}, {.x = 134000147, .y = 525000000, .z = 3500}};
  return las;
}

TEST_F(Las, DegreesAreRefusedWithTheAdviceToProject) {
  const std::string geographic = "GEOGCS[\"WGS 84\",UNIT[\"degree\",0.0174],AUTHORITY[\"EPSG\",\"4326\"]]";
  const std::string newer = "GEOGCRS[\"WGS 84\",CS[ellipsoidal,2],AXIS[\"lat\",north],ID[\"EPSG\",4326]]";
  const std::vector<test::LasBytesRecord> records = {
      {kProjection, 34735, geo_keys({{1024, 2}, {2048, 4326}})},
      {kProjection, 34735, geo_keys({{2048, 4326}})},
      {kProjection, 34735, geo_keys({{1024, 1}, {3072, 4326}})},  // the code where that of a projection belongs
      {kProjection, 2112, geographic},
      {kProjection, 2112, newer},
      {kProjection, 2112, "COMPD_CS[\"with height\"," + geographic + ",VERT_CS[\"h\",UNIT[\"metre\",1]]]"},
      {kProjection, 2112, "COMPOUNDCRS[\"with height\"," + newer + ",VERTCRS[\"h\",CS[vertical,1]]]"}};
  for (const test::LasBytesRecord& record : records) {
    LasBytes las = points_in_degrees();
    las.records = {record};
    EXPECT_EQ(
        error_for(las.bytes()),
        ": its coordinates are degrees of longitude and latitude (EPSG:4326), not metres: project it to metres first, "
        "for example with 'pdal translate IN OUT reprojection --filters.reprojection.out_srs=EPSG:32632'")
        << record.data;
  }
  LasBytes las = points_in_degrees();
  las.records = {{kProjection, 34735, geo_keys({{1024, 1}, {3072, 25833}})}};
  EXPECT_EQ(findings_of(las.bytes(), 2), "");  // a small place that is said to be metres
}

TEST_F(Las, GeocentricCoordinatesAreRefused) {
  LasBytes las = two_points(0);
  las.scale.setConstant(0.01);
  las.offset = {3782000, 901000, 5038000};
  las.points = {{.x = 100}, {.x = 200}};
  for (const test::LasBytesRecord& record : std::vector<test::LasBytesRecord>{
           {kProjection, 34735, geo_keys({{1024, 3}, {2048, 4978}})},
           {kProjection, 2112, "GEOCCS[\"WGS 84\",UNIT[\"metre\",1]]"},
           {kProjection, 2112, "GEODCRS[\"WGS 84\",CS[Cartesian,3],ID[\"EPSG\",4978]]"}}) {
    las.records = {record};
    EXPECT_NE(error_for(las.bytes()).find("its coordinates are geocentric"), std::string::npos) << record.data;
    EXPECT_NE(error_for(las.bytes()).find("z does not point up"), std::string::npos) << record.data;
  }
}

TEST_F(Las, CoordinatesThatCannotBeDegreesAreMetresWhateverTheFileSays) {
  const ReadResult result = read_with_record(kProjection, 34735, geo_keys({{1024, 2}, {2048, 4326}}));
  EXPECT_EQ(result.cloud.size(), 2U);
  EXPECT_EQ(result.epsg, std::nullopt);
  ASSERT_EQ(result.findings.size(), 1U);
  EXPECT_EQ(
      result.findings[0].what,
      "the file says that its coordinates are degrees of longitude and latitude (EPSG:4326), but they are too large "
      "for that: taken as metres of an unknown system");
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/ply/ply.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"

namespace vdbmap {
namespace {

using test::io_error_of;
using test::raw;

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();
constexpr std::endian kBig = std::endian::big;

class Ply : public testing::Test {
 protected:
  ReadResult read(const std::string& bytes) const { return read_ply(test::write_raw(folder_ / "scan.ply", bytes)); }
  std::string error(const std::string& bytes) const {
    return io_error_of([&] { read(bytes); });
  }
  bool is_refused_or_damaged(const std::string& bytes) const {
    return error(bytes) != "no error" || std::ranges::any_of(read(bytes).findings, &ReadFinding::is_damage);
  }

  test::TemporaryFolder folder_;
};

// A header of one element 'vertex' with float x, y, z and more properties.
std::string header(const std::string& encoding, const std::string& count, const std::string& more = "") {
  return "ply\nformat " + encoding + " 1.0\nelement vertex " + count +
         "\nproperty float x\nproperty float y\nproperty float z\n" + more + "end_header\n";
}

TEST_F(Ply, ReadsTextWithCommentsAndWindowsLineEnds) {
  const ReadResult result = read(
      "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nobj_info none\r\nelement vertex 2\r\nproperty double x\r\n"
      "property double y\r\nproperty double z\r\nend_header\r\n500000.125 5800000.25 -1.5e1\r\n\r\n+1 .5 2\r\n");

  ASSERT_EQ(result.cloud.size(), 2u);
  EXPECT_EQ(result.cloud.positions[0], Eigen::Vector3d(500000.125, 5800000.25, -15));
  EXPECT_EQ(result.cloud.positions[1], Eigen::Vector3d(1, 0.5, 2));
  EXPECT_TRUE(result.cloud.colors.empty());
  EXPECT_TRUE(result.cloud.intensities.empty());
}

TEST_F(Ply, ReadsBothByteOrdersAlike) {
  const std::string properties = "property double time\nproperty ushort ring\nproperty int label\n";
  const std::string little = raw(1.0f, 2.0f, 3.0f, 1e9 + 0.25, std::uint16_t{258}, std::int32_t{7});
  const std::string big = raw<kBig>(1.0f, 2.0f, 3.0f, 1e9 + 0.25, std::uint16_t{258}, std::int32_t{7});

  for (const std::string& bytes :
       {header("binary_little_endian", "1", properties) + little, header("binary_big_endian", "1", properties) + big}) {
    const PointCloud cloud = read(bytes).cloud;
    ASSERT_EQ(cloud.size(), 1u);
    EXPECT_EQ(cloud.positions[0], Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(cloud.times, std::vector<double>{1e9 + 0.25});
    EXPECT_EQ(cloud.rings, std::vector<std::uint16_t>{258});
    EXPECT_EQ(cloud.labels, std::vector<std::uint16_t>{7});
  }
}

TEST_F(Ply, ReadsCoordinatesOfEveryNumberType) {
  const auto read_one = [&](const std::string& type, auto zero) {
    using T = decltype(zero);
    const std::string properties =
        "property " + type + " x\nproperty " + type + " y\nproperty " + type + " z\nend_header\n";
    const std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex 1\n" + properties;
    return Eigen::Vector3d(read(bytes + raw(T{1}, T{2}, T{100})).cloud.positions[0]);
  };
  const Eigen::Vector3d expected(1, 2, 100);
  EXPECT_EQ(read_one("char", std::int8_t{}), expected);
  EXPECT_EQ(read_one("uint8", std::uint8_t{}), expected);
  EXPECT_EQ(read_one("short", std::int16_t{}), expected);
  EXPECT_EQ(read_one("uint16", std::uint16_t{}), expected);
  EXPECT_EQ(read_one("int", std::int32_t{}), expected);
  EXPECT_EQ(read_one("uint32", std::uint32_t{}), expected);
  EXPECT_EQ(read_one("int64", std::int64_t{}), expected);
  EXPECT_EQ(read_one("uint64", std::uint64_t{}), expected);
  EXPECT_EQ(read_one("float32", float{}), expected);
  EXPECT_EQ(read_one("float64", double{}), expected);
}

TEST_F(Ply, WidensColorsOf8BitsAndOfFloats) {
  const auto color = [&](const std::string& type, const std::string& values) {
    return read(header("ascii", "1",
                       "property " + type + " red\nproperty " + type + " green\nproperty " + type + " blue\n") +
                "0 0 0 " + values + "\n")
        .cloud.colors.at(0);
  };
  EXPECT_EQ(color("uchar", "0 128 255"), (Rgb16{0, 128 * 257, 65535}));
  EXPECT_EQ(color("ushort", "0 128 65535"), (Rgb16{0, 128, 65535}));
  EXPECT_EQ(color("float", "0 0.5 1"), (Rgb16{0, 32768, 65535}));
  EXPECT_EQ(color("float", "-1 nan 7"), (Rgb16{0, 0, 7 * 257}));
}

TEST_F(Ply, KnowsTheNamesThatOtherProgramsGive) {
  const PointCloud cloud = read(header("ascii", "1",
                                       "property float scalar_Intensity\nproperty double scalar_GpsTime\n"
                                       "property uchar Classification\nproperty float nx\nproperty uchar red\n") +
                                "1 2 3 0.25 17.5 6 0.1 9\n")
                               .cloud;
  EXPECT_EQ(cloud.intensities, std::vector<float>{0.25f});
  EXPECT_EQ(cloud.times, std::vector<double>{17.5});
  EXPECT_EQ(cloud.labels, std::vector<std::uint16_t>{6});
  EXPECT_TRUE(cloud.colors.empty()) << "one channel is no colour";
}

TEST_F(Ply, TakesNanosecondsOfOusterButNoOtherIntegerForTime) {
  const auto times = [&](const std::string& property) {
    return read(header("ascii", "1", "property " + property + "\n") + "1 2 3 1500000000\n").cloud.times;
  };
  EXPECT_EQ(times("uint t"), std::vector<double>{1.5});
  EXPECT_EQ(times("double t"), std::vector<double>{1.5e9});
  EXPECT_TRUE(times("uint timestamp").empty());
}

TEST_F(Ply, PassesOverOtherElementsAndLists) {
  const std::string head =
      " 1.0\nelement face 2\nproperty list uchar int vertex_indices\nelement vertex 2\nproperty float x\n"
      "property list ushort double weights\nproperty float y\nproperty float z\nelement edge 1\nproperty int a\n"
      "property int b\nend_header\n";
  const std::string text = "3 0 1 1\n0\n1 2 0.5 0.5 2 3\n4 0 5 6\n0 1\n";
  const auto binary = [](auto order) {
    constexpr std::endian kOrder = decltype(order)::value;
    return raw<kOrder>(std::uint8_t{3}, 0, 1, 1, std::uint8_t{0}) +
           raw<kOrder>(1.0f, std::uint16_t{2}, 0.5, 0.5, 2.0f, 3.0f) + raw<kOrder>(4.0f, std::uint16_t{0}, 5.0f, 6.0f) +
           raw<kOrder>(0, 1);
  };
  using Little = std::integral_constant<std::endian, std::endian::little>;
  using Big = std::integral_constant<std::endian, kBig>;

  for (const std::string& bytes :
       {"ply\nformat ascii" + head + text, "ply\nformat binary_little_endian" + head + binary(Little{}),
        "ply\nformat binary_big_endian" + head + binary(Big{})}) {
    const PointCloud cloud = read(bytes).cloud;
    ASSERT_EQ(cloud.size(), 2u);
    EXPECT_EQ(cloud.positions[0], Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(cloud.positions[1], Eigen::Vector3d(4, 5, 6));
    for (std::size_t size = 0; size + 3 < bytes.size(); ++size) {
      EXPECT_TRUE(is_refused_or_damaged(bytes.substr(0, size))) << size << " bytes of " << bytes.size();
    }
  }
}

TEST_F(Ply, DropsAndCountsPointsThatAreNotFinite) {
  const ReadResult result =
      read(header("binary_little_endian", "4", "property float intensity\n") + raw(1.0f, 2.0f, 3.0f, 10.0f) +
           raw(kNotANumber, 2.0f, 3.0f, 20.0f) + raw(1.0f, 2.0f, -INFINITY, 30.0f) + raw(4.0f, 5.0f, 6.0f, 40.0f));

  EXPECT_EQ(result.dropped.size(), 2u);
  ASSERT_EQ(result.cloud.size(), 2u);
  EXPECT_EQ(result.cloud.positions[1], Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(result.cloud.intensities, (std::vector<float>{10, 40}));
  EXPECT_EQ(read(header("ascii", "3") + "nan 0 0\n1 1 1\n0 -inf 1e999\n").dropped.size(), 2u);
}

TEST_F(Ply, RefusesFilesWithoutAnyPoint) {
  EXPECT_EQ(error(header("ascii", "0")), "scan.ply: the file holds no points");
  EXPECT_EQ(error(header("ascii", "1") + "nan 0 0\n"), "scan.ply: none of the 1 points is finite");
  EXPECT_EQ(error("ply\nformat ascii 1.0\nend_header\n"), "scan.ply:3: the header has no element 'vertex'");
}

TEST_F(Ply, KeepsThePointsThatAreThereWhereTheHeaderPromisesMore) {
  for (const std::string encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const std::string count : {"4", "2147483648", "9223372036854775808", "18446744073709551615"}) {
      const std::size_t num_whole = encoding == "ascii" ? 2 : 1;
      const ReadResult result = read(header(encoding, count) + "1 2 3\n4 5 6\n");
      EXPECT_EQ(result.cloud.size(), num_whole) << encoding;
      EXPECT_EQ(result.findings, std::vector<ReadFinding>{missing_points(std::stoull(count), num_whole)});
      EXPECT_TRUE(result.findings.at(0).is_damage);
      EXPECT_EQ(error(header(encoding, count)).substr(0, 47),
                ("scan.ply:3: the header promises " + count + " elements 'vertex', ").substr(0, 47));
    }
  }
  EXPECT_EQ(error(header("ascii", "18446744073709551616")),
            "scan.ply:3: '18446744073709551616' is not a number of elements");
  EXPECT_EQ(error(header("ascii", "-1")), "scan.ply:3: '-1' is not a number of elements");
}

TEST_F(Ply, NamesTheLineOfWhatIsWrongInTheHeader) {
  EXPECT_EQ(error("ply\nformat ascii 1.0\nelement vertex 1\nproperty list uchar float x\nproperty float y\n"
                  "property float z\nend_header\n1 2 3 4\n"),
            "scan.ply:4: property 'x' is a list, expected a number");
  EXPECT_EQ(error("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n1 2\n"),
            "scan.ply:3: the vertices have no property 'z'");
  EXPECT_EQ(error("ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\n"),
            "scan.ply:4: unknown number type 'quad'");
  EXPECT_EQ(error("ply\nformat ascii 2.0\n"), "scan.ply:2: unknown PLY version '2.0', expected '1.0'");
  EXPECT_EQ(error("ply\nformat morse 1.0\n"), "scan.ply:2: unknown encoding 'morse'");
  EXPECT_EQ(error("ply\nproperty float x\n"), "scan.ply:2: unexpected 'property' in the header");
  EXPECT_EQ(error("ply\nelement vertex 1\nproperty float x\nend_header\n"), "scan.ply:4: the header states no format");
  EXPECT_EQ(error("ply\nformat ascii 1.0\nelement face 1\nproperty list float int i\n"),
            "scan.ply:4: the length of a list is 'float', expected an integer");
  EXPECT_EQ(error("obj\n"), "scan.ply:1: found 'obj', expected 'ply'");
}

TEST_F(Ply, LeavesOutLinesThatAreNoPointsAndNamesTheFirst) {
  const auto finding = [&](const std::string& line) {
    const ReadResult result =
        read(header("ascii", "3", "property float intensity\n") + "1 2 3 4\n" + line + "\n5 6 7 8\n");
    EXPECT_EQ(result.cloud.intensities, (std::vector<float>{4, 8})) << line;
    EXPECT_EQ(result.dropped, std::vector<std::size_t>{1});
    return result.findings.size() == 1 ? result.findings[0].text() : "no finding";
  };
  EXPECT_EQ(finding("1 two 3 4"), "1 broken points left out (line 10: property 'y' is 'two', expected a number)");
  EXPECT_EQ(finding("1 2  "), "1 broken points left out (line 10: the line ends before property 'z')");
  EXPECT_EQ(finding("1 2 3 4 5"), "1 broken points left out (line 10: found '5' after the last property)");
}

TEST_F(Ply, AValueThatIsNoNumberIsMissingWhereThePointCanDoWithoutIt) {
  const ReadResult result =
      read(header("ascii", "2", "property float intensity\nproperty float nx\n") + "1 2 3 4 none\n5 6 7 none none\n");
  EXPECT_EQ(result.cloud.size(), 2U);
  EXPECT_TRUE(std::isnan(result.cloud.intensities.at(1)));
  ASSERT_EQ(result.findings.size(), 1U);
  EXPECT_EQ(result.findings[0].count, 1U);
}

TEST_F(Ply, PointsMayShareLinesOrSpanThem) {
  const std::vector<Eigen::Vector3d> expected = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  for (const char* text :
       {"1 2 3 4 5 6 7 8 9", "1 2 3\n4 5 6 7 8 9\n", "1 2\n3 4\n5 6 7\n8 9\n", "1\n2\n3\n4\n5\n6\n7\n8\n9"}) {
    const ReadResult result = read(header("ascii", "3") + text);
    EXPECT_EQ(result.cloud.positions, expected) << text;
    EXPECT_TRUE(result.findings.empty()) << text;
  }
}

TEST_F(Ply, FirstLinesAndLineEndsMayBeUnusual) {
  const std::string text = header("ascii", "2") + "1 2 3\n4 5 6\n";
  std::string with_returns = text;
  std::ranges::replace(with_returns, '\n', '\r');
  for (const std::string& bytes : {"\xef\xbb\xbf" + text, "ply " + text.substr(3), "PLY\t" + text.substr(3),
                                   with_returns, text.substr(0, text.size() - 1)}) {
    EXPECT_EQ(read_points(test::write_raw(folder_ / "any", bytes)).cloud.size(), 2U);
  }
  // A binary part may begin with the byte of a line feed: it belongs to the number.
  std::string binary = header("binary_little_endian", "1");
  std::ranges::replace(binary, '\n', '\r');
  const std::string line_feed = "\n";
  EXPECT_EQ(read(binary + line_feed + raw(1.0f, 2.0f, 3.0f).substr(1)).cloud.positions.at(0).y(), 2.0);
}

TEST_F(Ply, WhatStandsBehindThePointsIsToldButDoesNotSpoilThem) {
  const ReadResult more = read(header("ascii", "1") + "1 2 3\n4 5 6\n");
  EXPECT_EQ(more.cloud.size(), 1U);
  EXPECT_EQ(more.findings, (std::vector<ReadFinding>{{"bytes behind the last element passed over", 6}}));
  EXPECT_TRUE(read(header("binary_little_endian", "1") + raw(1.0f, 2.0f, 3.0f) + "\r\n").findings.empty());

  const std::string faces = "element face 2\nproperty list uchar int vertex_indices\n";
  const ReadResult cut = read(header("ascii", "1", faces) + "1 2 3\n3 0 0 0\n");
  EXPECT_EQ(cut.cloud.size(), 1U);
  EXPECT_TRUE(cut.findings.at(0).is_damage);
}

TEST_F(Ply, DarkColorsOf16BitsSurviveARoundTrip) {
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}};
  cloud.colors = {{1, 2, 3}};
  for (const PlyEncoding encoding : {PlyEncoding::kAscii, PlyEncoding::kBinaryLittleEndian}) {
    write_ply(folder_ / "dark.ply", cloud, encoding);
    EXPECT_EQ(read_ply(folder_ / "dark.ply").cloud.colors, cloud.colors);
  }
}

TEST_F(Ply, NamesTheLineOfWhatIsWrongInTheText) {
  EXPECT_EQ(error(header("ascii", "1") + "1 2 3 4\n"), "scan.ply:8: found '4' after the last property");
  EXPECT_EQ(error(header("ascii", "1") + "1 2 \x01\x1b[31m-and-much-more-than-anybody-wants-to-see\n"),
            "scan.ply:8: property 'z' is '??[31m-and-much-more-than-anybody-wants-...', expected a number");
}

TEST_F(Ply, RefusesListsThatLeaveTheFile) {
  const auto with_length = [](const std::string& type, const std::string& length) {
    return header("binary_little_endian", "1", "property list " + type + " double weights\n") + raw(1.0f, 2.0f, 3.0f) +
           length;
  };
  EXPECT_EQ(error(with_length("int", raw(std::int32_t{-1}))),
            "scan.ply: byte 160: the file cannot hold a list 'weights' of length -1");
  EXPECT_EQ(error(with_length("uint", raw(std::uint32_t{0x20000001}))),
            "scan.ply: byte 161: the file cannot hold a list 'weights' of length 536870913");
  EXPECT_NE(error(with_length("uint64", raw(std::uint64_t{1} << 63))), "no error");
  EXPECT_NE(error(header("ascii", "1", "property list uint uint w\n") + "1 2 3 4294967295 1\n"), "no error");
}

TEST_F(Ply, WritesColorsIn16BitsOnlyWhereTheyNeedThem) {
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}};
  cloud.colors = {{257, 514, 65535}};
  write_ply(folder_ / "8.ply", cloud);
  EXPECT_NE(test::read_raw(folder_ / "8.ply").find("property uchar red"), std::string::npos);

  cloud.colors[0].g = 515;
  write_ply(folder_ / "16.ply", cloud);
  EXPECT_NE(test::read_raw(folder_ / "16.ply").find("property ushort red"), std::string::npos);
  EXPECT_EQ(read_ply(folder_ / "16.ply").cloud.colors, cloud.colors);
}

TEST_F(Ply, ReadsTheFilesOfCloudCompare) {
  const auto data = test::real_data_folder();
  if (!data) GTEST_SKIP() << test::kNeedsRealData;

  for (const auto& [name, num_points] : {std::pair("source.ply", 69792u), std::pair("target.ply", 69088u)}) {
    const ReadResult result = read_ply(*data / "pair" / name);
    ASSERT_EQ(result.cloud.size(), num_points);
    EXPECT_EQ(result.dropped.size(), 0u);

    const std::string bytes = test::read_raw(*data / "pair" / name);
    const char* record = bytes.data() + bytes.size() - 16 * num_points;  // float x, y, z, intensity
    for (std::size_t i = 0; i < num_points; ++i, record += 16) {
      const Eigen::Vector3d expected(load<float>(record), load<float>(record + 4), load<float>(record + 8));
      ASSERT_EQ(result.cloud.positions[i], expected);
      ASSERT_LT(expected.norm(), 120.0);  // [m] the sensor's range
      ASSERT_EQ(result.cloud.intensities[i], load<float>(record + 12));
      ASSERT_LE(result.cloud.intensities[i], 255.0f);
    }
  }
}

}  // namespace
}  // namespace vdbmap

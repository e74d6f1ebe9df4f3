// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/pcd/pcd.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "vdbmap/io/pcd/lzf.h"

namespace vdbmap {
namespace {

using test::io_error_of;
using test::raw;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class Pcd : public testing::Test {
 protected:
  ReadResult read(const std::string& bytes) const { return read_pcd(test::write_raw(folder_ / "scan.pcd", bytes)); }
  std::string error(const std::string& bytes) const {
    return io_error_of([&] { read(bytes); });
  }

  test::TemporaryFolder folder_;
};

// A header of float x, y, z and more fields, as PCL writes it.
struct Header {
  std::string data = "ascii";
  std::string count = "1";
  std::string names = "";
  std::string sizes = "";
  std::string types = "";
  std::string counts = "";

  operator std::string() const {
    return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z" + names + "\nSIZE 4 4 4" + sizes +
           "\nTYPE F F F" + types + "\nCOUNT 1 1 1" + counts + "\nWIDTH " + count +
           "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA " + data + "\n";
  }
  std::string operator+(const std::string& bytes) const { return std::string(*this) + bytes; }
};

std::string compressed(const std::string& data) {
  const std::string bytes = lzf_compress(data);
  return raw(static_cast<std::uint32_t>(bytes.size()), static_cast<std::uint32_t>(data.size())) + bytes;
}

TEST_F(Pcd, ReadsTextWithFieldsItHasNoPlaceFor) {
  const Header header{"ascii", "2", " normal ring time", " 4 2 8", " F U F", " 3 1 1"};
  const PointCloud cloud = read(header + "1 2 3 0 0 1 5 1e9\n-1 -2 -3 0 0 1 6 1000000000.125\n").cloud;

  ASSERT_EQ(cloud.size(), 2u);
  EXPECT_EQ(cloud.positions[1], Eigen::Vector3d(-1, -2, -3));
  EXPECT_EQ(cloud.rings, (std::vector<std::uint16_t>{5, 6}));
  EXPECT_EQ(cloud.times, (std::vector<double>{1e9, 1e9 + 0.125}));
}

TEST_F(Pcd, ReadsBinaryWithPaddingBetweenFieldsAndAfterPoints) {
  const Header header{"binary", "2", " _ intensity label", " 1 4 4", " U F U", " 3 1 1"};
  const std::string padding = "pad";
  const PointCloud cloud = read(header + raw(1.0f, 2.0f, 3.0f) + padding + raw(0.5f, 7u) + raw(4.0f, 5.0f, 6.0f) +
                                padding + raw(0.75f, 70000u) + "PCL pads to a page")
                               .cloud;

  ASSERT_EQ(cloud.size(), 2u);
  EXPECT_EQ(cloud.positions[1], Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(cloud.intensities, (std::vector<float>{0.5f, 0.75f}));
  EXPECT_EQ(cloud.labels, (std::vector<std::uint16_t>{7, 4464}));
}

TEST_F(Pcd, ReadsCompressedDataFieldByField) {
  const Header header{"binary_compressed", "2", " ring", " 2", " U", " 1"};
  const PointCloud cloud =
      read(header + compressed(raw(1.0f, 4.0f, 2.0f, 5.0f, 3.0f, 6.0f, std::uint16_t{8}, std::uint16_t{9}))).cloud;

  ASSERT_EQ(cloud.size(), 2u);
  EXPECT_EQ(cloud.positions[0], Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(cloud.positions[1], Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(cloud.rings, (std::vector<std::uint16_t>{8, 9}));
}

TEST_F(Pcd, UnpacksColorsFromTheBitsOfFloatsAndIntegers) {
  // 0xff ahead of a red above 127 makes the float a NaN, 0xbf a signalling one: arithmetic would change its bits.
  const std::uint32_t packed = 0xffbf8001;
  const Rgb16 expected{0xbf * 257, 0x80 * 257, 0x01 * 257};
  const auto color = [](const ReadResult& result) { return result.cloud.colors.at(0); };

  const std::string bytes = raw(1.0f, 2.0f, 3.0f, packed);
  EXPECT_EQ(color(read(Header{"binary", "1", " rgb", " 4", " F", " 1"} + bytes)), expected);
  EXPECT_EQ(color(read(Header{"binary", "1", " rgba", " 4", " U", " 1"} + bytes)), expected);
  EXPECT_EQ(color(read(Header{"binary", "1", " rgb", " 4", " I", " 1"} + bytes)), expected);
  EXPECT_EQ(color(read(Header{"ascii", "1", " rgb", " 4", " U", " 1"} + "1 2 3 4290740225\n")), expected);
  // The example in PCL's own description of the format.
  EXPECT_EQ(color(read(Header{"ascii", "1", " rgb", " 4", " F", " 1"} + "0.93773 0.33763 0 4.2108e+06\n")),
            (Rgb16{0x80 * 257, 0x80 * 257, 0xe0 * 257}));
}

TEST_F(Pcd, DoesWithoutTheOptionalLines) {
  const std::string minimal = "FIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2 3\n";
  EXPECT_EQ(read(minimal).cloud.positions.at(0), Eigen::Vector3d(1, 2, 3));
  const std::string old = "# old\nCOLUMNS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nDATA ascii\n1 2 3\n";
  EXPECT_EQ(read(old).cloud.positions.at(0), Eigen::Vector3d(1, 2, 3));
}

TEST_F(Pcd, DropsAndCountsPointsThatAreNotFinite) {
  const std::string ring = " ring";
  const ReadResult result = read(Header{"binary", "3", ring, " 1", " U", " 1"} + raw(kNan, kNan, kNan, '\1') +
                                 raw(1.0f, 2.0f, 3.0f, '\2') + raw(1.0f, INFINITY, 3.0f, '\3'));
  EXPECT_EQ(result.dropped.size(), 2u);
  EXPECT_EQ(result.cloud.rings, std::vector<std::uint16_t>{2});

  EXPECT_EQ(read(Header{"ascii", "2"} + "nan nan nan\n1 2 3\n").dropped.size(), 1u);
  EXPECT_EQ(error(Header{"ascii", "1"} + "nan 0 0\n"), "scan.pcd: none of the 1 points is finite");
  EXPECT_EQ(error(Header{"binary", "0"}), "scan.pcd: the file holds no points");
}

TEST_F(Pcd, KeepsThePointsThatAreThereWhereTheHeaderPromisesMore) {
  const std::string numbers = raw(1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f);
  const std::pair<std::string, std::string> data[] = {
      {"ascii", "1 2 3\n4 5 6\n"},
      {"binary", numbers + "cut"},
      {"binary_compressed", compressed(raw(1.0f, 4.0f, 2.0f, 5.0f, 3.0f, 6.0f))}};
  for (const auto& [encoding, bytes] : data) {
    for (const std::string count : {"30", "2147483648", "9223372036854775808", "18446744073709551615"}) {
      const ReadResult result = read(Header{encoding, count} + bytes);
      EXPECT_EQ(result.cloud.positions, (std::vector<Eigen::Vector3d>{{1, 2, 3}, {4, 5, 6}})) << encoding;
      EXPECT_EQ(result.findings, std::vector<ReadFinding>{missing_points(std::stoull(count), 2)});
      const std::string message = error(Header{encoding, count});
      if (encoding != "binary_compressed") {
        EXPECT_TRUE(
            message.starts_with("scan.pcd:10: the header promises " + count + " points, the file holds at most"))
            << message;
      }
    }
  }
}

TEST_F(Pcd, HeadersMayBeUnusual) {
  const std::string header =
      "version .7\nfields  x  y z \n\nsize 4 4 4\ntype f f f\nwidth 2\nheight 1\npoints 2\ndata ASCII\n";
  for (const std::string first : {"", "\xef\xbb\xbf", ".PCD v0.7 - Point Cloud Data file format\n"}) {
    EXPECT_EQ(read_points(test::write_raw(folder_ / "any", first + header + "1 2 3\n4 5 6\n")).cloud.size(), 2U);
  }
  EXPECT_EQ(read("FIELDS X Y Z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2 3").cloud.size(), 1U);
}

TEST_F(Pcd, TheDataSayHowManyPointsThereAreWhereTheHeaderContradictsItself) {
  const std::string header = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n";
  for (const char* counts : {"WIDTH 2\nHEIGHT 1\nPOINTS 3\n", "WIDTH 3\nHEIGHT 1\nPOINTS 2\n"}) {
    const ReadResult result = read(header + counts + "DATA ascii\n1 2 3\n4 5 6\n");
    EXPECT_EQ(result.cloud.size(), 2U);
    EXPECT_TRUE(result.findings.at(0).is_damage);
  }
}

TEST_F(Pcd, ColorsOfEveryTypeAreScaledByWhatTheyAre) {
  const auto color = [&](const std::string& size, const std::string& type, const std::string& values) {
    const Header header{
        "ascii", "1", " red green blue", " " + size + " " + size + " " + size, " " + type + " " + type + " " + type,
        " 1 1 1"};
    return read(header + "1 2 3 " + values + "\n").cloud.colors.at(0);
  };
  const Rgb16 expected{65535, 128 * 257, 0};
  EXPECT_EQ(color("1", "U", "255 128 0"), expected);
  EXPECT_EQ(color("2", "U", "255 128 0"), expected);
  EXPECT_EQ(color("4", "U", "255 128 0"), expected);
  EXPECT_EQ(color("4", "F", "255 128 0"), expected);
  EXPECT_EQ(color("4", "F", "1 0.50196 0"), expected);
  EXPECT_EQ(color("2", "U", "65535 128 0"), (Rgb16{65535, 128, 0}));
  EXPECT_EQ(color("4", "F", "65535 128 0"), (Rgb16{65535, 128, 0}));
}

TEST_F(Pcd, RefusesSizesWhoseProductOverflows) {
  const std::string fields = "FIELDS x y z _\nSIZE 4 4 4 8\nTYPE F F F F\nCOUNT 1 1 1 ";
  EXPECT_EQ(error(fields + "2305843009213693952\nPOINTS 1\nDATA binary\n"),
            "scan.pcd:4: a field cannot have 2305843009213693952 numbers");
  EXPECT_EQ(error(fields + "4294967296\nPOINTS 536870912\nDATA binary\n"),
            "scan.pcd:5: the header promises 536870912 points, the file holds at most 0");
  EXPECT_EQ(error(fields + "0\nPOINTS 1\nDATA binary\n"), "scan.pcd:4: a field cannot have 0 numbers");
  EXPECT_EQ(error(fields + "1\nWIDTH 4294967296\nHEIGHT 4294967296\nPOINTS 0\nDATA binary\n"),
            "scan.pcd:5: WIDTH x HEIGHT exceeds 2^64");
  EXPECT_EQ(error(fields + "1\nWIDTH 2\nHEIGHT 2\nPOINTS 5\nDATA binary\n"),
            "scan.pcd:7: the header promises 5 points, the file holds at most 0");
}

TEST_F(Pcd, RefusesDamagedCompressedData) {
  const Header header{"binary_compressed", "1"};
  EXPECT_EQ(error(header + raw(4u, 12u) + "\x03"),
            "scan.pcd: byte 183: the file ends too early: expected 4 more bytes, found 1");
  EXPECT_EQ(error(header + raw(4u, 12u) + "\x20\x20\x20\x20"), "scan.pcd: byte 183: not LZF data of 12 bytes");
  EXPECT_EQ(error(header + raw(4u, 13u) + "abcd"),
            "scan.pcd: byte 183: the data expand to 13 bytes, the header describes 1 points of 12");
  EXPECT_EQ(error(Header{"binary_compressed", "300000000"} + raw(4u, 3600000000u) + "abcd"),
            "scan.pcd: byte 199: not LZF data of 3600000000 bytes");
}

// Zeros expand 88 times, and a point of three bytes takes 46 in memory.
TEST_F(Pcd, RefusesCompressedDataThatWouldFillTheMemory) {
  const auto zeros = [](std::size_t num_points) {
    const std::string fields = "FIELDS x y z\nSIZE 1 1 1\nTYPE I I I\nWIDTH ";
    return fields + std::to_string(num_points) + "\nHEIGHT 1\nDATA binary_compressed\n" +
           compressed(std::string(3 * num_points, '\0'));
  };
  EXPECT_EQ(read(zeros(300'000)).cloud.size(), 300'000u) << "whole images of points may be empty for the most part";
  const std::string message = error(zeros(6'000'000));
  EXPECT_NE(message.find("expand to 6000000 points of 276000000 bytes, allowed are 268435456"), std::string::npos)
      << message;
}

TEST_F(Pcd, NamesTheLineOfWhatIsWrongInTheHeader) {
  const std::string end = "POINTS 1\nDATA ascii\n1 2 3\n";
  EXPECT_EQ(error("FIELDS x y\nSIZE 4 4\nTYPE F F\n" + end), "scan.pcd:1: the points have no field 'z'");
  EXPECT_EQ(error("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 3 1 1\n" + end),
            "scan.pcd:1: field 'x' holds 3 numbers, expected 1");
  EXPECT_EQ(error("FIELDS x y z\nSIZE 4 4\nTYPE F F F\n" + end), "scan.pcd:2: SIZE has 2 values for 3 fields");
  EXPECT_EQ(error("FIELDS x y z\nSIZE 4 4 3\nTYPE F F F\n" + end), "scan.pcd:3: no number has type 'F' and size 3");
  EXPECT_EQ(error("FIELDS x y z\nSIZE 4 4 4\nTYPE F F X\n" + end), "scan.pcd:3: no number has type 'X' and size 4");
  EXPECT_EQ(error("FIELDS x y z\nFIELDS x y z\n"), "scan.pcd:2: a second line FIELDS");
  EXPECT_EQ(error("FIELDS x y z\nTYPE F F F\n" + end), "scan.pcd:4: the header has no line SIZE");
  EXPECT_EQ(error("FIELDS x y z\nGARBAGE\n"), "scan.pcd:2: unexpected 'GARBAGE' in the header");
  EXPECT_EQ(error("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS -1\nDATA ascii\n"),
            "scan.pcd:4: '-1' is not a whole number");
  EXPECT_EQ(error("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA morse\n"),
            "scan.pcd:5: unknown encoding 'morse'");
}

TEST_F(Pcd, LeavesOutLinesThatAreNoPointsAndNamesTheFirst) {
  const auto finding = [&](const std::string& line) {
    const ReadResult result = read(Header{"ascii", "3"} + "1 2 3\n" + line + "\n4 5 6\n");
    EXPECT_EQ(result.cloud.positions, (std::vector<Eigen::Vector3d>{{1, 2, 3}, {4, 5, 6}})) << line;
    return result.findings.size() == 1 ? result.findings[0].text() : "no finding";
  };
  EXPECT_EQ(finding("4 5 six"), "1 broken points left out (line 13: field 'z' is 'six', expected a number)");
  EXPECT_EQ(finding("4 5   "), "1 broken points left out (line 13: the line ends before field 'z')");
}

TEST_F(Pcd, NamesTheLineOfWhatIsWrongInTheText) {
  EXPECT_EQ(error(Header{"ascii", "1"} + "1 2 3 4\n"), "scan.pcd:12: found '4' after the last field");
}

TEST_F(Pcd, WritesPositionsInFloatOnlyWhereThatKeepsThem) {
  PointCloud cloud;
  cloud.positions = {{1.5, -2.25, 1e6}};
  write_pcd(folder_ / "float.pcd", cloud);
  EXPECT_NE(test::read_raw(folder_ / "float.pcd").find("SIZE 4 4 4\n"), std::string::npos);

  cloud.positions[0].x() = 0.1;
  write_pcd(folder_ / "double.pcd", cloud);
  EXPECT_NE(test::read_raw(folder_ / "double.pcd").find("SIZE 8 8 8\n"), std::string::npos);
  EXPECT_EQ(read_pcd(folder_ / "double.pcd").cloud.positions, cloud.positions);
}

struct RealFile {
  const char* name;
  std::size_t num_points;
  std::size_t ring_offset;       // [bytes] in the record of 32
  std::size_t intensity_offset;  // [bytes]
  bool has_times;
  double longest_range;  // [m]
};

TEST_F(Pcd, ReadsTheFilesOfPcl) {
  const auto data = test::real_data_folder();
  if (!data) GTEST_SKIP() << test::kNeedsRealData;

  const RealFile files[] = {{"street_16beam.pcd", 29377, 20, 16, true, 130.0},
                            {"indoor_vlp16_0.pcd", 28221, 20, 16, false, 130.0},
                            {"indoor_vlp16_1.pcd", 28096, 20, 16, false, 130.0},
                            {"indoor_vlp16_2.pcd", 27919, 20, 16, false, 130.0}};
  for (const RealFile& file : files) {
    const PointCloud cloud = read_pcd(*data / "velodyne" / file.name).cloud;
    ASSERT_EQ(cloud.size(), file.num_points) << file.name;
    EXPECT_EQ(cloud.times.size(), file.has_times ? file.num_points : 0);

    const std::string bytes = test::read_raw(*data / "velodyne" / file.name);
    const char* record = bytes.data() + bytes.find("DATA binary\n") + 12;
    for (std::size_t i = 0; i < cloud.size(); ++i, record += 32) {
      const Eigen::Vector3d expected(load<float>(record), load<float>(record + 4), load<float>(record + 8));
      ASSERT_EQ(cloud.positions[i], expected);
      ASSERT_LT(expected.norm(), file.longest_range);
      ASSERT_EQ(cloud.intensities[i], load<float>(record + file.intensity_offset));
      ASSERT_EQ(cloud.rings[i], load<std::uint16_t>(record + file.ring_offset));
      ASSERT_LT(cloud.rings[i], 16);
      if (file.has_times) {
        ASSERT_EQ(cloud.times[i], load<double>(record + 24));
      }
    }
  }
}

TEST_F(Pcd, TakesTheChannelForTheRingAndLeavesTimesOfUnknownUnit) {
  const auto data = test::real_data_folder();
  if (!data) GTEST_SKIP() << test::kNeedsRealData;

  const PointCloud cloud = read_pcd(*data / "velodyne" / "vlp16_decoded.pcd").cloud;
  ASSERT_EQ(cloud.size(), 14831u);
  EXPECT_TRUE(cloud.times.empty());

  const std::string bytes = test::read_raw(*data / "velodyne" / "vlp16_decoded.pcd");
  const char* record = bytes.data() + bytes.find("DATA binary\n") + 12;
  for (std::size_t i = 0; i < cloud.size(); ++i, record += 32) {
    // The file states the distance of each point; 5 mm allow for the vertical offset of each laser.
    ASSERT_NEAR(cloud.positions[i].norm(), load<float>(record + 24), 0.02);
    ASSERT_EQ(cloud.intensities[i], load<std::uint8_t>(record + 12));
    ASSERT_EQ(cloud.rings[i], load<std::uint16_t>(record + 14));
  }
}

}  // namespace
}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/table/xyz.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "vdbmap/core/error.h"

namespace vdbmap {
namespace {

class Xyz : public testing::Test {
 protected:
  ReadResult read(const std::string& text) const {
    std::filesystem::remove(path_);
    std::ofstream(path_, std::ios::binary) << text;
    return read_xyz(path_);
  }

  std::string error_for(const std::string& text) const {
    try {
      read(text);
    } catch (const IoError& error) {
      EXPECT_EQ(error.kind(), IoError::Kind::kMalformed);
      return std::string(error.what()).substr(path_.string().size());
    }
    return "no error";
  }

  std::string written_text() const { return test::read_raw(path_); }

  test::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "cloud.xyz";
};

using Positions = std::vector<Eigen::Vector3d>;
using Colors = std::vector<Rgb16>;

PointCloud random_cloud(std::size_t size) {
  std::mt19937_64 random(7);
  const auto any_float = [&] { return std::uniform_real_distribution<float>(-1e6F, 1e6F)(random); };
  const auto any_double = [&] { return std::uniform_real_distribution<>(-1e7, 1e7)(random); };
  const auto any_short = [&] { return static_cast<std::uint16_t>(random()); };
  PointCloud cloud;
  for (std::size_t i = 0; i < size; ++i) {
    cloud.positions.emplace_back(any_double(), any_double() * 1e-12, any_double());
    cloud.colors.push_back({any_short(), any_short(), any_short()});
    cloud.intensities.push_back(std::ldexp(any_float(), static_cast<int>(random() % 80) - 40));
    cloud.times.push_back(1.7e9 + any_double());
    cloud.rings.push_back(any_short());
    cloud.labels.push_back(any_short());
  }
  return cloud;
}

void expect_equal(const PointCloud& read, const PointCloud& written) {
  EXPECT_EQ(read.positions, written.positions);
  EXPECT_EQ(read.colors, written.colors);
  EXPECT_EQ(read.intensities, written.intensities);
  EXPECT_EQ(read.times, written.times);
  EXPECT_EQ(read.rings, written.rings);
  EXPECT_EQ(read.labels, written.labels);
}

TEST_F(Xyz, RoundTripKeepsEveryBitOfEveryAttribute) {
  const PointCloud cloud = random_cloud(5000);  // several blocks of the reader
  write_xyz(path_, cloud);

  expect_equal(read_xyz(path_).cloud, cloud);
}

TEST_F(Xyz, RoundTripKeepsPointsWithoutAttributes) {
  PointCloud cloud;
  cloud.positions = {{-0.0, 1e-300, 1e300}, {550123.4567891, 5802345.678, 0.1}};
  write_xyz(path_, cloud);

  EXPECT_EQ(written_text(), "# x y z\n-0 1e-300 1e+300\n550123.4567891 5802345.678 0.1\n");
  expect_equal(read_xyz(path_).cloud, cloud);
}

TEST_F(Xyz, ColorsAreWrittenIn8BitsWhereTheseSuffice) {
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}};
  cloud.colors = {{257, 0, 65535}};
  write_xyz(path_, cloud);
  EXPECT_EQ(written_text(), "# x y z r g b\n1 2 3 1 0 255\n");
  expect_equal(read_xyz(path_).cloud, cloud);

  cloud.colors = {{1, 2, 3}};  // dark, but not 8 bits
  write_xyz(path_, cloud);
  EXPECT_EQ(written_text(), "# x y z r16 g16 b16\n1 2 3 1 2 3\n");
  expect_equal(read_xyz(path_).cloud, cloud);
}

TEST_F(Xyz, ColumnsWithoutNamesGoByTheirNumber) {
  EXPECT_EQ(read("1 2 3\n").cloud.positions, (Positions{{1, 2, 3}}));

  const PointCloud with_intensity = read("1 2 3 4.5\n").cloud;
  EXPECT_EQ(with_intensity.intensities, (std::vector<float>{4.5F}));

  const PointCloud with_color = read("1 2 3 4 5 6\n").cloud;
  EXPECT_EQ(with_color.colors, (Colors{{4 * 257, 5 * 257, 6 * 257}}));
  EXPECT_TRUE(with_color.intensities.empty());

  const PointCloud with_both = read("1 2 3 0.5 4 5 6\n").cloud;
  EXPECT_EQ(with_both.intensities, (std::vector<float>{0.5F}));
  EXPECT_EQ(with_both.colors, (Colors{{4 * 257, 5 * 257, 6 * 257}}));
}

TEST_F(Xyz, NamesInAnyCaseOrderAndCommentSayWhatColumnsAre) {
  for (const char* header :
       {"X,Y,Z,Red,Green,Blue,Intensity,GPS_Time,Laser_Number,Classification", "x y z r g b intensity time ring label",
        "// X Y Z R G B Intensity Timestamp RING Label", "//X Y Z R G B Intensity Timestamp RING Label",
        "# x;y;z;r;g;b;i;time;ring;class", "\"x\",\"y\",\"z\",\"r\",\"g\",\"b\",\"i\",\"time\",\"ring\",\"class\""}) {
    const PointCloud cloud = read(std::string(header) + "\n1 2 3 4 5 6 0.5 1e9 7 8\n").cloud;
    EXPECT_EQ(cloud.positions, (Positions{{1, 2, 3}})) << header;
    EXPECT_EQ(cloud.colors, (Colors{{4 * 257, 5 * 257, 6 * 257}})) << header;
    EXPECT_EQ(cloud.intensities, (std::vector<float>{0.5F})) << header;
    EXPECT_EQ(cloud.times, (std::vector<double>{1e9})) << header;
    EXPECT_EQ(cloud.rings, (std::vector<std::uint16_t>{7})) << header;
    EXPECT_EQ(cloud.labels, (std::vector<std::uint16_t>{8})) << header;
  }
  const PointCloud turned = read("label z unknown y x\n9 3 text 2 1\n").cloud;
  EXPECT_EQ(turned.positions, (Positions{{1, 2, 3}}));
  EXPECT_EQ(turned.labels, (std::vector<std::uint16_t>{9}));
}

TEST_F(Xyz, SeparatorsLineEndsAndCommentsMayVary) {
  const Positions expected = {{1, 2, 3}, {-4, 5e-1, 6}};
  for (const char* text : {"1 2 3\n-4 0.5 6", "1,2,3\n-4,0.5,6\n", "1;2;3\r\n-4;0.5;6\r\n", "1\t2\t3\n-4\t.5\t+6\n",
                           "1 , 2 , 3\n-4, 0.5, 6\n", "\n  1  2  3  \n\n -4 0.5 6\n \n",
                           "# made by hand\n1 2 3 # first\n// second\n-4 0.5 6 // last\n",
                           "\xef\xbb\xbf"
                           "1 2 3\n-4 5e-1 6.0\n",
                           "1,2,3,\n-4,0.5,6,\n"}) {
    EXPECT_EQ(read(text).cloud.positions, expected) << text;
  }
}

TEST_F(Xyz, ACommentThatDoesNotFitTheColumnsIsNoHeader) {
  const PointCloud cloud = read("# x y z are in metres\n1 2 3 4\n").cloud;
  EXPECT_EQ(cloud.positions, (Positions{{1, 2, 3}}));
  EXPECT_EQ(cloud.intensities, (std::vector<float>{4}));
}

TEST_F(Xyz, ColorsAboveEightBitsAreTakenForSixteen) {
  EXPECT_EQ(read("1 2 3 255 0 1\n1 2 3 256 0 1\n").cloud.colors, (Colors{{255, 0, 1}, {256, 0, 1}}));
}

TEST_F(Xyz, PointsThatAreNotFiniteAreDroppedWithTheirAttributesAndCounted) {
  const ReadResult result = read("x y z intensity\nnan 2 3 1\n4 5 6 2\n7 inf 9 3\n10 11 -1e999 4\nNaN NaN NaN nan\n");

  EXPECT_EQ(result.dropped.size(), 4U);
  EXPECT_EQ(result.cloud.positions, (Positions{{4, 5, 6}}));
  EXPECT_EQ(result.cloud.intensities, (std::vector<float>{2}));
}

TEST_F(Xyz, ErrorsNameTheLineAndTheReason) {
  EXPECT_EQ(error_for("1 2\n"),
            ":1: no line holds three numbers, parted by blanks, commas, semicolons or tabs and without marks between "
            "thousands");
  EXPECT_EQ(error_for("left right high\n1 2 3\n"),
            ":1: a header without x, y and z; say with --columns what the columns are");
  EXPECT_EQ(error_for("x y z\nx z y\n1 2 3\n"), ":2: another header with x, y and z, of other columns");
  EXPECT_EQ(error_for("x y z\n1 2 3\nx z y\n1 2 3\n"), ":3: another header with x, y and z, of other columns");
  EXPECT_EQ(error_for("1 2 3 4 5 65536\n"),
            ":1: found 6 columns, and neither a header nor their numbers say what they are; name them, as in --columns "
            "x,y,z,r,g,b,-");
}

TEST_F(Xyz, RowsThatAreBrokenAreLeftOutAndTheFirstIsNamed) {
  const auto first_of = [&](const std::string& bad) {
    const ReadResult result = read("1 2 3\n" + bad + "\n4 5 6\n7 8 9\n");
    EXPECT_EQ(result.cloud.positions, (Positions{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}})) << bad;
    EXPECT_EQ(result.dropped, std::vector<std::size_t>{1}) << bad;
    EXPECT_EQ(result.num_non_finite, 0U);
    EXPECT_EQ(result.findings.size(), 1U) << bad;
    EXPECT_TRUE(result.findings.at(0).is_damage);
    return result.findings.at(0).text();
  };
  EXPECT_EQ(first_of("1 2 a3"), "1 broken points left out (line 2: column 3: 'a3' is not a number)");
  EXPECT_EQ(first_of("1 2"), "1 broken points left out (line 2: found 2 columns, expected 3)");
  EXPECT_EQ(first_of("1 2 3 4"), "1 broken points left out (line 2: found 4 columns, expected 3)");
  EXPECT_EQ(first_of("words"), "1 broken points left out (line 2: column 1: 'words' is not a number)");
}

TEST_F(Xyz, TheFirstRowMayBeBrokenToo) {
  for (const char* text : {"bad 2 3\n1 2 3\n4 5 6\n", "x y z\nbad 2 3\n1 2 3\n4 5 6\n", "1 2\n1 2 3\n4 5 6\n",
                           "# x y z\n1 b 3\n1 2 3\n4 5 6\n"}) {
    const ReadResult result = read(text);
    EXPECT_EQ(result.cloud.positions, (Positions{{1, 2, 3}, {4, 5, 6}})) << text;
    EXPECT_EQ(result.dropped, std::vector<std::size_t>{0}) << text;
  }
}

TEST_F(Xyz, PlacesOfBrokenAndInfinitePointsCountAllRows) {
  const ReadResult result = read("1,2,3\nnan,2,3\nbad,2,3\n4,5,6\n1,,3\nnan,2,3\n7,8,9\n1,2,3\n");
  EXPECT_EQ(result.dropped, (std::vector<std::size_t>{1, 2, 4, 5}));
  EXPECT_EQ(result.num_non_finite, 2U);
  EXPECT_EQ(result.cloud.positions, (Positions{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {1, 2, 3}}));
  EXPECT_EQ(result.findings.at(0).count, 2U);
}

TEST_F(Xyz, ATextWithMoreBrokenRowsThanWholeOnesIsNoTable) {
  EXPECT_EQ(read("1 2 3\n1 2 a\n").cloud.size(), 1U);
  EXPECT_EQ(error_for("1 2 3\n1 2 a\n1 2 b\n"), ":2: column 3: 'a' is not a number");
  EXPECT_EQ(error_for("1 2 3\n1 2\n1 2\n"), ":2: found 2 columns, expected 3");
}

TEST_F(Xyz, ValuesThatAPointCanDoWithoutAreMissing) {
  const ReadResult result =
      read("x,y,z,intensity,ring,label\n1,2,3,0.5,1,2\n4,5,6,N/A,-1,1.5\n7,8,9,,3,4\n1,1,1,oops,5,70000\n");
  EXPECT_EQ(result.cloud.size(), 4U);
  EXPECT_EQ(result.cloud.intensities.at(0), 0.5F);
  for (const std::size_t i : {1U, 2U, 3U}) EXPECT_TRUE(std::isnan(result.cloud.intensities.at(i)));
  EXPECT_EQ(result.cloud.rings, (std::vector<std::uint16_t>{1, 0, 3, 5}));
  EXPECT_EQ(result.cloud.labels, (std::vector<std::uint16_t>{2, 0, 4, 70000 - 65536}));
  ASSERT_EQ(result.findings.size(), 3U);
  EXPECT_EQ(result.findings[0].text(), "3 values of 'intensity' left out (first: line 3: 'N/A' is not a number)");
  EXPECT_TRUE(result.findings[0].is_damage) << "oops";
  EXPECT_EQ(result.findings[1].text(),
            "1 values of 'ring' left out (line 3: '-1' is not a whole number from 0 to 65535)");
  EXPECT_EQ(result.findings[2].text(),
            "1 values of 'label' left out (line 3: '1.5' is not a whole number from 0 to 2^32-1)");
}

TEST_F(Xyz, AColumnOfNoNumbersIsNoAttributeAndNoDamage) {
  const ReadResult result =
      read("time,x,y,z,class,note\n2024-05-01T12:00:00,1,2,3,tree,a b\n2024-05-01,4,5,6,car,#2\n");
  EXPECT_EQ(result.cloud.positions, (Positions{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_TRUE(result.cloud.times.empty());
  EXPECT_TRUE(result.cloud.labels.empty());
  ASSERT_EQ(result.findings.size(), 2U);
  for (const ReadFinding& finding : result.findings) EXPECT_FALSE(finding.is_damage);
}

TEST_F(Xyz, ALineOfVeryManyColumnsTakesNoMemory) {
  std::string line = "x,y,z";
  for (int i = 0; i < 1'000'000; ++i) line += ",u";
  EXPECT_NE(error_for(line + "\n1,2,3\n").find("neither a point nor a header"), std::string::npos);
}

TEST_F(Xyz, FilesWithoutPointsAreAnError) {
  for (const char* text : {"", "\n\n", "# only a comment\n", "x y z\n"}) {
    EXPECT_EQ(error_for(text), ": the file holds no points") << text;
  }
  EXPECT_EQ(error_for("nan nan nan\n"), ": none of the 1 points is finite");
}

TEST_F(Xyz, TruncationAnywhereGivesFewerPointsOrAnError) {
  write_xyz(path_, random_cloud(3));
  for (std::size_t size = written_text().size(); size-- > 0;) {
    std::filesystem::resize_file(path_, size);
    try {
      EXPECT_LE(read_xyz(path_).cloud.size(), 3U);
    } catch (const IoError& error) {
      EXPECT_EQ(error.kind(), IoError::Kind::kMalformed);
    }
  }
}

TEST_F(Xyz, BinaryRubbishIsRefusedWithinAPrintableLine) {
  std::mt19937 random(3);
  for (int i = 0; i < 200; ++i) {
    std::string rubbish(random() % 300, '\0');
    for (char& byte : rubbish) byte = static_cast<char>(random());
    for (const char byte : error_for(rubbish)) ASSERT_TRUE(byte >= ' ' && byte <= '~');
  }
}

TEST_F(Xyz, CloudsThatCannotBeWrittenLeaveNoFile) {
  PointCloud cloud;
  EXPECT_THROW(write_xyz(path_, cloud), std::invalid_argument);
  cloud.positions = {{1, 2, 3}, {4, 5, 6}};
  cloud.labels = {1};
  EXPECT_THROW(write_xyz(path_, cloud), std::invalid_argument);
  cloud.labels = {};
  cloud.positions[1].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_xyz(path_, cloud), std::invalid_argument);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(Xyz, ArgoverseSweepIsReadAsItStands) {
  const auto data = test::real_data_folder();
  if (!data) GTEST_SKIP() << test::kNeedsRealData;
  const auto path = *data / "argoverse2" / "sweep_315966265259836000.csv";
  const PointCloud cloud = read_xyz(path).cloud;

  // Independent: the same columns through iostreams.
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  ASSERT_EQ(line, "x,y,z,intensity,laser_number,offset_ns");
  std::size_t num_points = 0;
  for (; std::getline(file, line); ++num_points) {
    ASSERT_LT(num_points, cloud.size());
    for (char& c : line) c = c == ',' ? ' ' : c;
    std::istringstream fields(line);
    double x, y, z, intensity, ring, offset_ns;
    fields >> x >> y >> z >> intensity >> ring >> offset_ns;
    ASSERT_EQ(cloud.positions[num_points], Eigen::Vector3d(x, y, z));
    ASSERT_EQ(cloud.intensities[num_points], intensity);
    ASSERT_EQ(cloud.rings[num_points], ring);
    ASSERT_NEAR(cloud.times[num_points], offset_ns * 1e-9, 1e-12);
  }
  EXPECT_EQ(num_points, cloud.size());
}

}  // namespace
}  // namespace vdbmap

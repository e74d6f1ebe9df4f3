// SPDX-License-Identifier: GPL-3.0-or-later
// Text tables as other programs write them.
#include "vdbmap/io/table/xyz_layout.h"

#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "vdbmap/io/points/point_format.h"
#include "vdbmap/io/table/xyz.h"

namespace vdbmap {
namespace {

using Positions = std::vector<Eigen::Vector3d>;
using Colors = std::vector<Rgb16>;

class XyzTables : public testing::Test {
 protected:
  ReadResult read(const std::string& text, const std::string& name = "table.txt") const {
    return read_points(test::write_raw(folder_ / name, text));
  }
  std::string error(const std::string& text, const std::string& name = "table.txt") const {
    return test::io_error_of([&] { read(text, name); });
  }
  ReadResult read_as(const std::string& text, const std::vector<std::string>& columns) const {
    return read_xyz(test::write_raw(folder_ / "table.txt", text), columns);
  }

  test::TemporaryFolder folder_;
};

const Positions kFar = {{389012.45, 5812345.12, 55.3}, {389013.45, 5812346.12, 55.35}};

TEST_F(XyzTables, NamesArePartedAsTheNumbersAre) {
  const std::string rows = "1,389012.45,5812345.12,55.30\n2,389013.45,5812346.12,55.35\n";
  for (const char* header :
       {"Point Number,X,Y,Z", "\"GPS time\",\"X\",\"Y\",\"Z\"", "t [s],x [m],y [m],z [m]", "No.,X(m),Y(m),Z(m)",
        "\"a, b\",X,Y,Z", "// Point Number , X , Y , Z", ";Point Number,X,Y,Z",
        "id,Easting (m),Northing (m),Elevation (m)", "id,EASTING,Northing,height", "id,East,North,Up",
        "id,Points:0,Points:1,Points:2", "id,\"Points_m_XYZ:0\",\"Points_m_XYZ:1\",\"Points_m_XYZ:2\"", ",x,y,z",
        "columns: a,x,y,z", "A x,pos_x,pos_y,pos_z"}) {
    EXPECT_EQ(read(std::string(header) + "\n" + rows).cloud.positions, kFar) << header;
  }
  EXPECT_EQ(read("#Point Number\tX\tY\tZ\n1\t389012.45\t5812345.12\t55.30\n2\t389013.45\t5812346.12\t55.35\n")
                .cloud.positions,
            kFar);
  EXPECT_EQ(read("x [m]  y [m]  z [m]\n389012.45 5812345.12 55.30\n389013.45 5812346.12 55.35\n").cloud.positions,
            kFar);
}

TEST_F(XyzTables, AHeaderIsNeverOverruledByTheNumberOfColumns) {
  EXPECT_EQ(error("Point Number X Y Z\n1 2 3 4\n"), "table.txt:1: the header has 5 names for 4 columns");
  EXPECT_EQ(error("x,y,z\n1,2,3,4,5,6\n"), "table.txt:1: the header has 3 names for 6 columns");
  EXPECT_EQ(error("//X Y Z R G B\n1 2 3\n"), "table.txt:1: the header has 6 names for 3 columns");
  EXPECT_EQ(read("x,y,z,\n1,2,3,\n").cloud.size(), 1U) << "a separator at the end";
  EXPECT_EQ(read("x,y,z,note\n1,2,3,\n4,5,6,\n").cloud.size(), 2U) << "an empty column at the end";
}

TEST_F(XyzTables, WholeSetsOfCoordinatesComeBeforeOthers) {
  const PointCloud cloud = read("easting,northing,x,y,z\n389012,5812345,1,2,3\n389013,5812346,4,5,6\n").cloud;
  EXPECT_EQ(cloud.positions, (Positions{{1, 2, 3}, {4, 5, 6}}));
}

TEST_F(XyzTables, NamesOfAnglesAreNoCoordinates) {
  for (const char* header : {"lon,lat,alt", "Latitude,Longitude,Height", "# lat lon h"}) {
    EXPECT_NE(error(std::string(header) + "\n13.1,52.5,30\n").find("project latitude and longitude"), std::string::npos)
        << header;
  }
}

TEST_F(XyzTables, UnitsOfNamesAreTurnedIntoMetresAndSeconds) {
  const ReadResult result = read("t [ms],X (mm),Y (mm),Z (mm)\n100,1500,2500,-3500\n200,4,5,6\n");
  EXPECT_TRUE(result.cloud.positions[0].isApprox(Eigen::Vector3d(1.5, 2.5, -3.5)));
  EXPECT_DOUBLE_EQ(result.cloud.times.at(1), 0.2);
  EXPECT_EQ(result.findings.size(), 1U);
  EXPECT_DOUBLE_EQ(read("timestamp_us,x,y,z\n500000,1,2,3\n").cloud.times.at(0), 0.5);
}

TEST_F(XyzTables, WholeTimesOfNoStatedUnitAreLeftOut) {
  const ReadResult livox =
      read("Version,Slot ID,LiDAR Index,Timestamp,X,Y,Z,Reflectivity\n5,0,0,1000,1.5,2.5,3.5,10\n");
  EXPECT_TRUE(livox.cloud.times.empty());
  EXPECT_EQ(livox.cloud.intensities, std::vector<float>{10});
  EXPECT_EQ(livox.findings.size(), 1U);
  EXPECT_EQ(read("timestamp,x,y,z\n1000.5,1,2,3\n").cloud.times, std::vector<double>{1000.5});
  EXPECT_EQ(read("time,x,y,z\n1000,1,2,3\n").cloud.times, std::vector<double>{1000});
}

TEST_F(XyzTables, DecimalCommasAreReadWhereTheyCannotPartColumns) {
  for (const char* text : {"X;Y;Z\n389012,45;5812345,12;55,30\n389013,45;5812346,12;55,35\n",
                           "389012,45;5812345,12;55,30\n389013,45;5812346,12;55,35\n",
                           "389012,45\t5812345,12\t55,30\n389013,45\t5812346,12\t55,35\n",
                           "389012,45 5812345,12 55,30\n389013,45 5812346,12 55,35\n",
                           "389012,45; 5812345,12; 55,30\n389013,45; 5812346,12; 55,35\n",
                           "\"389012,45\",\"5812345,12\",\"55,30\"\n\"389013,45\",\"5812346,12\",\"55,35\"\n"}) {
    EXPECT_EQ(read(text).cloud.positions, kFar) << text;
  }
  EXPECT_EQ(read("1,2,3\n").cloud.positions, (Positions{{1, 2, 3}})) << "columns";
  EXPECT_EQ(read("1;2;3,5\n").cloud.positions, (Positions{{1, 2, 3.5}}));
}

TEST_F(XyzTables, CommasOfDoubtfulMeaningAreRefused) {
  for (const char* text :
       {"389012,45,5812345,12,55,30\n389013,45,5812346,12,55,35\n", "1,05,2,10,3,15\n", "1,2;3\n4,5;6\n",
        "1,2,3;4,5,6\n", "1,234;5,678;9,012\n", "389,012.45;5,812,345.12;55.30\n", "389.012,45;5.812.345,12;55,30\n",
        "1,5;2.5;3,5\n", "X;Y;Z;I\n1,5;2,5;3,5;0.7\n4,5;5,5;6,5;0.8\n"}) {
    EXPECT_NE(error(text), "no error") << text;
  }
}

TEST_F(XyzTables, OrdersOfOtherProgramsAreKnownByTheirNumbers) {
  const Colors expected = {{65535, 128 * 257, 0}, {257, 514, 771}};
  const ReadResult leica = read("1 2 3 -1000 255 128 0\n4 5 6 100 1 2 3\n");
  EXPECT_EQ(leica.cloud.colors, expected);
  EXPECT_EQ(leica.cloud.intensities, (std::vector<float>{-1000, 100}));
  EXPECT_EQ(read("1 2 3 17 255 128 0\n4 5 6 100 1 2 3\n", "scan.pts").cloud.colors, expected);

  for (const char* text : {"1 2 3 255 128 0 17.500000\n4 5 6 1 2 3 18.000000\n",  // CloudCompare
                           "1 2 3 255 128 0 -1 0.5 7.5\n4 5 6 1 2 3 -2 0.5 8.5\n",
                           "1 2 3 255 128 0 0 0 1\n4 5 6 1 2 3 0.6 0.8 0\n"}) {  // Agisoft
    const ReadResult result = read(text);
    EXPECT_EQ(result.cloud.colors, expected) << text;
    EXPECT_EQ(result.findings.size(), 1U) << "what is taken for granted is said";
  }
  const ReadResult normals = read("1 2 3 0.6 0.8 0\n4 5 6 0 0 -1\n");
  EXPECT_TRUE(normals.cloud.colors.empty());
  EXPECT_EQ(read("1 2 3 0.6 0.8 0 255 128 0\n4 5 6 0 0 -1 1 2 3\n").cloud.colors, expected) << "MeshLab";
}

TEST_F(XyzTables, OrdersThatLeaveAChoiceAreAskedFor) {
  for (const char* text : {"1 2 3 4 5\n", "1 2 3 0.5 0.25 0.75\n", "1 2 3 0 0 1\n", "1 2 3 4 5 6 7\n",
                           "1 2 3 4 5 6 7 8\n", "1 2 3 0.5 4 5 6 7\n"}) {
    EXPECT_NE(error(text).find("--columns"), std::string::npos) << text;
  }
}

TEST_F(XyzTables, GivenColumnsDecide) {
  const ReadResult five = read_as("1 2 3 4 5\n", {"z", "y", "x", "-", "intensity"});
  EXPECT_EQ(five.cloud.positions, (Positions{{3, 2, 1}}));
  EXPECT_EQ(five.cloud.intensities, std::vector<float>{5});
  EXPECT_EQ(read_as("x,y,z\n1,2,3\n", {"y", "x", "z"}).cloud.positions, (Positions{{2, 1, 3}}));
  EXPECT_EQ(test::io_error_of([&] {
              read_as("1 2 3 4\n", {"x", "y", "z"});
            }),
            "table.txt:1: --columns has 3 names for 4 columns");
  EXPECT_THROW(read_as("1 2 3\n", {"x", "y", "depth"}), std::invalid_argument);
  EXPECT_THROW(read_as("1 2 3\n", {"x", "y", "-"}), std::invalid_argument);
}

TEST_F(XyzTables, CountsOnTopAreReadAndCompared) {
  for (const char* text : {"2\n1 2 3\n4 5 6\n", "//X Y Z\n2\n1 2 3\n4 5 6\n", "2\n//X Y Z\n1 2 3\n4 5 6\n",
                           "1\n1 2 3\n1\n4 5 6\n", " 2 \r\n1 2 3\r\n4 5 6\r\n"}) {
    const ReadResult result = read(text);
    EXPECT_EQ(result.cloud.positions, (Positions{{1, 2, 3}, {4, 5, 6}})) << text;
    EXPECT_TRUE(result.findings.empty()) << text;
  }
  const ReadResult fewer = read("5\n1 2 3\n4 5 6\n");
  EXPECT_EQ(fewer.cloud.size(), 2U);
  EXPECT_EQ(fewer.findings.at(0).text(), "1 counts of points that are not met (line 1 promises 5 points, 2 follow)");
  EXPECT_TRUE(fewer.findings.at(0).is_damage);
  EXPECT_NE(
      error("2\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n1 2 3 0.5\n4 5 6 1\n").find("PTX"),
      std::string::npos);
}

TEST_F(XyzTables, FirstLinesMayBeUnusual) {
  const Positions expected = {{1, 2, 3}, {4, 5, 6}};
  for (const char* text :
       {"Survey of a long street\n1 2 3\n4 5 6\n", "Survey 2024\nx,y,z\n1,2,3\n4,5,6\n", "x,y,z\nm,m,m\n1,2,3\n4,5,6\n",
        "sep=;\nx;y;z\n1;2;3\n4;5;6\n", "1 2 3\r4 5 6\r", "% matlab\n1 2 3\n4 5 6\n",
        "\n\n\xef\xbb\xbf# a\n1 2 3\n4 5 6\n", "x y z\n1 2 3\nx y z\n4 5 6\n"}) {
    const ReadResult result = read(text);
    EXPECT_EQ(result.cloud.positions, expected) << text;
    for (const ReadFinding& finding : result.findings) EXPECT_FALSE(finding.is_damage) << text;
  }
}

TEST_F(XyzTables, OtherFormatsOfTextAreNoTables) {
  EXPECT_NE(error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), "no error");
  EXPECT_NE(error("v 1 2 3\nv 4 5 6\nf 1 2 3\n"), "no error");
  EXPECT_NE(error("ncols 3\nnrows 2\nxllcorner 0\n1 2 3\n4 5 6\n", "dem.asc"), "no error");
  EXPECT_NE(error(std::string("\xff\xfe"
                              "1\0 \0",
                              6),
                  "utf16.csv")
                .find("UTF-16"),
            std::string::npos);
}

TEST_F(XyzTables, ColorsAreScaledByAllOfThem) {
  const auto first_color = [&](const std::string& rows) { return read("x y z r g b\n" + rows).cloud.colors.at(0); };
  EXPECT_EQ(first_color("1 2 3 255 128 0\n"), (Rgb16{65535, 128 * 257, 0}));
  EXPECT_EQ(first_color("1 2 3 255.0 128.0 0.0\n"), (Rgb16{65535, 128 * 257, 0}));
  EXPECT_EQ(first_color("1 2 3 255 128 0\n4 5 6 300 0 0\n"), (Rgb16{255, 128, 0}));
  EXPECT_EQ(first_color("1 2 3 1.0 0.5 0.0\n"), (Rgb16{65535, 32768, 0}));
  EXPECT_EQ(first_color("1 2 3 1 0 1\n"), (Rgb16{257, 0, 257})) << "whole numbers are of 8 bits";
  EXPECT_EQ(first_color("1 2 3 1 0 1\n1 2 3 0.5 0.5 0.5\n"), (Rgb16{65535, 0, 65535}));
}

TEST_F(XyzTables, LargeIntensitiesAreKept) {
  EXPECT_EQ(read("x,y,z,intensity\n1,2,3,16777217\n4,5,6,1e8\n").cloud.intensities,
            (std::vector<float>{16777216, 1e8F}));
  EXPECT_EQ(read("x,y,z,intensity\n1,2,3,1e12\n").findings.at(0).count, 1U) << "told, as a map leaves it out";
}

}  // namespace
}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "vdbmap/io/points/point_reader.h"

namespace vdbmap {
namespace {

namespace fs = std::filesystem;

const std::string kPoints = "1 2 3\n4 5 6\n";

class FolderOfScans : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& content = kPoints) const {
    test::write_raw(folder_ / name, content);
  }

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const fs::path& file : list_point_files({folder_.path()})) names.push_back(file.filename());
    return names;
  }

  std::vector<std::string> findings() const {
    std::vector<std::string> texts;
    for (const FileFinding& found : find_point_files({folder_.path()}).findings) {
      EXPECT_EQ(found.file, folder_.path());
      texts.push_back(found.finding.text());
    }
    return texts;
  }

  test::TemporaryFolder folder_;
};

TEST_F(FolderOfScans, TablesBesideScansAreNone) {
  for (const char* name : {"0.bin", "10.bin", "9.bin", "poses.txt", "times.TXT", "calib.txt"}) write(name);
  EXPECT_EQ(names(), (std::vector<std::string>{"0.bin", "9.bin", "10.bin"}));
  EXPECT_TRUE(findings().empty());  // text beside scans is usual

  write("poses.csv");
  write("vehicle.csv");
  EXPECT_EQ(names().size(), 3U);
  EXPECT_EQ(findings(),
            std::vector<std::string>{
                "2 text files that are no scans left out (first: poses.csv is named like a table of poses)"});
}

TEST_F(FolderOfScans, TablesThatAreNamedLikeTheScansGoOnWithThem) {
  for (const char* name : {"scan_1.bin", "scan_2.csv", "scan_10.bin", "scan_10.csv", "drive_3.csv"}) write(name);
  EXPECT_EQ(names(), (std::vector<std::string>{"scan_1.bin", "scan_2.csv", "scan_10.bin"}));
  EXPECT_EQ(findings(),
            std::vector<std::string>{
                "2 text files that are no scans left out (first: drive_3.csv is a table beside scans of other "
                "formats and names)"});
}

TEST_F(FolderOfScans, PointsAsTextMayStandBesideOtherScans) {
  for (const char* name : {"a.ply", "b.xyz", "c.asc"}) write(name);
  EXPECT_EQ(names(), (std::vector<std::string>{"a.ply", "b.xyz", "c.asc"}));
}

TEST_F(FolderOfScans, TextIsReadWhereThereIsNothingElse) {
  for (const char* name : {"2.txt", "10.txt"}) write(name);
  write("3.txt", "");  // a scan that is lost, in its place all the same
  write("poses.txt");
  write("license.txt", "Copyright 2024\nAll rights reserved: 1 2\n");
  EXPECT_EQ(names(), (std::vector<std::string>{"2.txt", "3.txt", "10.txt"}));
  EXPECT_EQ(findings(),
            std::vector<std::string>{
                "2 text files that are no scans left out (first: license.txt holds no rows of three numbers)"});
}

TEST_F(FolderOfScans, NamesSayWhatATableHolds) {
  write("1.csv");
  for (const char* name : {"gps.csv", "Vehicle-Poses.csv", "00_calib.csv", "imu_data.CSV", "times.csv", "odometry.xyz",
                           "trajectory.csv", "ground_truth_poses.csv", "oxts.csv", "LABELS.csv"}) {
    write(name);
  }
  EXPECT_EQ(names(), std::vector<std::string>{"1.csv"});
}

TEST_F(FolderOfScans, ContentSaysWhatATableHolds) {
  write("1.csv", "x,y,z,intensity\n1,2,3,4\n");
  write("2.csv", "//X Y Z\n1 2 3\n");
  write("3.csv", "2\n1 2 3\n4 5 6\n");  // a count on top
  write("4.csv", "\"Points_m_XYZ:0\",\"X\",\"Y\",\"Z\",\"azimuth\"\n1,2,3,4,5\n");
  write("kitti.csv", "1 0 0 5 0 1 0 6 0 0 1 7\n0 -1 0 5 1 0 0 6 0 0 1 7\n");
  write("tum.csv", "# a comment\n17.5 1 2 3 0 0 0.6 0.8\n17.6 1 2 3 0 0 0 1\n");
  write("a.csv", "timestamp,x,y,z,qx,qy,qz,qw\n1,2,3,4,0,0,0,1\n");
  write("b.csv", "time;lat;lon;alt\n1;52;9;55\n");
  write("c.csv", "P0: 7.2 0 6.1 0 0 7.2 1.7 0 0 0 1 0\n");
  write("d.csv", "1403636579.7\n1403636579.8\n");
  EXPECT_EQ(names(), (std::vector<std::string>{"1.csv", "2.csv", "3.csv", "4.csv"}));
  EXPECT_EQ(findings(),
            std::vector<std::string>{"6 text files that are no scans left out (first: a.csv has a column qx)"});
}

TEST_F(FolderOfScans, AFolderOfTablesAloneIsRefusedByName) {
  write("poses.txt");
  EXPECT_EQ(
      test::io_error_of([&] { names(); }).substr(folder_.path().filename().string().size()),
      ": the folder holds no point files (.ply .pcd .las .bin .xyz .csv .asc .txt .pcap); 1 text files that are no "
      "scans left out (poses.txt is named like a table of poses)");
}

TEST_F(FolderOfScans, AFileThatIsNamedIsReadWhateverItsName) {
  write("poses.csv");
  EXPECT_EQ(list_point_files({folder_ / "poses.csv"}).size(), 1U);
}

}  // namespace
}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/points/point_reader.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "vdbmap/io/points/point_format.h"

namespace vdbmap {
namespace {

namespace fs = std::filesystem;
using test::io_error_of;
using test::raw;

const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 "
    "3\n";
const std::string kPcd = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nDATA ascii\n1 2 3\n";

class PointReader : public testing::Test {
 protected:
  PointFormat detect(const std::string& name, const std::string& bytes) const {
    return detect_point_format(test::write_raw(folder_ / name, bytes));
  }
  Eigen::Vector3d first_point(const std::string& name, const std::string& bytes) const {
    return read_points(test::write_raw(folder_ / name, bytes)).cloud.positions.at(0);
  }
  std::string error(const std::string& name, const std::string& bytes) const {
    return io_error_of([&] { first_point(name, bytes); });
  }

  test::TemporaryFolder folder_;
};

TEST_F(PointReader, GoesByContentBeforeTheExtension) {
  const Eigen::Vector3d expected(1, 2, 3);
  EXPECT_EQ(first_point("scan.bin", kPly), expected);
  EXPECT_EQ(first_point("scan.ply", kPcd), expected);
  EXPECT_EQ(first_point("scan.las", "# by hand\n\n" + kPcd), expected);
  EXPECT_EQ(first_point("scan.ply", "// x y z\n1 2 3\n"), expected);
  EXPECT_EQ(first_point("scan", "1;2;3\n"), expected);
  EXPECT_EQ(detect("scan.bin", "LASF and more"), PointFormat::kLas);
  EXPECT_EQ(detect("scan.bin", "# .PCD v0.7"), PointFormat::kPcd);
}

TEST_F(PointReader, KnowsPacketCapturesOfBothByteOrders) {
  for (const std::uint32_t magic : {0xa1b2c3d4u, 0xa1b23c4du}) {
    EXPECT_EQ(detect("scan.bin", raw(magic)), PointFormat::kVlp16Pcap);
    EXPECT_EQ(detect("scan.bin", raw<std::endian::big>(magic)), PointFormat::kVlp16Pcap);
  }
  EXPECT_EQ(detect("scan.bin", raw(0x0a0d0d0au)), PointFormat::kVlp16Pcap);
}

TEST_F(PointReader, GoesByTheExtensionWhereTheContentSaysNothing) {
  EXPECT_EQ(first_point("scan.bin", raw(1.0f, 2.0f, 3.0f, 0.5f)), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(detect("SCAN.BIN", "some words"), PointFormat::kKittiBin);
  EXPECT_EQ(error("scan.ply", "pl"), "scan.ply:1: found 'pl', expected 'ply'");
  EXPECT_EQ(error("scan.pcd", "VERSI"), "scan.pcd:1: unexpected 'VERSI' in the header");
}

TEST_F(PointReader, TakesOtherTextForXyz) {
  EXPECT_EQ(detect("scan", "x,y,z\n1,2,3\n"), PointFormat::kXyz);
  EXPECT_EQ(detect("scan.dat", "\xef\xbb\xbfx y z\n"), PointFormat::kXyz);
  EXPECT_EQ(detect("scan.csv", "x,y,z\n1,2,3\n"), PointFormat::kXyz);
}

TEST_F(PointReader, RefusesEverythingElse) {
  EXPECT_EQ(error("scan.jpg", std::string("\xff\xd8\xff\x00", 4)),
            "scan.jpg: not a point file, expected PLY, PCD, LAS, LAZ, KITTI .bin, XYZ, CSV or VLP-16 .pcap");
  EXPECT_EQ(error("scan.ply", ""), "scan.ply: the file is empty");
  EXPECT_EQ(io_error_of([&] { read_points(folder_ / "none.ply"); }),
            "none.ply: cannot open: No such file or directory");
  EXPECT_NE(io_error_of([&] { read_points(folder_.path()); }).find("Is a directory"), std::string::npos);
}

TEST_F(PointReader, ReadsEveryKindOfRealFile) {
  const auto data = test::real_data_folder();
  if (!data) GTEST_SKIP() << test::kNeedsRealData;

  const ReadResult pair = read_points(*data / "pair" / "source.ply");
  EXPECT_EQ(pair.cloud.size(), 64685u);
  EXPECT_EQ(pair.dropped.size(), 5107u);  // lie at the origin: counted by another program
  EXPECT_EQ(read_points(*data / "velodyne" / "street_16beam.pcd").cloud.size(), 29377u);
  EXPECT_EQ(read_points(*data / "las" / "autzen_trim.las").cloud.size(), 110000u);
  EXPECT_GT(read_points(*data / "velodyne" / "vlp16_bench.pcap").cloud.size(), 1000u);
  EXPECT_EQ(detect_point_format(*data / "argoverse2" / "sweep_315966265259836000.csv"), PointFormat::kXyz);
  const auto scans = list_point_files({*data / "kitti_drive5" / "velodyne"});
  ASSERT_EQ(scans.size(), 64u);
  for (const fs::path& scan : scans) EXPECT_EQ(detect_point_format(scan), PointFormat::kKittiBin);
}

class PointFileList : public testing::Test {
 protected:
  void create(const fs::path& name) const { test::write_raw(folder_ / name, "1 2 3\n"); }

  std::vector<std::string> list(const std::vector<fs::path>& inputs) const {
    std::vector<std::string> names;
    for (const fs::path& file : list_point_files(inputs)) names.push_back(file.lexically_relative(folder_.path()));
    return names;
  }

  test::TemporaryFolder folder_;
};

TEST_F(PointFileList, SortsNumbersByValue) {
  for (const char* name :
       {"10.bin", "9.bin", "a10b2.ply", "a10b10.ply", "a9.ply", "010.bin", "100000000000000000000.bin"}) {
    create(name);
  }
  EXPECT_EQ(list({folder_.path()}), (std::vector<std::string>{"9.bin", "010.bin", "10.bin", "100000000000000000000.bin",
                                                              "a9.ply", "a10b2.ply", "a10b10.ply"}));
}

TEST_F(PointFileList, LeavesOutWhatIsNoPointFile) {
  fs::create_directory(folder_ / "deeper.ply");
  for (const char* name : {"scan.PCD", "poses.txt", "map.vdb", ".hidden.ply", "deeper.ply/scan.ply", "README"}) {
    create(name);
  }
  EXPECT_EQ(list({folder_.path()}), std::vector<std::string>{"scan.PCD"});
}

TEST_F(PointFileList, KeepsTheOrderOfItsInputs) {
  fs::create_directory(folder_ / "scans");
  for (const char* name : {"scans/2.las", "scans/1.las", "z.txt", "a.ply"}) create(name);
  EXPECT_EQ(list({folder_ / "z.txt", folder_ / "scans", folder_ / "a.ply"}),
            (std::vector<std::string>{"z.txt", "scans/1.las", "scans/2.las", "a.ply"}));
}

TEST_F(PointFileList, RefusesMissingInputsAndFoldersWithoutPoints) {
  fs::create_directory(folder_ / "empty");
  EXPECT_EQ(io_error_of([&] { list({folder_ / "missing"}); }), "missing: cannot open: No such file or directory");
  EXPECT_EQ(io_error_of([&] { list({folder_ / "empty"}); }),
            "empty: the folder holds no point files (.ply .pcd .las .bin .xyz .csv .asc .txt .pcap)");
}

}  // namespace
}  // namespace vdbmap

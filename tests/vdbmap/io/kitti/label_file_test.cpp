// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/kitti/label_file.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"

namespace vdbmap {
namespace {

using test::io_error_of;

class LabelFile : public testing::Test {
 protected:
  std::filesystem::path written(const std::vector<PointLabel>& labels) const {
    write_labels(folder_ / "a.label", labels);
    return folder_ / "a.label";
  }

  test::TemporaryFolder folder_;
};

TEST_F(LabelFile, ReadsWhatItWrites) {
  const std::vector<PointLabel> labels = {{10, 1}, {40, 0}, {70, 65534}};
  EXPECT_EQ(read_labels(written(labels)), labels);
  EXPECT_EQ(test::read_raw(folder_ / "a.label").substr(0, 4), std::string("\x0a\x00\x01\x00", 4));
}

TEST_F(LabelFile, AFileThatIsCutIsRefused) {
  test::write_raw(folder_ / "cut.label", "12345");
  EXPECT_NE(io_error_of([&] { read_labels(folder_ / "cut.label"); }).find("multiple of four"), std::string::npos);
  EXPECT_NE(io_error_of([&] { read_labels(folder_ / "none.label"); }).find("none.label"), std::string::npos);
}

TEST_F(LabelFile, PointsThatWereDroppedKeepTheirPlaceInIt) {
  const std::string nan = "nan 0 0\n";
  test::write_raw(folder_ / "a.xyz", nan + "1 0 0\n2 0 0\n" + nan + nan + "3 0 0\n" + nan);
  ReadResult read = read_points(folder_ / "a.xyz");
  EXPECT_EQ(read.dropped, (std::vector<std::size_t>{0, 3, 4, 6}));
  attach_labels(read, written({{1, 0}, {2, 7}, {3, 7}, {4, 7}, {5, 7}, {6, 7}, {7, 7}}));
  EXPECT_EQ(read.cloud.labels, (std::vector<std::uint16_t>{2, 3, 6}));
  EXPECT_EQ(read.label_scheme, LabelScheme::kSemanticKitti);
}

TEST_F(LabelFile, PointsDroppedForDifferentReasonsKeepTheirPlacesInIt) {
  test::write_raw(folder_ / "a.xyz", "0 0 0\nnan 0 0\n1 0 0\n0 0 0\nnan 0 0\nnan 0 0\n0 0 0\n2 0 0\n");
  ReadResult read = read_points(folder_ / "a.xyz");
  EXPECT_EQ(read.dropped, (std::vector<std::size_t>{0, 1, 3, 4, 5, 6}));
  EXPECT_EQ(read.num_non_finite, 3U);
  attach_labels(read, written({{1, 0}, {2, 7}, {3, 7}, {4, 7}, {5, 7}, {6, 7}, {7, 7}, {8, 7}}));
  EXPECT_EQ(read.cloud.labels, (std::vector<std::uint16_t>{3, 8}));
}

TEST_F(LabelFile, AnotherNumberOfPointsIsRefused) {
  test::write_raw(folder_ / "a.xyz", "1 0 0\n2 0 0\nnan 0 0\n");
  for (const std::size_t count : {0UL, 2UL, 4UL}) {
    ReadResult read = read_points(folder_ / "a.xyz");
    const std::filesystem::path file = written(std::vector<PointLabel>(count));
    const std::string expected = "a.label: has labels of " + std::to_string(count) + " points, the scan has 3";
    EXPECT_EQ(io_error_of([&] { attach_labels(read, file); }), expected);
  }
}

}  // namespace
}  // namespace vdbmap

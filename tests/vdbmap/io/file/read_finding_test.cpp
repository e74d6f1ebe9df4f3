// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/file/read_finding.h"

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "vdbmap/io/points/point_reader.h"

namespace vdbmap {
namespace {

TEST(ReadFinding, IsOneLine) {
  EXPECT_EQ((ReadFinding{"withheld points left out", 3, "point 12"}.text()),
            "3 withheld points left out (first: point 12)");
  EXPECT_EQ((ReadFinding{"packets left out", 1, "byte 40: not whole"}.text()),
            "1 packets left out (byte 40: not whole)");
  EXPECT_EQ((ReadFinding{"the header has no end"}.text()), "the header has no end");
}

TEST(ReadFinding, ThingsOfOneKindAreCountedTogether) {
  std::vector<ReadFinding> findings;
  add_finding(findings, {"packets left out", 1, "byte 40", true});
  add_finding(findings, {"packets left out", 2, "byte 90", true});
  add_finding(findings, {"packets left out", 4, "", false});
  const std::vector<ReadFinding> expected = {{"packets left out", 3, "byte 40", true},
                                             {"packets left out", 4, "", false}};
  EXPECT_EQ(findings, expected);
}

class PointsAtTheOrigin : public testing::Test {
 protected:
  ReadResult read(const std::string& text, bool is_in_sensor_frame) const {
    ReadOptions options;
    options.is_in_sensor_frame = is_in_sensor_frame;
    return read_points(test::write_raw(folder_ / "a.xyz", text), options);
  }

  test::TemporaryFolder folder_;
};

TEST_F(PointsAtTheOrigin, AreNoMeasurementsOfASensor) {
  const ReadResult one = read("1 2 3\n0 0 0\n", true);
  EXPECT_EQ(one.cloud.positions, std::vector<Eigen::Vector3d>{Eigen::Vector3d(1, 2, 3)});
  ASSERT_EQ(one.findings.size(), 1U);
  EXPECT_EQ(one.findings[0].count, 1U);
  EXPECT_FALSE(one.findings[0].is_damage);
}

TEST_F(PointsAtTheOrigin, AreThoseThatNoSensorCanMeasureForTheyAreTooNear) {
  const ReadResult result = read("0.001 -0.002 1e-9\n1 2 3\n0 0 -0.009\n0.0099 0.002 0\n0.05 0 0\n", true);
  EXPECT_EQ(result.cloud.positions, (std::vector<Eigen::Vector3d>{{1, 2, 3}, {0.0099, 0.002, 0}, {0.05, 0, 0}}));
  EXPECT_EQ(result.dropped, (std::vector<std::size_t>{0, 2}));
}

TEST_F(PointsAtTheOrigin, AndThoseThatAreNotFiniteKeepTheirPlacesInTheFile) {
  const ReadResult result = read("nan nan nan\n0 0 0\n1 2 3\n0 0 0\nnan 0 0\n4 5 6\n", true);
  EXPECT_EQ(result.dropped, (std::vector<std::size_t>{0, 1, 3, 4}));
  EXPECT_EQ(result.num_non_finite, 2U);
  EXPECT_EQ(result.cloud.size(), 2U);
}

TEST_F(PointsAtTheOrigin, MayBeOneOfAModelButNotTwo) {
  EXPECT_EQ(read("1 2 3\n0 0 0\n", false).cloud.size(), 2U);
  EXPECT_EQ(read("-0 0 0\n1 2 3\n0 0 0\n", false).cloud.size(), 1U);
  EXPECT_EQ(read("0 0 1e-9\n1 2 3\n0 0 1e-9\n", false).cloud.size(), 3U);
}

TEST_F(PointsAtTheOrigin, AloneAreNoPoints) {
  EXPECT_EQ(test::io_error_of([&] { read("0 0 0\n0 0 0\n", false); }),
            "a.xyz: all of its points lie at the sensor's origin");
}

}  // namespace
}  // namespace vdbmap

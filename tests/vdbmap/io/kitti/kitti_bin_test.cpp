// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/kitti/kitti_bin.h"

#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"

namespace vdbmap {
namespace {

using test::io_error_of;
using test::raw;

class KittiBin : public testing::Test {
 protected:
  ReadResult read(const std::string& bytes) const {
    return read_kitti_bin(test::write_raw(folder_ / "scan.bin", bytes));
  }
  std::string error(const std::string& bytes) const {
    return io_error_of([&] { read(bytes); });
  }

  test::TemporaryFolder folder_;
};

TEST_F(KittiBin, ReadsPositionAndIntensity) {
  const ReadResult result = read(raw(1.5f, -2.5f, 0.25f, 0.75f, 4.0f, 5.0f, 6.0f, 0.0f));
  ASSERT_EQ(result.cloud.size(), 2u);
  EXPECT_EQ(result.cloud.positions[0], Eigen::Vector3d(1.5, -2.5, 0.25));
  EXPECT_EQ(result.cloud.intensities, (std::vector<float>{0.75f, 0.0f}));
}

TEST_F(KittiBin, DropsAndCountsPointsThatAreNotFinite) {
  const ReadResult result = read(raw(NAN, 0.0f, 0.0f, 1.0f, 4.0f, 5.0f, 6.0f, 2.0f, 0.0f, -INFINITY, 0.0f, 3.0f));
  EXPECT_EQ(result.dropped.size(), 2u);
  EXPECT_EQ(result.cloud.intensities, std::vector<float>{2.0f});
}

TEST_F(KittiBin, RefusesSizesThatFitNoLayout) {
  EXPECT_EQ(error(raw(1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f)),
            "scan.bin: its 28 bytes are not plainly points of 3 to 6 numbers each; name the numbers of a point, as in "
            "--bin-columns x,y,z,intensity,ring");
  EXPECT_EQ(error(""), "scan.bin: the file holds no points");
}

TEST_F(KittiBin, WritesZeroWhereThereIsNoIntensity) {
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}};
  write_kitti_bin(folder_ / "scan.bin", cloud);
  EXPECT_EQ(test::read_raw(folder_ / "scan.bin"), raw(1.0f, 2.0f, 3.0f, 0.0f));
}

// A turn of a scanner in a street: ground, walls, and intensities.
struct Return {
  float x, y, z, intensity, ring;
};

std::vector<Return> street(std::size_t count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<Return> points;
  for (std::size_t i = 0; i < count; ++i) {
    const float angle = 6.2832F * unit(random);
    const float range = 3 + 60 * unit(random) * unit(random);
    const bool is_ground = i % 3 != 0;
    points.push_back({range * std::cos(angle), range * std::sin(angle), is_ground ? -1.7F : 4 * unit(random) - 1.7F,
                      unit(random), static_cast<float>(i % 32)});
  }
  return points;
}

using Columns = std::function<std::string(const Return&)>;

TEST_F(KittiBin, KnowsTheNumbersOfAPointByWhatTheyAre) {
  struct Layout {
    const char* name;
    Columns bytes;
    bool has_intensities;
    bool has_rings;
  };
  const Layout layouts[] = {
      {"xyz", [](const Return& p) { return raw(p.x, p.y, p.z); }, false, false},
      {"nuScenes", [](const Return& p) { return raw(p.x, p.y, p.z, 255 * p.intensity, p.ring); }, true, true},
      {"ring and time", [](const Return& p) { return raw(p.x, p.y, p.z, p.intensity, p.ring, 0.1F * p.intensity); },
       true, true},
      {"normal", [](const Return& p) { return raw(p.x, p.y, p.z, 0.0F, 0.6F, -0.8F); }, false, false},
      {"doubles", [](const Return& p) { return raw(0.1 + p.x, 0.1 + p.y, 0.1 + p.z); }, false, false},
      {"doubles of floats", [](const Return& p) { return raw<>(double{p.x}, double{p.y}, double{p.z}); }, false, false},
      {"doubles with intensity", [](const Return& p) { return raw(0.1 + p.x, 0.1 + p.y, 0.1 + p.z, 0.3); }, true,
       false},
      {"map coordinates", [](const Return& p) { return raw(389000 + p.x, 5812000 + p.y, 50 + p.z); }, false, false},
  };
  // 60 and 240 points fit every number of columns; of 7 and 61 few do.
  for (const std::size_t count : {7U, 60U, 61U, 240U, 20000U}) {
    for (const Layout& layout : layouts) {
      std::string bytes;
      for (const Return& point : street(count)) bytes += layout.bytes(point);
      const ReadResult result = read(bytes);
      ASSERT_EQ(result.cloud.size(), count) << layout.name;
      EXPECT_EQ(!result.cloud.intensities.empty(), layout.has_intensities) << layout.name << " " << count;
      EXPECT_EQ(!result.cloud.rings.empty(), layout.has_rings) << layout.name << " " << count;
      ASSERT_EQ(result.findings.size(), 1U) << layout.name << " " << count;
      EXPECT_FALSE(result.findings[0].is_damage);
    }
  }
}

TEST_F(KittiBin, FilesOfKittiAreReadWithoutAWord) {
  for (const std::size_t count : {1U, 2U, 3U, 5U, 6U, 15U, 60U, 240U, 20000U}) {
    std::string bytes;
    for (const Return& p : street(count)) bytes += raw(p.x, p.y, p.z, p.intensity);
    const ReadResult result = read(bytes);
    ASSERT_EQ(result.cloud.size(), count);
    EXPECT_EQ(result.cloud.intensities.size(), count);
    EXPECT_TRUE(result.findings.empty());
  }
}

TEST_F(KittiBin, AsksWhereNumbersMayMeanSeveralThings) {
  std::string elongation, colors;
  for (const Return& p : street(100)) {
    elongation += raw(p.x, p.y, p.z, p.intensity, 0.3F * p.intensity);
    colors += raw(p.x, p.y, p.z, 255.0F, 128.0F, p.ring);
  }
  for (const std::string& bytes : {elongation, colors}) {
    EXPECT_NE(error(bytes).find("name the numbers of a point, as in --bin-columns"), std::string::npos);
  }
  const std::filesystem::path path = test::write_raw(folder_ / "scan.bin", elongation);
  const ReadResult named = read_kitti_bin(path, {"x", "y", "z", "i", "-"});
  EXPECT_EQ(named.cloud.size(), 100U);
  EXPECT_EQ(named.cloud.intensities.at(0), street(100)[0].intensity);
  EXPECT_TRUE(named.findings.empty());
  EXPECT_EQ(read_kitti_bin(path, {"z", "y", "x", "-", "i"}).cloud.positions.at(0).z(), street(100)[0].x);
  EXPECT_EQ(read_kitti_bin(path, {"x", "y", "z", "-", "-"}, ScalarType::kFloat64).cloud.size(), 50U);
  EXPECT_THROW(read_kitti_bin(path, {"x", "y", "zz"}), std::invalid_argument);
  EXPECT_THROW(read_kitti_bin(path, {"x", "y"}), std::invalid_argument);
}

TEST_F(KittiBin, AFileCutWithinAPointKeepsTheWholeOnes) {
  std::string bytes;
  for (const Return& p : street(100)) bytes += raw(p.x, p.y, p.z, p.intensity);
  for (const std::size_t left : {1U, 4U, 12U, 15U}) {
    const ReadResult result = read(bytes.substr(0, bytes.size() - 16 + left));
    EXPECT_EQ(result.cloud.size(), 99U);
    const std::vector<ReadFinding> expected = {{"bytes of a point that the end of the file cuts off", left, "", true}};
    EXPECT_EQ(result.findings, expected) << left;
  }
}

TEST_F(KittiBin, ReadsTheScansOfKitti) {
  const auto data = test::real_data_folder();
  if (!data) GTEST_SKIP() << test::kNeedsRealData;

  const std::filesystem::path path = list_point_files({*data / "kitti_drive5" / "velodyne"}).front();
  const PointCloud cloud = read_kitti_bin(path).cloud;
  const std::string bytes = test::read_raw(path);
  ASSERT_EQ(cloud.size(), bytes.size() / 16);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const char* record = bytes.data() + 16 * i;
    ASSERT_EQ(cloud.positions[i],
              Eigen::Vector3d(load<float>(record), load<float>(record + 4), load<float>(record + 8)));
    ASSERT_LT(cloud.positions[i].norm(), 130.0);  // [m] the sensor's range
    ASSERT_EQ(cloud.intensities[i], load<float>(record + 12));
    ASSERT_LE(cloud.intensities[i], 1.0f);
  }
}

}  // namespace
}  // namespace vdbmap

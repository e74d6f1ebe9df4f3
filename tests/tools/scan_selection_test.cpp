// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/scan_selection.h"

#include <string>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "vdbmap/core/error.h"

namespace vdbmap::cli {
namespace {

// Pose number i stands at x = i.
Trajectory poses_along_x(std::size_t count) {
  Trajectory poses;
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation().x() = static_cast<double>(i);
    poses.map_from_scan.emplace_back(pose);
  }
  return poses;
}

std::vector<double> x_of(const Trajectory& poses) {
  std::vector<double> x;
  for (const auto& pose : poses.map_from_scan) x.push_back(pose->translation().x());
  return x;
}

TEST(ScanSelection, CountsFromTheOffsetInSteps) {
  using Indices = std::vector<std::size_t>;
  EXPECT_EQ((ScanSelection{}.indices(3)), (Indices{0, 1, 2}));
  EXPECT_EQ((ScanSelection{2, 0}.indices(5)), (Indices{0, 2, 4}));
  EXPECT_EQ((ScanSelection{2, 1}.indices(5)), (Indices{1, 3}));
  EXPECT_EQ((ScanSelection{3, 4}.indices(8)), (Indices{4, 7}));
  EXPECT_EQ((ScanSelection{1, 9}.indices(5)), Indices{});
  EXPECT_EQ((ScanSelection{2, 0}.indices(0)), Indices{});
}

TEST(ScanSelection, ScansAndTheirPosesStayTogether) {
  const ScanSelection selection{2, 1};
  const std::vector<ScanPlace> scans = {{"0.bin", {}}, {"1.pcap", 0}, {"1.pcap", 1}, {"1.pcap", 2}};
  EXPECT_EQ(select(scans, selection), (std::vector<ScanPlace>{{"1.pcap", 0}, {"1.pcap", 2}}));
  Trajectory poses = poses_along_x(4);
  poses.times = {10, 11, 12, 13};
  const Trajectory chosen = select(poses, selection);
  EXPECT_EQ(x_of(chosen), (std::vector<double>{1, 3}));
  EXPECT_EQ(chosen.times, (std::vector<double>{11, 13}));
}

class SelectedPoses : public testing::Test {
 protected:
  Trajectory read(std::size_t num_poses, const ScanSelection& selection, std::size_t num_wanted) const {
    const std::filesystem::path path = folder_ / "poses.txt";
    return selected_poses(poses_along_x(num_poses), path, selection, num_wanted);
  }

  test::TemporaryFolder folder_;
};

TEST_F(SelectedPoses, AFileForTheWholeSequenceIsSelectedFrom) {
  EXPECT_EQ(x_of(read(5, {2, 1}, 2)), (std::vector<double>{1, 3}));
}

TEST_F(SelectedPoses, AFileForTheSelectedScansIsTakenWhole) {
  EXPECT_EQ(x_of(read(3, {2, 0}, 3)), (std::vector<double>{0, 1, 2}));
}

TEST_F(SelectedPoses, OtherCountsAreRefusedWithAllOfThem) {
  try {
    read(5, {2, 1}, 3);
    FAIL();
  } catch (const IoError& error) {
    const std::string message = error.what();
    EXPECT_EQ(error.kind(), IoError::Kind::kMalformed);
    EXPECT_NE(message.find("5 poses, 2 of them chosen by --every 2 --offset 1, but 3 are needed"), std::string::npos);
  }
}

}  // namespace
}  // namespace vdbmap::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/segmentation/network.h"

#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "parking/segmentation/surface_class.h"
#include "parking/segmentation/voxel_features.h"
#include "tests/support/folders.h"
#include "tests/support/run_command.h"
#include "tests/support/sample_maps.h"
#include "tests/support/threads.h"

namespace vdbmap::parking {
namespace {

// A cloud, and what PyTorch says of each point's voxel.
struct Scored {
  PointCloud cloud;
  std::vector<std::array<double, kNumClasses>> scores;
};

Scored read_scored(const std::filesystem::path& path) {
  Scored scored;
  std::ifstream file(path);
  for (Eigen::Vector3d point; file >> point.x() >> point.y() >> point.z();) {
    scored.cloud.positions.push_back(point);
    scored.scores.emplace_back();
    for (double& score : scored.scores.back()) file >> score;
  }
  return scored;
}

class PyTorch : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    result_ = test::run_command("/usr/bin/python3",
                                {VDBMAP_SOURCE_DIR "/tests/exchange/network_test.py", folder_->path().string()});
  }
  static void TearDownTestSuite() { folder_.reset(); }

  void SetUp() override {
    if (result_.exit_code == 77) GTEST_SKIP() << "needs PyTorch (python3-torch)";
    ASSERT_EQ(result_.exit_code, 0) << result_.err;
  }

  static inline std::unique_ptr<test::TemporaryFolder> folder_;
  static inline test::CommandResult result_;
};

TEST_F(PyTorch, HasTheSameScoresFromTheSameWeights) {
  const NetworkWeights network = *read_network(*folder_ / "weights.kpconv");
  const Scored scored = read_scored(*folder_ / "scores.txt");
  ASSERT_EQ(scored.cloud.size(), 4000U);
  const VoxelMap map = test::fine_map_of(scored.cloud);
  const Rows scores = class_scores(network, make_pyramid(map.finest()), voxel_features(map.finest()));
  const VoxelFinder finder(map.finest());
  double largest = 0;
  for (std::size_t i = 0; i < scored.cloud.size(); ++i) {
    const VoxelRecord* record = finder.find(voxel_of_point(scored.cloud.positions[i], 10));
    ASSERT_NE(record, nullptr);
    const auto row = scores.row(record - map.finest().records().data());
    for (std::size_t c = 0; c < kNumClasses; ++c) {
      ASSERT_NEAR(row[static_cast<Eigen::Index>(c)], scored.scores[i][c], 1e-4) << i;
      largest = std::max(largest, std::abs(scored.scores[i][c]));
    }
  }
  EXPECT_GT(largest, 0.1);  // else nothing would have been compared
}

TEST_F(PyTorch, TheNumberOfThreadsChangesNothing) {
  const NetworkWeights network = *read_network(*folder_ / "weights.kpconv");
  const VoxelMap map = test::fine_map_of(read_scored(*folder_ / "scores.txt").cloud);
  const auto scores = [&](int threads) {
    return test::on_threads(
        threads, [&] { return class_scores(network, make_pyramid(map.finest()), voxel_features(map.finest())); });
  };
  const Rows one = scores(1);
  EXPECT_TRUE((one.array() == scores(4).array()).all());
}

TEST(KernelPoints, AreOneAndAHalfVoxelsFromTheMiddle) {
  const auto points = kernel_points();
  EXPECT_TRUE(points.col(0).isZero());
  for (Eigen::Index i = 1; i < points.cols(); ++i) EXPECT_NEAR(points.col(i).norm(), 1.5, 1e-6);
  EXPECT_TRUE(points.rowwise().sum().isZero(1e-5F));
  EXPECT_TRUE(points.col(1).isApprox(Eigen::Vector3f(-1.5F, 0, 0)));
  EXPECT_TRUE(points.col(7).isApprox(Eigen::Vector3f::Constant(-1.5F / std::sqrt(3.0F))));
}

}  // namespace
}  // namespace vdbmap::parking

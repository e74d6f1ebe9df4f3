// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/deskew_stream.h"

#include <vector>

#include <gtest/gtest.h>

namespace vdbmap::registration {
namespace {

PointCloud scan_at(double time) {
  PointCloud scan;
  scan.positions = {{1, 0, 0}, {2, 0, 0}};
  scan.times = {time, time + 0.1};
  return scan;
}

OdometryStep step_at(double time, double speed) {
  OdometryStep step;
  step.has_time = true;
  step.motion.reference_time = time;
  step.motion.twist[3] = speed;
  return step;
}

struct Received {
  std::vector<double> last_x;  // of each scan's second point
  DeskewStream stream{[this](const PointCloud& scan, const Eigen::Isometry3d&, const ScanMotion&) {
    last_x.push_back(scan.positions.back().x());
  }};
};

TEST(DeskewStream, TheFirstScanHasTheMotionOfTheSecond) {
  Received received;
  received.stream.add(scan_at(0), step_at(0, 0));
  EXPECT_TRUE(received.last_x.empty());
  received.stream.add(scan_at(0.2), step_at(0.2, 10));
  received.stream.add(scan_at(0.4), step_at(0.4, 20));
  received.stream.finish();
  ASSERT_EQ(received.last_x.size(), 3U);
  EXPECT_NEAR(received.last_x[0], 3, 1e-12);
  EXPECT_NEAR(received.last_x[1], 3, 1e-12);
  EXPECT_NEAR(received.last_x[2], 4, 1e-12);
}

TEST(DeskewStream, ASingleScanIsHandedOnAtTheEnd) {
  Received received;
  received.stream.add(scan_at(0), step_at(0, 0));
  received.stream.finish();
  EXPECT_EQ(received.last_x, std::vector<double>{2});
}

TEST(DeskewStream, ScansThatWereNotRegisteredAreLeftOut) {
  Received received;
  OdometryStep lost = step_at(0, 5);
  lost.reason = "lost";
  received.stream.add(scan_at(0), lost);
  received.stream.finish();
  EXPECT_TRUE(received.last_x.empty());
}

}  // namespace
}  // namespace vdbmap::registration

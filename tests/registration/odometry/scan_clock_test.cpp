// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/scan_clock.h"

#include <limits>

#include <gtest/gtest.h>

namespace vdbmap::registration {
namespace {

// A scan of `count` points, evenly from `first` over `duration` [s].
PointCloud scan(double first, double duration = 0.1, std::size_t count = 11) {
  PointCloud cloud;
  cloud.positions.assign(count, Eigen::Vector3d(10, 0, 0));
  for (std::size_t i = 0; i < count; ++i) {
    cloud.times.push_back(first + duration * static_cast<double>(i) / static_cast<double>(count - 1));
  }
  return cloud;
}

TEST(ScanClock, MeasuresFromFirstPointToFirstPoint) {
  ScanClock clock;
  EXPECT_EQ(clock.next(scan(100)).first, 100.0);
  const ScanTiming next = clock.next(scan(100.2));
  EXPECT_EQ(next.first, 100.2);
  EXPECT_NEAR(next.interval, 0.2, 1e-12);
  EXPECT_EQ(next.problem, "");
}

TEST(ScanClock, ThePointsNeedNoOrder) {
  PointCloud cloud = scan(100);
  std::swap(cloud.times.front(), cloud.times.back());
  EXPECT_EQ(ScanClock().next(cloud).first, 100.0);
}

TEST(ScanClock, TimesThatBeginAnewWithEachScanFollowOneAnother) {
  ScanClock clock;
  clock.next(scan(0, 0.1));
  const ScanTiming next = clock.next(scan(0.002, 0.05));
  EXPECT_EQ(next.first, 0.002);
  EXPECT_NEAR(next.interval, 0.05, 1e-12);
}

TEST(ScanClock, TimesThatBeginAnewGoOnByTheScansThatAreLeftOut) {
  ScanClock clock;
  clock.next(scan(0));
  clock.pass_over(2);
  const ScanTiming third = clock.next(scan(0.001));
  EXPECT_NEAR(third.interval, 0.3, 1e-12);
  EXPECT_NEAR(third.elapsed, 0.3, 1e-12);
  EXPECT_NEAR(clock.next(scan(0)).interval, 0.1, 1e-12);
}

TEST(ScanClock, TimesOfACommonEpochTellOfTheScansThatAreLeftOutThemselves) {
  ScanClock clock;
  clock.next(scan(100));
  clock.pass_over(2);
  EXPECT_NEAR(clock.next(scan(100.3)).interval, 0.3, 1e-12);
  EXPECT_NEAR(clock.next(scan(100.4)).usual_interval, 0.1, 1e-12);
}

TEST(ScanClock, WithoutTimesEveryScanThatIsLeftOutTakesTheUsualTurn) {
  ScanClock clock;
  PointCloud without = scan(0);
  without.times.clear();
  clock.next(scan(5));
  clock.next(scan(5.25));
  clock.pass_over(1);
  EXPECT_NEAR(clock.next(without).interval, 0.5, 1e-12);
  EXPECT_NEAR(clock.next(without).interval, 0.25, 1e-12);
}

TEST(ScanClock, TheTurnOfAScanWithoutUsableTimesIsNotCountedTwice) {
  ScanClock clock;
  PointCloud useless = scan(100.1, 0);
  clock.next(scan(100));
  clock.next(useless);
  const ScanTiming after = clock.next(scan(100.2));
  EXPECT_NEAR(after.interval, 0.1, 1e-12);
  EXPECT_NEAR(after.elapsed, 0.2, 1e-12);
}

TEST(ScanClock, WithoutTimesTheLastIntervalGoesOn) {
  ScanClock clock;
  PointCloud without = scan(0);
  without.times.clear();
  EXPECT_EQ(clock.next(without).interval, 0.1);
  EXPECT_EQ(clock.next(without).first, std::nullopt);
  EXPECT_EQ(clock.next(without).problem, "");
  clock.next(scan(5));
  clock.next(scan(5.25));
  EXPECT_NEAR(clock.next(without).interval, 0.25, 1e-12);
}

TEST(ScanClock, RefusesTimesThatGoBackAndGoesOnFromThere) {
  ScanClock clock;
  clock.next(scan(100));
  const ScanTiming back = clock.next(scan(90));
  EXPECT_EQ(back.first, std::nullopt);
  EXPECT_EQ(back.problem, "its time stamps go back by 10 s");
  EXPECT_NEAR(back.interval, 0.1, 1e-12);
  EXPECT_EQ(clock.next(scan(90.1)).problem, "");
}

TEST(ScanClock, RefusesTimesOfNoUse) {
  PointCloud constant = scan(3, 0);
  EXPECT_EQ(ScanClock().next(constant).problem, "all its time stamps are the same");
  EXPECT_EQ(ScanClock().next(scan(3, 20)).problem, "its time stamps span 20 s, more than the 1 s of a turn");
  PointCloud nan = scan(3);
  nan.times[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(ScanClock().next(nan).problem, "a time stamp is not finite");
  nan.times[4] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(ScanClock().next(nan).problem, "a time stamp is not finite");
  PointCloud few = scan(3);
  few.times.pop_back();
  EXPECT_EQ(ScanClock().next(few).problem, "10 times for 11 points");
  EXPECT_EQ(ScanClock().next(few).first, std::nullopt);
}

}  // namespace
}  // namespace vdbmap::registration

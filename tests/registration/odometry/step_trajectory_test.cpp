// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/step_trajectory.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace vdbmap::registration {
namespace {

OdometryStep step_after(double time, double elapsed) {
  OdometryStep step;
  step.has_time = true;
  step.motion.reference_time = time;
  step.motion.elapsed = elapsed;
  return step;
}

OdometryStep lost(OdometryStep step) {
  step.reason = "lost";
  return step;
}

OdometryStep without_time(OdometryStep step) {
  step.has_time = false;
  return step;
}

TEST(StepTrajectory, AScanThatIsNotRegisteredKeepsItsTimeAndTheOthersTheirs) {
  const Trajectory trajectory =
      trajectory_of(std::vector{step_after(100, 0), lost(step_after(100.1, 0.1)), step_after(100.2, 0.2)});
  EXPECT_EQ(trajectory.times, (std::vector<double>{100, 100.1, 100.2}));
  EXPECT_FALSE(trajectory.map_from_scan[1]);
  EXPECT_TRUE(trajectory.map_from_scan[2]);
}

TEST(StepTrajectory, AScanThatCannotBeReadCostsTheOthersNoTime) {
  const Trajectory trajectory = trajectory_of(
      std::vector{step_after(100, 0), lost(OdometryStep()), step_after(100.2, 0.2), step_after(100.3, 0.3)});
  ASSERT_EQ(trajectory.times.size(), 4U);
  EXPECT_TRUE(std::isnan(trajectory.times[1]));
  EXPECT_EQ(trajectory.times[2], 100.2);
}

TEST(StepTrajectory, AScanWithoutAUsableTimeCostsTheOthersNone) {
  const Trajectory trajectory =
      trajectory_of(std::vector{step_after(100, 0), step_after(100.1, 0.1), without_time(step_after(0, 0.2)),
                                step_after(100.3, 100.5), step_after(100.4, 100.6)});
  ASSERT_EQ(trajectory.times.size(), 5U);
  EXPECT_TRUE(std::isnan(trajectory.times[2]));
  EXPECT_TRUE(trajectory.map_from_scan[2]);
  EXPECT_EQ(trajectory.times[3], 100.3);
}

TEST(StepTrajectory, TimesThatBeginAnewWithEachScanAreNone) {
  EXPECT_TRUE(
      trajectory_of(std::vector{step_after(0, 0), step_after(0.001, 0.1), step_after(0.002, 0.2)}).times.empty());
  EXPECT_TRUE(
      trajectory_of(std::vector{without_time(step_after(0, 0)), without_time(step_after(0, 0.1))}).times.empty());
  EXPECT_TRUE(trajectory_of({}).times.empty());
}

TEST(StepTrajectory, ASingleScanHasItsTime) {
  EXPECT_EQ(trajectory_of(std::vector{step_after(100, 0)}).times, std::vector<double>{100});
}

}  // namespace
}  // namespace vdbmap::registration

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/progress.h"

#include <gtest/gtest.h>

namespace vdbmap::cli {
namespace {

using std::chrono::seconds;

TEST(Progress, SaysRateAndRemainingTime) {
  EXPECT_EQ(progress_text("reading scans", 10, 64, seconds(5)), "reading scans: 10 of 64, 2.0/s, 27 s left");
  EXPECT_EQ(progress_text("reading scans", 300, 1000, seconds(3)), "reading scans: 300 of 1000, 100/s, 7 s left");
}

TEST(Progress, LongTimesAreInMinutesAndHours) {
  EXPECT_EQ(progress_text("scans", 1, 126, seconds(1)), "scans: 1 of 126, 1.0/s, 2 min 05 s left");
  EXPECT_EQ(progress_text("scans", 1, 3661, seconds(1)), "scans: 1 of 3661, 1.0/s, 1 h 01 min left");
}

TEST(Progress, WithoutAStepThereIsNoRate) {
  EXPECT_EQ(progress_text("scans", 0, 64, seconds(5)), "scans: 0 of 64");
  EXPECT_EQ(progress_text("scans", 3, 64, seconds(0)), "scans: 3 of 64");
}

TEST(Progress, AtTheEndNothingIsLeft) {
  EXPECT_EQ(progress_text("scans", 64, 64, seconds(64)), "scans: 64 of 64, 1.0/s");
}

TEST(Progress, IsSilentWithoutATerminal) {
  testing::internal::CaptureStderr();
  {
    Progress progress("scans", 2, {});
    progress.advance(2);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace vdbmap::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "tests/support/run_command.h"

namespace vdbmap::parking {
namespace {

TEST(TrainingCrops, HoldWhatTheirScansSaw) {
  const test::CommandResult result =
      test::run_command("/usr/bin/python3", {VDBMAP_SOURCE_DIR "/tests/exchange/crops_test.py"});
  if (result.exit_code == 77) GTEST_SKIP() << "needs PyTorch (python3-torch)";
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

}  // namespace
}  // namespace vdbmap::parking

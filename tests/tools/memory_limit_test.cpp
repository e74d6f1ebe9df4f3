// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/sanitizers.h"
#include "tests/tools/map_command.h"

// Sanitizers take more addresses than any limit leaves.
#ifndef VDBMAP_IS_SANITIZED

namespace vdbmap::cli {
namespace {

class MemoryLimit : public MapCommand {
 protected:
  // Scattered as from the air: the grids of the file take far more memory than the points.
  PointCloud airborne() const {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> height(0, 80);
    PointCloud cloud;
    for (int x = 0; x < 200; ++x) {
      for (int y = 0; y < 200; ++y) cloud.positions.emplace_back(4.0 * x, 4.0 * y, height(random));
    }
    return cloud;
  }

  test::CommandResult build_within(int mebibytes, const std::string& cloud) const {
    const std::string script = "ulimit -v " + std::to_string(1024 * mebibytes) + "; exec \"$0\" \"$@\"";
    return test::run_command("/bin/bash", {"-c", script, VDBMAP_COMMAND, "build", cloud, "-o", path("map.vdb")});
  }

  std::size_t num_files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_.path()), {}));
  }
};

// Wherever memory runs out: where it can be thrown, in threads, and in destructors while an exception is on its way.
TEST_F(MemoryLimit, EndsWithOneLineAndExitCode4AndLeavesNothing) {
  const std::string cloud = ply("airborne.ply", airborne());
  int num_refused = 0;
  // With less, what the program is linked to leaves no room for a thread.
  for (int mebibytes = 220; mebibytes <= 460; mebibytes += 20) {
    const test::CommandResult result = build_within(mebibytes, cloud);
    if (result.exit_code == 0) break;
    ++num_refused;
    SCOPED_TRACE(std::to_string(mebibytes) + " MiB");
    expect_error(result, ExitCode::kInputOutputFailed, "vdbmap: ");
    EXPECT_EQ(num_files(), 1U);
  }
  EXPECT_GE(num_refused, 3);
}

}  // namespace
}  // namespace vdbmap::cli

#endif

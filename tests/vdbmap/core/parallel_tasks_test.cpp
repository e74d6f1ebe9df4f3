// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/parallel_tasks.h"

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/threads.h"

namespace vdbmap {
namespace {

// Of 64 bodies each third throws; the loops in the others must be done all the same.
TEST(ParallelTasks, ABodyThatThrowsLeavesTheLoopsOfOthersWhole) {
  constexpr std::size_t kTasks = 64;
  constexpr std::size_t kSteps = 2000;
  test::on_threads(4, [&] {
    std::vector<std::atomic<std::size_t>> done(kTasks);
    std::string error;
    try {
      parallel_tasks(kTasks, [&](std::size_t task) {
        if (task % 3 == 2) throw std::runtime_error(std::to_string(task));
        parallel_for(kSteps, [&](std::size_t) { ++done[task]; });
      });
    } catch (const std::runtime_error& first) {
      error = first.what();
    }
    EXPECT_EQ(error, "2");
    for (std::size_t task = 0; task < kTasks; ++task) EXPECT_EQ(done[task], task % 3 == 2 ? 0 : kSteps) << task;
    return 0;
  });
}

}  // namespace
}  // namespace vdbmap

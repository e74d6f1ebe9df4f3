// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/child_process.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "tests/support/run_command.h"
#include "tests/support/sanitizers.h"

namespace vdbmap::cli {
namespace {

TEST(ChildProcess, ReturnsTheExitCodeOfTheBody) {
  for (const ExitCode code : {ExitCode::kDone, ExitCode::kNo, ExitCode::kInputOutputFailed}) {
    EXPECT_EQ(run_in_child("a.vdb", [&] { return code; }, {}), code);
  }
}

TEST(ChildProcess, ASignalIsAnErrorOfTheFile) {
  const auto crash = [] {
    std::signal(SIGSEGV, SIG_DFL);
    std::raise(SIGSEGV);
    return ExitCode::kDone;
  };
  EXPECT_EQ(test::io_error_of([&] { run_in_child("a.vdb", crash, {}); }),
            "a.vdb: OpenVDB cannot read it: it ended the reader by signal 11 (Segmentation fault)");
}

TEST(ChildProcess, TimeIsLimited) {
  const auto run_on = [] {
    while (std::clock() != std::clock_t(-1)) {
    }
    return ExitCode::kDone;
  };
  EXPECT_EQ(test::io_error_of([&] { run_in_child("a.vdb", run_on, {.processor_seconds = 1}); }),
            "a.vdb: OpenVDB cannot read it: it took more than 1 s to be read");
}

TEST(ChildProcess, MemoryIsLimited) {
  if (test::kIsSanitized) return;  // the sanitizer takes all addresses
  const auto take_memory = [] {
    std::vector<std::unique_ptr<char[]>> taken;  // addresses: what is not touched takes no memory
    while (true) taken.push_back(std::make_unique_for_overwrite<char[]>(std::size_t{1} << 24));
    return ExitCode::kDone;
  };
  EXPECT_EQ(test::io_error_of([&] { run_in_child("a.vdb", take_memory, {.memory_bytes = std::uint64_t{4} << 30}); }),
            "a.vdb: OpenVDB cannot read it: it needs more than 4096 MB of memory");
}

TEST(ChildProcess, LargerFilesMayTakeMore) {
  const test::TemporaryFolder folder;
  const auto file = test::write_raw(folder.path() / "a.vdb", std::string(20'000'000, ' '));
  EXPECT_EQ(ChildLimits::for_file(file).processor_seconds, 62U);
  EXPECT_EQ(ChildLimits::for_file(file).memory_bytes, (std::uint64_t{8} << 30) + 640'000'000U);
}

// A small file as other programs write them: a sphere of fog and some numbers.
std::string foreign_file(const std::filesystem::path& path) {
  openvdb::initialize();
  const auto density = openvdb::FloatGrid::create(0);
  density->setName("density");
  const auto ids = openvdb::Int32Grid::create(-1);
  ids->setName("ids");
  for (int i = 0; i < 60; ++i) {
    density->tree().setValue({i % 7, i % 11, i * 5}, 0.1F * static_cast<float>(i));
    ids->tree().setValue({i * 3, -i, i % 5}, i);
  }
  openvdb::io::File(path.string()).write({density, ids});
  return test::read_raw(path);
}

TEST(ForeignVdb, WhateverIsDamagedTheAnswerIsOneLineAndAnExitCode) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "foreign.vdb";
  const std::string whole = foreign_file(path);
  int num_refused = 0;
  for (std::size_t i = 17; i < whole.size(); i += whole.size() / 24) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(~damaged[i]);
    test::write_raw(path, damaged);
    for (const char* command : {"info", "check"}) {
      const auto run = test::run_command(VDBMAP_COMMAND, {command, path.string()});
      EXPECT_TRUE(run.exit_code == 0 || run.exit_code == 1 || run.exit_code == 3)
          << command << " " << i << " " << run.err;
      if (run.exit_code != 3) continue;
      ++num_refused;
      EXPECT_NE(run.err.find("foreign.vdb"), std::string::npos) << i;
      EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    }
  }
  EXPECT_GT(num_refused, 5);
}

}  // namespace
}  // namespace vdbmap::cli

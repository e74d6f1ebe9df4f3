// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/child_process.h"

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "tests/support/run_command.h"
#include "tests/support/sanitizers.h"
#include "vdbmap/core/error.h"

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

// OpenVDB warns on one of these and asserts on the other.
TEST(ChildProcess, OnlyOurLogGoesToStderr) {
  testing::internal::CaptureStderr();
  const auto print = [] {
    std::cerr << "WARNING: of a library" << std::endl;
    std::fputs("an assertion\n", stderr);
    throw IoError::malformed("a.vdb", "is damaged");
    return ExitCode::kDone;
  };
  EXPECT_EQ(run_in_child("a.vdb", print, {}), ExitCode::kBadInput);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "vdbmap: a.vdb: is damaged\n");
}

// A small file as other programs write them: a sphere of fog and some numbers.
std::string foreign_vdb(const std::filesystem::path& path) {
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

// A file of one full leaf, compressed by zlib.
struct ZippedFile {
  std::string bytes;
  std::size_t size_of_leaf;  // where it stands, of 8 bytes
};

ZippedFile zipped_file(const std::filesystem::path& path) {
  openvdb::initialize();
  const auto density = openvdb::FloatGrid::create(0);
  density->setName("density");
  for (int i = 0; i < 512; ++i) density->tree().setValue({i / 64, i / 8 % 8, i % 8}, 0.1F * static_cast<float>(i % 5));
  openvdb::io::File file(path.string());
  file.setCompression(openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK);
  file.write({density});
  file.close();
  const std::string bytes = test::read_raw(path);
  return {bytes, bytes.rfind("\x78\x9c") - 8};  // before zlib's first bytes
}

class ForeignVdb : public testing::Test {
 protected:
  // The exit code of a command for a file of these bytes; where it is 3, there is one line that names the file.
  int exit_code(const char* command, const std::string& bytes) const {
    test::write_raw(path_, bytes);
    const auto run = test::run_command(VDBMAP_COMMAND, {command, path_.string()});
    if (run.exit_code == 3) {
      EXPECT_NE(run.err.find("foreign.vdb"), std::string::npos) << run.err;
      EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    }
    return run.exit_code;
  }

  // Whether `info` and `check` both refuse it.
  void expect_refusal(const std::string& bytes) const {
    for (const char* command : {"info", "check"}) EXPECT_EQ(exit_code(command, bytes), 3) << command;
  }

  test::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "foreign.vdb";
};

TEST_F(ForeignVdb, WhateverIsDamagedTheAnswerIsOneLineAndAnExitCode) {
  const std::string whole = foreign_vdb(path_);
  int num_refused = 0;
  for (std::size_t i = 17; i < whole.size(); i += whole.size() / 24) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(~damaged[i]);
    for (const char* command : {"info", "check"}) {
      const int code = exit_code(command, damaged);
      EXPECT_TRUE(code == 0 || code == 1 || code == 3) << command << " " << i << " " << code;
      num_refused += code == 3 ? 1 : 0;
    }
  }
  EXPECT_GT(num_refused, 5);
}

// What follows was found by tests/fuzz. The size of a block that was not worth compressing is stored as a negative
// number: OpenVDB reads so many bytes over the memory of the block, and looks at the size that it must have only then.
TEST_F(ForeignVdb, ABlockLargerThanItsMemoryIsRefused) {
  if (test::kIsSanitized) return;  // the sanitizer ends the child, in its own words
  const ZippedFile zipped = zipped_file(path_);
  ASSERT_LT(zipped.size_of_leaf, zipped.bytes.size());
  for (const std::int64_t size : {5'000, 5'000'000}) {
    std::string damaged = zipped.bytes;
    damaged.replace(zipped.size_of_leaf, sizeof(size), test::raw(-size));
    expect_refusal(damaged + std::string(static_cast<std::size_t>(size), '\x7f'));
  }
}

// OpenVDB takes as much memory as the block is said to have bytes, before it sees that the file ends.
TEST_F(ForeignVdb, ABlockLargerThanAllMemoryIsRefused) {
  if (test::kIsSanitized) return;
  ZippedFile zipped = zipped_file(path_);
  ASSERT_LT(zipped.size_of_leaf, zipped.bytes.size());
  expect_refusal(zipped.bytes.replace(zipped.size_of_leaf, 8, test::raw(std::int64_t{1} << 40)));
}

// OpenVDB warns of trees as those of its first versions, which had several buffers.
TEST_F(ForeignVdb, AWarningOfOpenVdbIsNoSecondLine) {
  std::string damaged = foreign_vdb(path_);
  const std::size_t num_buffers =
      damaged.find(test::raw(1, 0.0F, 0U));  // before the background and the number of tiles
  ASSERT_NE(num_buffers, std::string::npos);
  damaged[num_buffers] = 2;
  test::write_raw(path_, damaged);
  const auto run = test::run_command(VDBMAP_COMMAND, {"info", path_.string()});
  EXPECT_LE(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_EQ(run.err.find("WARNING"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace vdbmap::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/atomic_file.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "vdbmap/core/error.h"

namespace vdbmap {
namespace {

namespace fs = std::filesystem;

std::size_t num_files(const test::TemporaryFolder& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()));
}

TEST(AtomicFile, AppearsWholeAtCommit) {
  const test::TemporaryFolder folder;
  const std::string megabytes(3'000'000, 'x');
  AtomicFile file(folder / "map.txt");
  file.write("begin ");
  file.write(megabytes);
  EXPECT_FALSE(fs::exists(folder / "map.txt"));

  file.commit();
  EXPECT_EQ(test::read_raw(folder / "map.txt"), "begin " + megabytes);
  EXPECT_EQ(num_files(folder), 1u);
}

TEST(AtomicFile, LeavesTheOldFileWithoutCommit) {
  const test::TemporaryFolder folder;
  write_file(folder / "map.txt", "old");
  {
    AtomicFile file(folder / "map.txt");
    file.write("new");
  }
  EXPECT_EQ(test::read_raw(folder / "map.txt"), "old");
  EXPECT_EQ(num_files(folder), 1u);
}

TEST(AtomicFile, ReplacesTheOldFileAtCommit) {
  const test::TemporaryFolder folder;
  write_file(folder / "map.txt", "old and longer");
  write_file(folder / "map.txt", "new");
  EXPECT_EQ(test::read_raw(folder / "map.txt"), "new");
}

TEST(AtomicFile, FollowsTheUmask) {
  const test::TemporaryFolder folder;
  const mode_t before = ::umask(027);
  write_file(folder / "map.txt", "");
  ::umask(before);
  EXPECT_EQ(fs::status(folder / "map.txt").permissions(), fs::perms(0640));
}

TEST(AtomicFile, CanBeWrittenByOthersThroughItsTemporaryPath) {
  const test::TemporaryFolder folder;
  AtomicFile file(folder / "map.txt");
  test::write_raw(file.temporary_path(), "by a library that wants a path");
  file.commit();
  EXPECT_EQ(test::read_raw(folder / "map.txt"), "by a library that wants a path");
}

TEST(AtomicFile, RefusesPlacesThatCannotBeWritten) {
  const test::TemporaryFolder folder;
  const auto error = [&](const fs::path& target) { return test::io_error_of([&] { check_writable(target); }); };
  EXPECT_EQ(error(folder / "missing" / "map.txt"), "map.txt: cannot create: No such file or directory");
  EXPECT_NE(error(folder.path()).find("cannot create: Is a directory"), std::string::npos);
  EXPECT_EQ(error(folder / "map.txt"), "no error");
  EXPECT_EQ(num_files(folder), 0u) << "the probe leaves nothing behind";
}

TEST(AtomicFile, IsRemovedWhenTheProgramIsInterrupted) {
  const test::TemporaryFolder folder;
  write_file(folder / "finished.txt", "stays");
  AtomicFile first(folder / "first.txt");
  AtomicFile second(folder / "second.txt");
  EXPECT_EQ(num_files(folder), 3u);

  remove_unfinished_files();
  EXPECT_EQ(num_files(folder), 1u);
  EXPECT_EQ(test::read_raw(folder / "finished.txt"), "stays");
}

}  // namespace
}  // namespace vdbmap

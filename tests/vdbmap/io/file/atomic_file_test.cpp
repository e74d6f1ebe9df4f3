// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/file/atomic_file.h"

#include <algorithm>
#include <future>

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

TEST(AtomicFile, LeavesTheUmaskAloneInAllThreads) {
  const test::TemporaryFolder folder;
  const mode_t before = ::umask(027);
  const auto write_many = [&](char name) {
    for (int i = 0; i < 300; ++i) {
      const fs::path path = folder / (name + std::to_string(i));
      write_file(path, "");
      if (fs::status(path).permissions() != fs::perms(0640)) return false;
    }
    return true;
  };
  std::future<bool> other = std::async(std::launch::async, write_many, 'a');
  EXPECT_TRUE(write_many('b'));
  EXPECT_TRUE(other.get());
  EXPECT_EQ(::umask(before), 027u);
}

TEST(AtomicFile, ReplacesWhatALinkPointsTo) {
  const test::TemporaryFolder folder;
  fs::create_directory(folder / "disk");
  write_file(folder / "disk" / "map.txt", "old");
  fs::create_symlink("disk/map.txt", folder / "link.txt");
  {
    AtomicFile file(folder / "link.txt");
    EXPECT_EQ(file.temporary_path().parent_path(), folder / "disk") << "a rename stays within one disk";
    file.write("new");
    file.commit();
  }
  EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
  EXPECT_EQ(test::read_raw(folder / "disk" / "map.txt"), "new");

  fs::create_symlink("disk/first.txt", folder / "dangling.txt");
  write_file(folder / "dangling.txt", "first");
  EXPECT_TRUE(fs::is_symlink(folder / "dangling.txt"));
  EXPECT_EQ(test::read_raw(folder / "disk" / "first.txt"), "first");
  EXPECT_EQ(num_files(folder), 3u);
}

TEST(AtomicFile, HasNamesUpToTheLimitOfTheFileSystem) {
  const test::TemporaryFolder folder;
  for (const std::size_t size : {240u, 248u, 254u, 255u}) {
    write_file(folder / std::string(size, 'x'), "whole");
    EXPECT_EQ(test::read_raw(folder / std::string(size, 'x')), "whole") << size;
  }
  EXPECT_NE(test::io_error_of([&] { check_writable(folder / std::string(256, 'x')); }).find("File name too long"),
            std::string::npos);
}

TEST(AtomicFile, NeverTakesThePlaceOfAPipeOrADevice) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  fs::create_symlink("pipe", folder / "link");
  for (const fs::path& path : {folder / "pipe", folder / "link", fs::path("/dev/full"), fs::path("/dev/stdout")}) {
    EXPECT_NE(test::io_error_of([&] { check_writable(path); }).find("cannot replace what is no regular file"),
              std::string::npos)
        << path;
  }
  EXPECT_EQ(num_files(folder), 2u);
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

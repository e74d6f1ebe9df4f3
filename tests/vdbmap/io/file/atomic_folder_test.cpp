// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/file/atomic_folder.h"

#include <iterator>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/file/atomic_file.h"

namespace vdbmap {
namespace {

using std::filesystem::exists;
using std::filesystem::path;

std::size_t num_entries(const path& folder) {
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
}

void fill(const AtomicFolder& folder, const std::string& name) {
  std::filesystem::create_directories(folder.temporary_path() / "a" / "b");
  write_file(folder.temporary_path() / "a" / "b" / name, "text");
}

TEST(AtomicFolder, AppearsWholeAtCommitAndNotBefore) {
  const test::TemporaryFolder parent;
  AtomicFolder folder(parent / "out");
  fill(folder, "file");
  EXPECT_FALSE(exists(parent / "out"));
  folder.commit();
  EXPECT_EQ(test::read_raw(parent / "out" / "a" / "b" / "file"), "text");
  EXPECT_EQ(num_entries(parent.path()), 1U);
}

TEST(AtomicFolder, ReplacesWhatWasThere) {
  const test::TemporaryFolder parent;
  for (const char* name : {"old", "new"}) {
    AtomicFolder folder(parent / "out/");
    fill(folder, name);
    folder.commit();
  }
  EXPECT_TRUE(exists(parent / "out" / "a" / "b" / "new"));
  EXPECT_FALSE(exists(parent / "out" / "a" / "b" / "old"));
  EXPECT_EQ(num_entries(parent.path()), 1U);
}

TEST(AtomicFolder, LeavesNothingWithoutCommit) {
  const test::TemporaryFolder parent;
  { fill(AtomicFolder(parent / "out"), "file"); }
  EXPECT_EQ(num_entries(parent.path()), 0U);
}

TEST(AtomicFolder, SignalHandlersRemoveWhatIsUnfinished) {
  const test::TemporaryFolder parent;
  const AtomicFolder folder(parent / "out");
  for (int i = 0; i < 300; ++i) fill(folder, std::to_string(i));
  remove_unfinished_folders();
  EXPECT_EQ(num_entries(parent.path()), 0U);
}

TEST(AtomicFolder, FollowsTheUmaskAndLeavesItAlone) {
  const test::TemporaryFolder folder;
  const mode_t before = ::umask(027);
  AtomicFolder street(folder / "street");
  street.commit();
  EXPECT_EQ(::umask(before), 027u);
  EXPECT_EQ(std::filesystem::status(folder / "street").permissions(), std::filesystem::perms(0750));
}

TEST(AtomicFolder, ReplacesWhatALinkPointsToAndMayHaveALongName) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory_symlink("street", folder / "link");
  AtomicFolder dangling(folder / "link");
  dangling.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_TRUE(std::filesystem::is_directory(folder / "street"));

  AtomicFolder long_name(folder / std::string(255, 'x'));
  long_name.commit();
  EXPECT_TRUE(std::filesystem::is_directory(folder / std::string(255, 'x')));
}

TEST(AtomicFolder, DoesNotFollowLinksWhenItRemoves) {
  const test::TemporaryFolder parent;
  std::filesystem::create_directory(parent / "precious");
  write_file(parent / "precious" / "file", "text");
  {
    const AtomicFolder folder(parent / "out");
    std::filesystem::create_directory_symlink(parent / "precious", folder.temporary_path() / "link");
  }
  EXPECT_TRUE(exists(parent / "precious" / "file"));
}

TEST(AtomicFolder, RefusesTargetsThatAreFilesOrInMissingFolders) {
  const test::TemporaryFolder parent;
  write_file(parent / "file", "text");
  EXPECT_THROW(AtomicFolder(parent / "file"), IoError);
  EXPECT_THROW(AtomicFolder(parent / "missing" / "out"), IoError);
}

}  // namespace
}  // namespace vdbmap

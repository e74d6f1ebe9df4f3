// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/file/output_path.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "vdbmap/core/error.h"

namespace vdbmap {
namespace {

namespace fs = std::filesystem;

class OutputPath : public testing::Test {
 protected:
  // A link in the folder; returns its path.
  fs::path link(const std::string& name, const fs::path& to) const {
    fs::create_symlink(to, folder_ / name);
    return folder_ / name;
  }
  std::string followed(const fs::path& path) const { return fs::relative(follow_links(path), folder_.path()).string(); }

  test::TemporaryFolder folder_;
};

TEST_F(OutputPath, WithoutALinkIsItself) {
  EXPECT_EQ(follow_links("map.vdb"), "map.vdb");
  EXPECT_EQ(follow_links(folder_ / "missing" / "map.vdb"), folder_ / "missing" / "map.vdb");
}

TEST_F(OutputPath, OfALinkIsWhatItPointsToWhetherThatExistsOrNot) {
  fs::create_directory(folder_ / "disk");
  test::write_raw(folder_ / "disk" / "map.vdb", "old");
  EXPECT_EQ(followed(link("relative.vdb", "disk/map.vdb")), "disk/map.vdb");
  EXPECT_EQ(followed(link("absolute.vdb", folder_ / "disk" / "map.vdb")), "disk/map.vdb");
  EXPECT_EQ(followed(link("dangling.vdb", "disk/new.vdb")), "disk/new.vdb");
  EXPECT_EQ(followed(link("chain.vdb", "dangling.vdb")), "disk/new.vdb");
  fs::create_symlink("../relative.vdb", folder_ / "disk" / "back.vdb");
  EXPECT_EQ(fs::weakly_canonical(follow_links(folder_ / "disk" / "back.vdb")),
            fs::canonical(folder_ / "disk" / "map.vdb"));
}

TEST_F(OutputPath, OfLinksInACircleIsAnError) {
  link("a.vdb", "b.vdb");
  link("b.vdb", "a.vdb");
  EXPECT_EQ(test::io_error_of([&] { follow_links(folder_ / "a.vdb"); }),
            "a.vdb: cannot create: Too many levels of symbolic links");
}

TEST_F(OutputPath, OfOpenFilesIsAnError) {
  for (const fs::path& path : {fs::path("/dev/stdout"), fs::path("/proc/self/fd/1"), link("out.vdb", "/dev/stdout")}) {
    EXPECT_THROW(follow_links(path), IoError) << path;
  }
}

TEST_F(OutputPath, TemporaryNamesAreBesideTheTargetAndFitWhereItFits) {
  const fs::path usual = temporary_name_beside(folder_ / "map.vdb");
  EXPECT_EQ(usual.parent_path(), folder_.path());
  EXPECT_TRUE(usual.filename().string().starts_with("map.vdb.")) << usual;
  EXPECT_EQ(temporary_name_beside("map.vdb").parent_path(), "");
  for (std::size_t size = 240; size <= 255; ++size) {
    const fs::path name = temporary_name_beside(folder_ / std::string(size, 'x')).filename();
    EXPECT_LE(name.native().size(), 255u) << size;
  }
  // Each character takes 3 bytes; none is cut.
  std::string japanese;
  while (japanese.size() + 3 <= 255) japanese += "大";
  const std::string cut = temporary_name_beside(folder_ / japanese).filename().string();
  EXPECT_EQ(cut.rfind("大") % 3, 0u);
  EXPECT_EQ(cut[cut.rfind("大") + 3], '.') << cut;
}

TEST_F(OutputPath, TemporaryNamesDiffer) {
  std::set<fs::path> names;
  for (int i = 0; i < 1000; ++i) names.insert(temporary_name_beside("map.vdb"));
  EXPECT_EQ(names.size(), 1000u);
}

}  // namespace
}  // namespace vdbmap

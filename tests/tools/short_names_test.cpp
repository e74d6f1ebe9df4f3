// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/short_names.h"

#include <gtest/gtest.h>

namespace vdbmap::cli {
namespace {

using Names = std::vector<std::string>;

TEST(ShortNames, AFileIsCalledByItsName) {
  EXPECT_EQ(short_names({"/data/a/poses.txt", "truth.txt"}), (Names{"poses.txt", "truth.txt"}));
  EXPECT_TRUE(short_names({}).empty());
}

TEST(ShortNames, FoldersTellFilesOfOneNameApart) {
  EXPECT_EQ(short_names({"demo/found/poses.txt", "street/epoch1/poses.txt", "street/epoch1/scan.pcd"}),
            (Names{"found/poses.txt", "epoch1/poses.txt", "scan.pcd"}));
  EXPECT_EQ(short_names({"a/x/poses.txt", "b/x/poses.txt"}), (Names{"a/x/poses.txt", "b/x/poses.txt"}));
  EXPECT_EQ(short_names({"poses.txt", "b/poses.txt"}), (Names{"poses.txt", "b/poses.txt"}));
}

TEST(ShortNames, OneFileTwiceHasOneName) {
  EXPECT_EQ(short_names({"a/poses.txt", "a/poses.txt"}), (Names{"poses.txt", "poses.txt"}));
}

}  // namespace
}  // namespace vdbmap::cli

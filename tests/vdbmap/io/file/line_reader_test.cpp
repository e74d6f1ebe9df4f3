// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/file/line_reader.h"

#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "vdbmap/core/error.h"

namespace vdbmap {
namespace {

std::vector<std::string> lines_of(const std::string& bytes) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "lines.txt", std::ios::binary) << bytes;
  LineReader reader(folder.path() / "lines.txt");
  std::vector<std::string> lines;
  while (const auto line = reader.next()) lines.emplace_back(*line);
  return lines;
}

std::string refusal_of(const std::filesystem::path& path) {
  try {
    LineReader reader(path);
    while (reader.next()) {
    }
  } catch (const IoError& error) {
    return error.what();
  }
  return "";
}

using Lines = std::vector<std::string>;

TEST(LineReader, EndsLinesAsEverySystemDoes) {
  EXPECT_EQ(lines_of("a\nb\n"), (Lines{"a", "b"}));
  EXPECT_EQ(lines_of("a\r\nb\r\n"), (Lines{"a", "b"}));
  EXPECT_EQ(lines_of("a\rb\r"), (Lines{"a", "b"}));
  EXPECT_EQ(lines_of("a\nlast"), (Lines{"a", "last"}));
  EXPECT_EQ(lines_of("\n\r\n\r\r\n"), (Lines{"", "", "", ""}));
  EXPECT_EQ(lines_of(""), Lines{});
}

TEST(LineReader, PassesOverAByteOrderMark) {
  EXPECT_EQ(lines_of("\xEF\xBB\xBF"
                     "a\n"),
            (Lines{"a"}));
}

TEST(LineReader, LinesLongerThanItsBufferAreWhole) {
  const std::string longest(LineReader::kLongestLine, 'x');
  EXPECT_EQ(lines_of(longest + "\r\n" + longest), (Lines{longest, longest}));
}

TEST(LineReader, WhatNeverEndsIsRefused) {
  EXPECT_EQ(refusal_of("/dev/zero"), "/dev/zero:1: is longer than 1 MB: this is no text");
}

TEST(LineReader, FoldersMissingFilesAndOtherEncodingsAreRefused) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "wide.txt", std::ios::binary) << "\xFF\xFE"
                                                              << "a";
  EXPECT_NE(refusal_of(folder.path()).find("cannot read: Is a directory"), std::string::npos);
  EXPECT_NE(refusal_of(folder.path() / "none.txt").find("cannot open: No such file"), std::string::npos);
  EXPECT_NE(refusal_of(folder.path() / "wide.txt").find("UTF-16"), std::string::npos);
}

}  // namespace
}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/text.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace vdbmap {
namespace {

TEST(Text, SplitsAtWhiteSpace) {
  EXPECT_EQ(split_words("  a\tbc  d\r"), (std::vector<std::string_view>{"a", "bc", "d"}));
  EXPECT_TRUE(split_words(" \t\r").empty());
}

TEST(Text, ParsesWholeWordsOnly) {
  EXPECT_EQ(parse_number("-1.5e3"), -1500.0);
  EXPECT_EQ(parse_number("+.5"), 0.5);
  EXPECT_EQ(parse_number("1."), 1.0);
  EXPECT_EQ(parse_number("0.1"), 0.1);
  for (const std::string_view word : {"", "+", "-", "+-1", "1,5", "1x", "0x10", "1e", " 1", "."}) {
    EXPECT_FALSE(parse_number(word)) << word;
  }
}

TEST(Text, ParsesWhatIsNotFiniteOrTooLargeOrTooSmall) {
  EXPECT_TRUE(std::isnan(parse_number("nan").value()));
  EXPECT_EQ(parse_number("-inf"), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(parse_number("1e999"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(parse_number("-1e-999"), 0.0);
}

TEST(Text, ParsesCountsUpTo64Bits) {
  EXPECT_EQ(parse_count("18446744073709551615"), std::numeric_limits<std::uint64_t>::max());
  for (const std::string_view word : {"18446744073709551616", "-1", "+1", "1.0", "", "1 "}) {
    EXPECT_FALSE(parse_count(word)) << word;
  }
}

TEST(Text, QuotesOneShortPrintableLine) {
  EXPECT_EQ(quoted("x"), "'x'");
  EXPECT_EQ(quoted("a\nb\x1b-\xff"), "'a?b?-?'");
  EXPECT_EQ(quoted(std::string_view("0123456789012345678901234567890123456789_")),
            "'0123456789012345678901234567890123456789...'");
}

}  // namespace
}  // namespace vdbmap

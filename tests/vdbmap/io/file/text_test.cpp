// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/file/text.h"

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

TEST(Text, ParsesWhatMicrosoftPrintedForNumbersThatAreNone) {
  for (const std::string_view word : {"1.#QNAN", "-1.#IND", "-1.#IND00", "1.#SNAN", "nan(ind)", "-nan"}) {
    EXPECT_TRUE(std::isnan(parse_number(word).value_or(0))) << word;
  }
  EXPECT_EQ(parse_number("1.#INF"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(parse_number("-1.#INF00"), -std::numeric_limits<double>::infinity());
  EXPECT_FALSE(parse_number("1.#")) << "and nothing else";
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

TEST(Text, IsPrintableWithoutControlCharacters) {
  EXPECT_EQ(printable("Straße 7, 大阪, \U0001F6B2 ~"), "Straße 7, 大阪, \U0001F6B2 ~");
  EXPECT_EQ(printable("x\x1b[31mred\r\n\t\x7f"), "x?[31mred????");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a?b");
  EXPECT_EQ(printable("C1 \u009b31m \u0085"), "C1 ?31m ?");
  EXPECT_EQ(printable("\u2028 \u202e \u2066 \u200f"), "? ? ? ?") << "ends of lines, turns of direction";
  // RFC 3629: stray and missing continuations, overlong forms, halves of pairs, beyond the last code, no lead at all.
  EXPECT_EQ(printable("\xff|\x9b|\xc3|\xe4\xbd|\xc0\xaf|\xed\xa0\x80|\xf4\x90\x80\x80|\xf8\x88\x80\x80\x80"),
            "?|?|?|??|??|???|????|?????");
}

TEST(Text, LinesStayLinesWherePrintable) { EXPECT_EQ(printable_lines("a\x1b\nb\r\n"), "a?\nb?\n"); }

TEST(Text, JsonKeepsControlCharactersEscaped) {
  EXPECT_EQ(with_escaped_controls("{\n  \"a\": \"\x7f\u009b\u202e ü\"\n}"),
            "{\n  \"a\": \"\\u007f\\u009b\\u202e ü\"\n}");
}

}  // namespace
}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "vdbmap/io/file/byte_reader.h"

namespace vdbmap {

/// The words of a line between white space.
std::vector<std::string_view> split_words(std::string_view line);

/// Cuts the next word off the front of `rest`; empty where only white space is left.
std::string_view next_word(std::string_view& rest);

/// The next line that is not blank.
std::string_view read_filled_line(ByteReader& reader);

/// The words of the next line of a header. Throws IoError for a line above 64 KiB, which binary data may look like.
std::vector<std::string_view> read_header_words(ByteReader& reader);

/// A text without the byte-order mark of UTF-8, which some programs write before it.
std::string_view without_byte_order_mark(std::string_view text);

/// A text in small letters.
std::string lower_case(std::string_view text);

/// A whole word as a number: "-1.5", "+2e3", "nan", "inf"; Microsoft's "1.#QNAN", "-1.#IND" and "1.#INF" too.
/// Independent of the locale.
std::optional<double> parse_number(std::string_view word);

/// Cuts a number off the front of `rest`, which begins with it, where `is_end(next character)` or nothing follows.
/// Nothing, and `rest` as it was, in all other cases, also for spellings that only parse_number() knows.
template <typename IsEnd>
std::optional<double> cut_plain_number(std::string_view& rest, IsEnd&& is_end) {
  double value = 0;
  const char* const end = rest.data() + rest.size();
  const std::from_chars_result result = std::from_chars(rest.data(), end, value);
  if (result.ec != std::errc() || (result.ptr != end && !is_end(*result.ptr))) return std::nullopt;
  rest.remove_prefix(static_cast<std::size_t>(result.ptr - rest.data()));
  return value;
}

/// White space.
inline bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

/// A whole word as a number of things: digits only, below 2^64.
std::optional<std::uint64_t> parse_count(std::string_view word);

/// Text of foreign origin (names of files, content of files) made fit for a terminal: each control character (C0, DEL,
/// C1, line and paragraph separators, those that turn the direction of writing) and each byte that is no UTF-8 becomes
/// '?'.
std::string printable(std::string_view text);

/// The same for a text of several lines, which stay lines.
std::string printable_lines(std::string_view text);

/// A JSON text whose strings may hold control characters that JSON allows in them (DEL, C1, ...): those are escaped.
std::string with_escaped_controls(std::string_view json);

/// Part of a foreign file, made fit for one line of an error message: in quotes, short, printable.
/// Call it vdbmap::quoted() on a std::string, which would else find std::quoted() too.
std::string quoted(std::string_view text);

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/text.h"

#include <algorithm>
#include <charconv>
#include <system_error>

namespace vdbmap {
namespace {

constexpr std::size_t kLongestHeaderLine = 1 << 16;  // [bytes]
constexpr std::size_t kLongestQuote = 40;            // [characters]

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

template <typename T>
std::from_chars_result parse_whole(std::string_view word, T& value) {
  std::from_chars_result result = std::from_chars(word.data(), word.data() + word.size(), value);
  if (result.ec == std::errc() && result.ptr != word.data() + word.size()) result.ec = std::errc::invalid_argument;
  return result;
}

}  // namespace

std::string_view next_word(std::string_view& rest) {
  const auto begin = std::find_if_not(rest.begin(), rest.end(), is_blank);
  const auto end = std::find_if(begin, rest.end(), is_blank);
  rest = std::string_view(end, rest.end());
  return std::string_view(begin, end);
}

std::vector<std::string_view> split_words(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) words.push_back(word);
  return words;
}

std::string_view read_filled_line(ByteReader& reader) {
  std::string_view line = reader.read_line();
  for (std::string_view rest = line; next_word(rest).empty(); rest = line) line = reader.read_line();
  return line;
}

std::vector<std::string_view> read_header_words(ByteReader& reader) {
  const std::string_view line = reader.read_line();
  if (line.size() > kLongestHeaderLine) reader.fail_line("a header line of " + std::to_string(line.size()) + " bytes");
  return split_words(line);
}

std::optional<double> parse_number(std::string_view word) {
  if (word.starts_with('+')) {
    word.remove_prefix(1);
    if (word.starts_with('-')) return std::nullopt;
  }
  double value = 0;
  const std::from_chars_result result = parse_whole(word, value);
  if (result.ec == std::errc()) return value;
  if (result.ec != std::errc::result_out_of_range) return std::nullopt;

  // 1e999 is infinite and 1e-999 zero in a double; from_chars does not tell which of the two it met.
  long double wide = 0;
  if (parse_whole(word, wide).ec != std::errc()) return std::nullopt;
  return static_cast<double>(wide);
}

std::optional<std::uint64_t> parse_count(std::string_view word) {
  std::uint64_t value = 0;
  if (parse_whole(word, value).ec != std::errc()) return std::nullopt;
  return value;
}

std::string quoted(std::string_view text) {
  std::string result = "'";
  for (const char c : text.substr(0, kLongestQuote)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > kLongestQuote ? "...'" : "'");
}

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/file/text.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <limits>
#include <system_error>

namespace vdbmap {
namespace {

constexpr std::size_t kLongestHeaderLine = 1 << 16;  // [bytes]
constexpr std::size_t kLongestQuote = 40;            // [characters]

template <typename T>
std::from_chars_result parse_whole(std::string_view word, T& value) {
  std::from_chars_result result = std::from_chars(word.data(), word.data() + word.size(), value);
  if (result.ec == std::errc() && result.ptr != word.data() + word.size()) result.ec = std::errc::invalid_argument;
  return result;
}

// A character at the front of a text.
struct Character {
  std::size_t size;  // [bytes]
  char32_t code;     // where it is valid
  bool is_valid;     // UTF-8 (RFC 3629)
};

// Of more than one byte: none is overlong, a half of a pair or beyond the last code.
Character long_character(std::string_view text, std::size_t size, char32_t lead, char32_t least) {
  if (text.size() < size) return {1, 0, false};
  char32_t code = lead;
  for (std::size_t i = 1; i < size; ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if ((byte & 0xc0) != 0x80) return {1, 0, false};
    code = code << 6 | (byte & 0x3fU);
  }
  const bool is_valid = code >= least && code <= 0x10ffff && (code < 0xd800 || code > 0xdfff);
  return is_valid ? Character{size, code, true} : Character{1, 0, false};
}

Character first_character(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text.front());
  if (lead < 0x80) return {1, lead, true};
  if ((lead & 0xe0) == 0xc0) return long_character(text, 2, lead & 0x1fU, 0x80);
  if ((lead & 0xf0) == 0xe0) return long_character(text, 3, lead & 0x0fU, 0x800);
  if ((lead & 0xf8) == 0xf0) return long_character(text, 4, lead & 0x07U, 0x10000);
  return {1, 0, false};
}

bool is_control(char32_t code) {
  const bool turns_direction = code == 0x061c || code == 0x200e || code == 0x200f ||
                               (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
  return code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0x2028 || code == 0x2029 || turns_direction;
}

// The text with replacement(character) in the place of each control character and each byte that is no UTF-8.
template <typename Replacement>
std::string replace_controls(std::string_view text, const Replacement& replacement) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const Character character = first_character(text);
    if (character.is_valid && !is_control(character.code)) {
      result += text.substr(0, character.size);
    } else {
      result += replacement(character);
    }
    text.remove_prefix(character.size);
  }
  return result;
}

// What Microsoft's C library once printed: "1.#QNAN", "-1.#IND00", "1.#INF".
std::optional<double> parse_microsoft_number(std::string_view word) {
  const bool is_negative = word.starts_with('-');
  if (is_negative) word.remove_prefix(1);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (word.starts_with("1.#INF")) return is_negative ? -kInfinity : kInfinity;
  const bool is_nan = word.starts_with("1.#QNAN") || word.starts_with("1.#SNAN") || word.starts_with("1.#IND");
  return is_nan ? std::optional(std::numeric_limits<double>::quiet_NaN()) : std::nullopt;
}

}  // namespace

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  return text;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

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
  if (result.ec != std::errc::result_out_of_range) return parse_microsoft_number(word);

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

std::string printable(std::string_view text) {
  return replace_controls(text, [](const Character&) { return "?"; });
}

std::string printable_lines(std::string_view text) {
  return replace_controls(text, [](const Character& c) { return c.is_valid && c.code == '\n' ? "\n" : "?"; });
}

std::string with_escaped_controls(std::string_view json) {
  return replace_controls(json, [](const Character& c) -> std::string {
    if (!c.is_valid) return "?";
    if (c.code < 0x20) return std::string(1, static_cast<char>(c.code));  // between the values
    std::string escape = "\\u0000";
    for (std::size_t i = 0; i < 4; ++i) escape[5 - i] = "0123456789abcdef"[c.code >> (4 * i) & 15];
    return escape;
  });
}

std::string quoted(std::string_view text) {
  std::string result = "'";
  for (const char c : text.substr(0, kLongestQuote)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > kLongestQuote ? "...'" : "'");
}

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/pcd/lzf.h"

#include <algorithm>
#include <vector>

namespace vdbmap {
namespace {

constexpr std::size_t kLongestLiteral = 32;
constexpr std::size_t kShortestCopy = 3;
constexpr std::size_t kLongestCopy = 264;  // 9 + 255
constexpr std::size_t kLongestDistance = 1 << 13;
static_assert(kMostLzfExpansion == kLongestCopy / 3);

std::size_t byte_at(std::string_view bytes, std::size_t position) {
  return static_cast<unsigned char>(bytes[position]);
}

// Byte by byte: a copy may reach into itself and so repeat a pattern.
void copy_earlier(std::string& output, std::size_t distance, std::size_t length) {
  for (std::size_t i = 0; i < length; ++i) output.push_back(output[output.size() - distance]);
}

void append_literals(std::string& output, std::string_view literals) {
  while (!literals.empty()) {
    const std::string_view run = literals.substr(0, kLongestLiteral);
    output += static_cast<char>(run.size() - 1);
    output += run;
    literals.remove_prefix(run.size());
  }
}

void append_copy(std::string& output, std::size_t distance, std::size_t length) {
  const std::size_t offset = distance - 1;
  const std::size_t extra = length - 2;
  output += static_cast<char>(std::min<std::size_t>(extra, 7) << 5 | offset >> 8);
  if (extra >= 7) output += static_cast<char>(extra - 7);
  output += static_cast<char>(offset & 0xff);
}

std::size_t hash_of_three(std::string_view data, std::size_t position) {
  const std::size_t three =
      byte_at(data, position) << 16 | byte_at(data, position + 1) << 8 | byte_at(data, position + 2);
  return three * 2654435761u >> 16 & 0xffff;  // Knuth's multiplicative hash
}

std::size_t common_length(std::string_view data, std::size_t a, std::size_t b) {
  const std::size_t limit = std::min(kLongestCopy, data.size() - b);
  std::size_t length = 0;
  while (length < limit && data[a + length] == data[b + length]) ++length;
  return length;
}

}  // namespace

std::optional<std::string> lzf_decompress(std::string_view compressed, std::uint64_t size) {
  if (size / kMostLzfExpansion > compressed.size()) return std::nullopt;
  std::string output;
  output.reserve(size);
  std::size_t at = 0;
  while (at < compressed.size()) {
    const std::size_t control = byte_at(compressed, at++);
    if (control < kLongestLiteral) {
      const std::size_t length = control + 1;
      if (length > compressed.size() - at || length > size - output.size()) return std::nullopt;
      output += compressed.substr(at, length);
      at += length;
      continue;
    }
    const bool is_long = control >> 5 == 7;
    if (compressed.size() - at < (is_long ? 2 : 1)) return std::nullopt;
    const std::size_t length = (control >> 5) + 2 + (is_long ? byte_at(compressed, at++) : 0);
    const std::size_t distance = ((control & 0x1f) << 8 | byte_at(compressed, at++)) + 1;
    if (distance > output.size() || length > size - output.size()) return std::nullopt;
    copy_earlier(output, distance, length);
  }
  if (output.size() != size) return std::nullopt;
  return output;
}

std::string lzf_compress(std::string_view data) {
  std::string output;
  std::vector<std::size_t> last_seen(1 << 16, data.size());
  std::size_t literals_begin = 0;
  std::size_t at = 0;
  while (at + kShortestCopy <= data.size()) {
    std::size_t& seen = last_seen[hash_of_three(data, at)];
    const bool is_near = seen < at && at - seen <= kLongestDistance;
    const std::size_t length = is_near ? common_length(data, seen, at) : 0;
    const std::size_t distance = at - seen;
    seen = at;
    if (length < kShortestCopy) {
      ++at;
      continue;
    }
    append_literals(output, data.substr(literals_begin, at - literals_begin));
    append_copy(output, distance, length);
    at += length;
    literals_begin = at;
  }
  append_literals(output, data.substr(literals_begin));
  return output;
}

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/number_ranges.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <stdexcept>

#include <spdlog/fmt/fmt.h>

#include "vdbmap/io/file/text.h"

namespace vdbmap::cli {
namespace {

constexpr std::size_t kMostNumbers = 10'000'000;

[[noreturn]] void refuse(std::string_view text) {
  throw std::invalid_argument(fmt::format("'{}' are no numbers, expected them as 3 or 0-15,20", text));
}

void add_range(std::string_view range, std::string_view text, std::vector<std::size_t>& numbers) {
  const std::size_t dash = range.find('-');
  const std::optional<std::uint64_t> first = parse_count(range.substr(0, dash));
  const std::optional<std::uint64_t> last =
      dash == std::string_view::npos ? first : parse_count(range.substr(dash + 1));
  if (!first || !last || *last < *first || *last - *first >= kMostNumbers) refuse(text);
  for (std::uint64_t number = *first; number <= *last; ++number) numbers.push_back(number);
}

}  // namespace

std::vector<std::size_t> parse_ranges(std::string_view text) {
  std::vector<std::size_t> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    add_range(text.substr(begin, end - begin), text, numbers);
    begin = end + 1;
  }
  return numbers;
}

std::string ranges_text(const std::vector<std::size_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    if (!text.empty()) text += ',';
    text += last == i ? fmt::format("{}", numbers[i]) : fmt::format("{}-{}", numbers[i], numbers[last]);
    i = last + 1;
  }
  return text;
}

}  // namespace vdbmap::cli

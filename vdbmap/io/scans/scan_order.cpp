// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/scans/scan_order.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

namespace vdbmap {
namespace {

// A number in a name, as text: it may have any number of digits.
struct NameNumber {
  bool is_negative = false;
  std::string_view whole;     // without leading zeros
  std::string_view fraction;  // without trailing zeros
};

bool is_digit_at(std::string_view name, std::size_t at) {
  return at < name.size() && name[at] >= '0' && name[at] <= '9';
}

std::size_t end_of_digits(std::string_view name, std::size_t begin) {
  return std::min(name.find_first_not_of("0123456789", begin), name.size());
}

bool is_minus_at(std::string_view name, std::size_t at) {
  return name[at] == '-' && is_digit_at(name, at + 1) && (at == 0 || name[at - 1] == '_');
}

bool is_number_at(std::string_view name, std::size_t at) { return is_digit_at(name, at) || is_minus_at(name, at); }

// Whether digits that begin and end there are the whole part of a fraction.
bool has_fraction(std::string_view name, std::size_t begin, std::size_t end) {
  const bool is_behind_point = begin >= 2 && name[begin - 1] == '.' && is_digit_at(name, begin - 2);
  if (is_behind_point || end >= name.size() || name[end] != '.' || !is_digit_at(name, end + 1)) return false;
  const std::size_t end_of_fraction = end_of_digits(name, end + 1);
  return !(end_of_fraction < name.size() && name[end_of_fraction] == '.' && is_digit_at(name, end_of_fraction + 1));
}

// Cuts the number off that begins at `at`, which moves behind it.
NameNumber cut_number(std::string_view name, std::size_t& at) {
  NameNumber number;
  number.is_negative = name[at] == '-';
  const std::size_t begin = at + (number.is_negative ? 1 : 0);
  at = end_of_digits(name, begin);
  number.whole = name.substr(begin, at - begin);
  if (has_fraction(name, begin, at)) {
    const std::size_t begin_of_fraction = at + 1;
    at = end_of_digits(name, begin_of_fraction);
    number.fraction = name.substr(begin_of_fraction, at - begin_of_fraction);
  }
  number.whole.remove_prefix(std::min(number.whole.find_first_not_of('0'), number.whole.size()));
  number.fraction = number.fraction.substr(0, number.fraction.find_last_not_of('0') + 1);
  return number;
}

// Negative, zero or positive as `a` comes before, with or after `b`; so do the others below.
int compare_sizes(const NameNumber& a, const NameNumber& b) {
  if (a.whole.size() != b.whole.size()) return a.whole.size() < b.whole.size() ? -1 : 1;
  if (const int order = a.whole.compare(b.whole); order != 0) return order;
  return a.fraction.compare(b.fraction);
}

int compare_numbers(const NameNumber& a, const NameNumber& b) {
  if (a.is_negative != b.is_negative) return a.is_negative ? -1 : 1;
  return a.is_negative ? compare_sizes(b, a) : compare_sizes(a, b);
}

int compare_names(std::string_view a, std::string_view b) {
  std::size_t at_a = 0;
  std::size_t at_b = 0;
  while (at_a < a.size() && at_b < b.size()) {
    const bool is_number_a = is_number_at(a, at_a);
    const bool is_number_b = is_number_at(b, at_b);
    if (is_number_a && is_number_b) {
      const NameNumber number_a = cut_number(a, at_a);
      if (const int order = compare_numbers(number_a, cut_number(b, at_b)); order != 0) return order;
    } else if (a[at_a] != b[at_b]) {
      return a[at_a] < b[at_b] ? -1 : 1;
    } else if (is_number_a != is_number_b) {
      return is_number_a ? -1 : 1;  // both begin with '-'
    } else {
      ++at_a;
      ++at_b;
    }
  }
  return static_cast<int>(at_b == b.size()) - static_cast<int>(at_a == a.size());
}

// A name as numbers and letters rank in it.
std::string small_name(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name;
}

}  // namespace

bool comes_before(const std::filesystem::path& a, const std::filesystem::path& b) {
  const int order = compare_names(small_name(a), small_name(b));
  return order != 0 ? order < 0 : a < b;  // scan_1 and scan_01 need an order too
}

}  // namespace vdbmap

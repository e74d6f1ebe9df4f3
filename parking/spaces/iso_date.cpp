// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/spaces/iso_date.h"

#include <array>
#include <charconv>
#include <chrono>
#include <cstdio>

namespace vdbmap::parking {
namespace {

// Cuts fixed digits, and separators before them, off a text.
class DigitReader {
 public:
  explicit DigitReader(std::string_view text) : rest_(text) {}

  bool is_at_end() const { return rest_.empty(); }

  bool skip(char c) {
    if (rest_.empty() || rest_.front() != c) return false;
    rest_.remove_prefix(1);
    return true;
  }

  std::optional<int> number(std::size_t digits) {
    if (rest_.size() < digits || rest_.substr(0, digits).find_first_not_of("0123456789") != std::string_view::npos) {
      return std::nullopt;
    }
    int value = 0;
    std::from_chars(rest_.data(), rest_.data() + digits, value);
    rest_.remove_prefix(digits);
    return value;
  }

  std::optional<int> number_behind(char separator, std::size_t digits) {
    return skip(separator) ? number(digits) : std::nullopt;
  }

 private:
  std::string_view rest_;
};

std::optional<std::chrono::sys_days> read_day(DigitReader& reader) {
  const auto year = reader.number(4), month = reader.number_behind('-', 2), day = reader.number_behind('-', 2);
  if (!year || !month || !day) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(*year), std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  return date.ok() ? std::optional(std::chrono::sys_days(date)) : std::nullopt;
}

// Hours and minutes as minutes.
std::optional<int> read_clock(DigitReader& reader) {
  const auto hours = reader.number(2), minutes = reader.number_behind(':', 2);
  return hours && minutes && *hours < 24 && *minutes < 60 ? std::optional(60 * *hours + *minutes) : std::nullopt;
}

}  // namespace

std::optional<std::int64_t> milliseconds_of(std::string_view date) {
  DigitReader reader(date);
  const auto day = read_day(reader);
  if (!day) return std::nullopt;
  std::int64_t seconds = std::chrono::duration_cast<std::chrono::seconds>(day->time_since_epoch()).count();
  if (reader.skip('T')) {
    const auto clock = read_clock(reader);
    if (!clock) return std::nullopt;
    seconds += 60 * *clock;
    if (reader.skip(':')) {
      const auto second = reader.number(2);
      if (!second || *second > 59) return std::nullopt;
      seconds += *second;
    }
    for (const int sign : {1, -1}) {
      if (!reader.skip(sign > 0 ? '+' : '-')) continue;
      const auto offset = read_clock(reader);
      if (!offset || !reader.is_at_end()) return std::nullopt;
      return 1000 * (seconds - sign * 60 * *offset);
    }
    reader.skip('Z');
  }
  return reader.is_at_end() ? std::optional(1000 * seconds) : std::nullopt;
}

std::string date_of_seconds(std::int64_t seconds) {
  const std::chrono::sys_seconds time{std::chrono::seconds(seconds)};
  const auto day = std::chrono::floor<std::chrono::days>(time);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss clock(time - day);
  std::array<char, 40> text;
  std::snprintf(text.data(), text.size(), "%04d-%02u-%02uT%02d:%02d:%02dZ", static_cast<int>(date.year()),
                static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                static_cast<int>(clock.hours().count()), static_cast<int>(clock.minutes().count()),
                static_cast<int>(clock.seconds().count()));
  return text.data();
}

}  // namespace vdbmap::parking

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/word_points.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "vdbmap/io/point_cloud_filter.h"
#include "vdbmap/io/text.h"

namespace vdbmap {
namespace {

constexpr std::size_t kSampleLines = 100;

std::vector<std::optional<PointField>> fields_of(const std::vector<WordColumn>& columns) {
  std::vector<std::optional<PointField>> fields;
  for (const WordColumn& column : columns) fields.push_back(column.field);
  return fields;
}

bool is_blank(std::string_view line) { return next_word(line).empty(); }

std::size_t count_words(std::string_view line) {
  std::size_t count = 0;
  while (!next_word(line).empty()) ++count;
  return count;
}

}  // namespace

WordPoints::WordPoints(std::vector<WordColumn> columns, std::string noun)
    : columns_(std::move(columns)),
      noun_(std::move(noun)),
      has_lists_(std::ranges::any_of(columns_, &WordColumn::is_list)),
      collector_(fields_of(columns_)) {
  for (const WordColumn& column : columns_) words_per_point_ += column.num_words;
}

std::string WordPoints::missing_word(std::size_t column) const {
  return "the line ends before " + noun_ + " " + vdbmap::quoted(columns_[column].name);
}

// Whether lines part the points: not where most of them hold no whole points and some hold less than one.
bool WordPoints::are_lines(ByteReader& file) const {
  if (has_lists_) return true;
  const char line_end = line_end_of(file.all());
  std::string_view rest = file.all().substr(file.offset());
  std::size_t num_lines = 0;
  std::size_t num_whole = 0;
  std::size_t num_short = 0;
  while (num_lines < kSampleLines && !rest.empty()) {
    const std::size_t end = std::min(rest.find(line_end), rest.size());
    const std::size_t num_words = count_words(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    num_lines += num_words > 0 ? 1 : 0;
    num_short += num_words > 0 && num_words < words_per_point_ ? 1 : 0;
    num_whole += num_words > 0 && num_words % words_per_point_ == 0 ? 1 : 0;
  }
  return num_short == 0 || 2 * num_whole >= num_lines;
}

// Takes a word as a number of the point; what is wrong, where the point cannot do without it.
std::string WordPoints::try_word(const ByteReader& file, std::size_t column, std::string_view word) {
  const std::optional<PointField>& field = columns_[column].field;
  if (!field) return "";
  const std::optional<double> number = parse_number(word);
  if (number) {
    collector_.set(column, number_from_text(*field, *number));
    return "";
  }
  const std::string reason =
      noun_ + " " + vdbmap::quoted(columns_[column].name) + " is " + quoted(word) + ", expected a number";
  if (is_coordinate(field->role)) return reason;
  collector_.set(column, std::numeric_limits<double>::quiet_NaN());
  missing_.add(column, file.line(), word, reason);
  return "";
}

std::string WordPoints::skip_list(std::string_view& rest, std::size_t column) const {
  const std::string_view word = next_word(rest);
  if (word.empty()) return missing_word(column);
  const std::optional<double> length = parse_number(word);
  if (!length)
    return noun_ + " " + vdbmap::quoted(columns_[column].name) + " is " + quoted(word) + ", expected a number";
  for (double i = 0; i < *length; ++i) {
    if (next_word(rest).empty()) return missing_word(column);
  }
  return "";
}

std::string WordPoints::try_words(const ByteReader& file, std::size_t column, std::string_view& rest) {
  for (std::uint64_t i = 0; i < columns_[column].num_words; ++i) {
    const std::string_view word = next_word(rest);
    if (word.empty()) return missing_word(column);
    const std::string reason = try_word(file, column, word);
    if (!reason.empty()) return reason;
  }
  return "";
}

// Cuts a point off the front of `rest`; what is wrong with it, or nothing.
std::string WordPoints::try_point(const ByteReader& file, std::string_view& rest) {
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    std::string reason = columns_[i].is_list ? skip_list(rest, i) : try_words(file, i, rest);
    if (!reason.empty()) return reason;
  }
  return "";
}

void WordPoints::read_line(const ByteReader& file, std::string_view line, std::uint64_t most) {
  std::string_view rest = line;
  std::string reason = try_point(file, rest);
  if (reason.empty() && !is_blank(rest) && !has_lists_ && count_words(line) % words_per_point_ != 0) {
    reason = "found " + quoted(next_word(rest)) + " after the last " + noun_;
  }
  while (reason.empty()) {
    collector_.finish_point();
    if (is_blank(rest) || num_points() == most) return;
    reason = try_point(file, rest);
  }
  broken_.add(num_points(), file.line(), reason);
}

// A word in the wrong place leaves the count of words right: the point is broken, those behind it are not.
void WordPoints::read_flow(ByteReader& file, std::uint64_t count) {
  std::string_view rest;
  while (num_points() < count) {
    std::string reason;
    for (std::uint64_t i = 0, column = 0, word = 0; i < words_per_point_; ++i) {
      while (is_blank(rest)) {
        if (file.remaining() == 0) return;
        rest = file.read_line();
      }
      const std::string wrong = try_word(file, column, next_word(rest));
      if (reason.empty()) reason = wrong;
      const bool is_last = ++word == columns_[column].num_words;
      column += is_last ? 1 : 0;
      word = is_last ? 0 : word;
    }
    if (reason.empty()) {
      collector_.finish_point();
    } else {
      broken_.add(num_points(), file.line(), reason);
    }
  }
}

void WordPoints::read(ByteReader& file, std::uint64_t count) {
  if (!are_lines(file)) return read_flow(file, count);
  while (num_points() < count && file.remaining() > 0) {
    const std::string_view line = file.read_line();
    if (!is_blank(line)) read_line(file, line, count);
  }
}

ReadResult WordPoints::finish(const std::filesystem::path& path, const std::vector<ReadFinding>& more) {
  broken_.check(path, collector_.size());
  std::vector<ReadFinding> findings;
  broken_.note(findings);
  PointCloud cloud = collector_.finish();
  std::vector<std::string> names;
  for (const WordColumn& column : columns_) names.push_back(column.name);
  missing_.finish(cloud, fields_of(columns_), names, findings);
  findings.insert(findings.end(), more.begin(), more.end());
  return finish_reading(path, std::move(cloud), broken_.places(), std::move(findings));
}

}  // namespace vdbmap

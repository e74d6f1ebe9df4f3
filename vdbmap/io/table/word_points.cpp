// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/table/word_points.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "vdbmap/io/file/text.h"
#include "vdbmap/io/points/point_cloud_filter.h"

namespace vdbmap {
namespace {

constexpr std::size_t kSampleLines = 100;

std::vector<std::optional<PointField>> fields_of(const std::vector<WordColumn>& columns) {
  std::vector<std::optional<PointField>> fields;
  for (const WordColumn& column : columns) fields.push_back(column.field);
  return fields;
}

bool is_blank_line(std::string_view line) { return next_word(line).empty(); }

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

// Takes a word as a number of the point; false where the point cannot do without it.
bool WordPoints::try_word(std::size_t column, std::string_view word) {
  const PointField& field = *columns_[column].field;
  const std::optional<double> number = parse_number(word);
  if (number) {
    collector_.set(column, number_from_text(field, *number));
    return true;
  }
  collector_.set(column, std::numeric_limits<double>::quiet_NaN());
  lacking_.emplace_back(column, word);
  bad_word_ = word;
  return !is_coordinate(field.role);
}

bool WordPoints::skip_words(std::string_view& rest, std::uint64_t count) {
  bad_word_ = {};
  for (std::uint64_t i = 0; i < count; ++i) {
    if (next_word(rest).empty()) return false;
  }
  return true;
}

bool WordPoints::skip_list(std::string_view& rest) {
  bad_word_ = next_word(rest);
  const std::optional<double> length = parse_number(bad_word_);
  if (!length) return false;
  const double most = static_cast<double>(rest.size());  // no list is longer than its line
  return skip_words(rest, *length > 0 ? static_cast<std::uint64_t>(std::min(*length, most + 1)) : 0);
}

bool WordPoints::try_column(std::size_t column, std::string_view& rest) {
  if (columns_[column].is_list) return skip_list(rest);
  const std::optional<PointField>& field = columns_[column].field;
  if (!field) return skip_words(rest, columns_[column].num_words);
  rest.remove_prefix(std::min(rest.find_first_not_of(" \t\r\v\f"), rest.size()));
  if (const auto number = cut_plain_number(rest, is_blank)) {
    collector_.set(column, number_from_text(*field, *number));
    return true;
  }
  bad_word_ = next_word(rest);
  return !bad_word_.empty() && try_word(column, bad_word_);
}

// Cuts a point off the front of `rest`; false where it is broken.
bool WordPoints::try_point(std::string_view& rest) {
  lacking_.clear();
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    bad_column_ = i;
    if (!try_column(i, rest)) return false;
  }
  return true;
}

void WordPoints::finish_point(const ByteReader& file) {
  for (const auto& [column, word] : lacking_) {
    missing_.add(column, file.line(), word, quoted(word) + " is not a number");
  }
  collector_.finish_point();
}

void WordPoints::note_broken(const ByteReader& file) {
  const std::string name = noun_ + " " + vdbmap::quoted(columns_[bad_column_].name);
  broken_.add(
      num_points(), file.line(),
      bad_word_.empty() ? "the line ends before " + name : name + " is " + quoted(bad_word_) + ", expected a number");
}

void WordPoints::read_line(const ByteReader& file, std::string_view line, std::uint64_t most) {
  std::string_view rest = line;
  bool is_whole = try_point(rest);
  if (is_whole && !is_blank_line(rest) && !has_lists_ && count_words(line) % words_per_point_ != 0) {
    return broken_.add(num_points(), file.line(), "found " + quoted(next_word(rest)) + " after the last " + noun_);
  }
  while (is_whole) {
    finish_point(file);
    if (is_blank_line(rest) || num_points() == most) return;
    is_whole = try_point(rest);
  }
  note_broken(file);
}

// A word in the wrong place leaves the count of words right: the point is broken, those behind it are not.
void WordPoints::read_flow(ByteReader& file, std::uint64_t count) {
  std::string_view rest;
  while (num_points() < count) {
    bool is_whole = true;
    lacking_.clear();
    for (std::uint64_t i = 0, column = 0, word = 0; i < words_per_point_; ++i) {
      while (is_blank_line(rest)) {
        if (file.remaining() == 0) return;
        rest = file.read_line();
      }
      const std::string_view text = next_word(rest);
      if (is_whole && columns_[column].field) {
        bad_column_ = column;
        is_whole = try_word(column, text);
      }
      const bool is_last = ++word == columns_[column].num_words;
      column += is_last ? 1 : 0;
      word = is_last ? 0 : word;
    }
    is_whole ? finish_point(file) : note_broken(file);
  }
}

void WordPoints::read(ByteReader& file, std::uint64_t count) {
  if (!are_lines(file)) return read_flow(file, count);
  while (num_points() < count && file.remaining() > 0) {
    const std::string_view line = file.read_line();
    if (!is_blank_line(line)) read_line(file, line, count);
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

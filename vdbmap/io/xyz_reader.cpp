// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vdbmap/io/byte_reader.h"
#include "vdbmap/io/point_cloud_filter.h"
#include "vdbmap/io/text.h"
#include "vdbmap/io/xyz.h"
#include "vdbmap/io/xyz_layout.h"

namespace vdbmap {
namespace {

constexpr std::size_t kPointsPerBlock = 1024;  // points

bool needs_whole_number(FieldRole role) {
  switch (role) {
    case FieldRole::kRed:
    case FieldRole::kGreen:
    case FieldRole::kBlue:
    case FieldRole::kRing:
    case FieldRole::kLabel:
      return true;
    default:
      return false;
  }
}

// NaN passes: it is how tables say that a value is missing.
bool is_16_bit_number_or_nan(double number) {
  return std::isnan(number) || (number >= 0 && number <= 65535 && number == std::floor(number));
}

template <typename T>
void grow(std::vector<T>& values, bool is_present, std::size_t count) {
  if (is_present) values.resize(values.size() + count);
}

// Collects the numbers of a block of points, column by column.
class PointCollector {
 public:
  explicit PointCollector(XyzLayout layout) : layout_(std::move(layout)), shape_(make_cloud(layout_.columns, 1)) {
    numbers_.resize(layout_.columns.size());
  }

  const std::vector<std::optional<PointField>>& columns() const { return layout_.columns; }

  void set(std::size_t column, double number) { numbers_[column][num_in_block_] = number; }

  void finish_point() {
    if (++num_in_block_ == kPointsPerBlock) store_block();
  }

  PointCloud finish() {
    store_block();
    scale_colors();
    return std::move(cloud_);
  }

 private:
  void store_block() {
    const std::size_t first = cloud_.size();
    grow(cloud_.positions, true, num_in_block_);
    grow(cloud_.colors, !shape_.colors.empty(), num_in_block_);
    grow(cloud_.intensities, !shape_.intensities.empty(), num_in_block_);
    grow(cloud_.times, !shape_.times.empty(), num_in_block_);
    grow(cloud_.rings, !shape_.rings.empty(), num_in_block_);
    grow(cloud_.labels, !shape_.labels.empty(), num_in_block_);
    for (std::size_t column = 0; column < numbers_.size(); ++column) {
      if (columns()[column]) {
        store_numbers(cloud_, *columns()[column], first, std::span(numbers_[column].data(), num_in_block_));
      }
    }
    num_in_block_ = 0;
  }

  void scale_colors() {
    const auto has_8_bits = [](const Rgb16& color) { return std::max({color.r, color.g, color.b}) <= 255; };
    if (layout_.colors_have_16_bits || !std::ranges::all_of(cloud_.colors, has_8_bits)) return;
    const auto widened = [](std::uint16_t channel) { return static_cast<std::uint16_t>(channel * 257); };
    for (Rgb16& color : cloud_.colors) color = {widened(color.r), widened(color.g), widened(color.b)};
  }

  XyzLayout layout_;
  PointCloud shape_;  // one point with the attributes that the columns provide
  std::vector<std::array<double, kPointsPerBlock>> numbers_;
  std::size_t num_in_block_ = 0;
  PointCloud cloud_;
};

double parse_field(const ByteReader& file, const PointField& field, std::string_view text, std::size_t column) {
  const auto place = [&] { return "column " + std::to_string(column + 1) + ": "; };
  const std::optional<double> number = parse_number(text);
  if (!number) file.fail_line(place() + (text.empty() ? "is empty" : quoted(text) + " is not a number"));
  if (needs_whole_number(field.role) && !is_16_bit_number_or_nan(*number)) {
    file.fail_line(place() + quoted(text) + " is not a whole number from 0 to 65535");
  }
  return number_from_text(field, *number);
}

void parse_point(const ByteReader& file, std::string_view line, PointCollector& collector) {
  const auto& columns = collector.columns();
  std::string_view rest = line;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto text = next_column(rest);
    if (!text) {
      file.fail_line("found " + std::to_string(i) + " columns, expected " + std::to_string(columns.size()));
    }
    if (columns[i]) collector.set(i, parse_field(file, *columns[i], *text, i));
  }
  if (next_column(rest)) {
    file.fail_line("found " + std::to_string(count_columns(line)) + " columns, expected " +
                   std::to_string(columns.size()));
  }
  collector.finish_point();
}

// What the lines before the first point say about the columns.
XyzLayout layout_of_first_point(const ByteReader& file, const std::optional<XyzLayout>& header, std::string_view line) {
  const std::size_t num_columns = count_columns(line);
  // A comment may speak of x, y and z without being a header: it must fit.
  if (header && header->columns.size() == num_columns) return *header;
  if (auto layout = layout_of_count(num_columns)) return *layout;
  file.fail_line("found " + std::to_string(num_columns) +
                 " columns and no line before that names them; without names 3, 4, 6 or 7 are expected");
}

std::string_view read_line_without_mark(ByteReader& file) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  const bool is_first = file.offset() == 0;
  std::string_view line = file.read_line();
  if (is_first && line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
  return line;
}

bool is_number(std::string_view line) {
  const auto column = next_column(line);
  return column && parse_number(*column);
}

// Reads up to the first point and returns its line; nothing where there is none.
std::optional<std::string_view> find_first_point(ByteReader& file, std::optional<XyzLayout>& header) {
  while (file.remaining() > 0) {
    const std::string_view line = read_line_without_mark(file);
    const bool is_data = count_columns(line) > 0;
    if (is_data && is_number(line)) return line;
    std::optional<XyzLayout> named = layout_of_header(line);
    if (is_data && (!named || header))
      file.fail_line(quoted(line) + " is neither a point nor a header with x, y and z");
    if (named) header = std::move(named);
  }
  return std::nullopt;
}

}  // namespace

ReadResult read_xyz(const std::filesystem::path& path) {
  ByteReader file(path);
  std::optional<XyzLayout> header;
  const auto first_point = find_first_point(file, header);
  if (!first_point) return finish_reading(path, {});

  PointCollector collector(layout_of_first_point(file, header, *first_point));
  parse_point(file, *first_point, collector);
  while (file.remaining() > 0) {
    const std::string_view line = file.read_line();
    std::string_view rest = line;
    if (next_column(rest)) parse_point(file, line, collector);
  }
  return finish_reading(path, collector.finish());
}

}  // namespace vdbmap

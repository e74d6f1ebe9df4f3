// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/bin_columns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace vdbmap {
namespace {

constexpr std::size_t kNumbersPerPiece = 120;  // a whole number of points of 3, 4, 5 and 6 columns
constexpr std::size_t kNumPieces = 8;

// Two views of a number: with its sign, and without it and finer near zero, where intensities are.
using Views = std::array<double, 2>;
Views views_of(double number) { return {std::asinh(number), std::asinh(10 * std::abs(number))}; }

// Sums of one view over some numbers.
struct Sums {
  double count = 0;
  double sum = 0;
  double sum_of_squares = 0;

  void add(double value) {
    count += 1;
    sum += value;
    sum_of_squares += value * value;
  }
  double variation() const { return count > 0 ? std::max(0.0, sum_of_squares - sum * sum / count) : 0.0; }
};

// Variation within the columns as a share of that of all numbers; 1 where all are equal.
double share_within(const std::vector<Sums>& columns, const Sums& all) {
  double within = 0;
  for (const Sums& column : columns) within += column.variation();
  return all.variation() > 0 ? within / all.variation() : 1.0;
}

double separation(const std::vector<std::optional<Views>>& numbers, std::size_t num_columns) {
  std::array<std::vector<Sums>, 2> columns;
  std::array<Sums, 2> all;
  columns.fill(std::vector<Sums>(num_columns));
  for (std::size_t i = 0; i < numbers.size() / num_columns * num_columns; ++i) {
    if (!numbers[i]) continue;
    for (std::size_t view = 0; view < 2; ++view) {
      columns[view][i % num_columns].add((*numbers[i])[view]);
      all[view].add((*numbers[i])[view]);
    }
  }
  const double freedom = all[0].count - static_cast<double>(num_columns);
  if (freedom < 1) return 0;
  const double within = (share_within(columns[0], all[0]) + share_within(columns[1], all[1])) / 2;
  return 1 - within * (all[0].count - 1) / freedom;
}

}  // namespace

std::vector<double> sample_numbers(std::string_view bytes, ScalarType type) {
  const std::size_t num_all = bytes.size() / size_of(type);
  const StridedNumbers source{bytes.data(), size_of(type), type};
  if (num_all <= kNumPieces * kNumbersPerPiece) {
    std::vector<double> numbers(num_all);
    load_numbers(source, 0, numbers);
    return numbers;
  }
  std::vector<double> numbers(kNumPieces * kNumbersPerPiece);
  for (std::size_t i = 0; i < kNumPieces; ++i) {
    const std::size_t begin = (num_all - kNumbersPerPiece) * i / (kNumPieces - 1) / 60 * 60;
    load_numbers(source, begin, std::span(numbers).subspan(i * kNumbersPerPiece, kNumbersPerPiece));
  }
  return numbers;
}

double share_of_likely_numbers(const std::vector<double>& numbers) {
  const auto num_likely = std::ranges::count_if(numbers, [](double number) {
    const double size = std::abs(number);
    return !std::isfinite(number) || size == 0 || (size > 1e-18 && size < 1e10);
  });
  return numbers.empty() ? 0.0 : static_cast<double>(num_likely) / static_cast<double>(numbers.size());
}

std::vector<double> column_of(const std::vector<double>& numbers, std::size_t num_columns, std::size_t column) {
  std::vector<double> result;
  for (std::size_t i = column; i < numbers.size() / num_columns * num_columns; i += num_columns) {
    result.push_back(numbers[i]);
  }
  return result;
}

std::vector<double> separations(const std::vector<double>& numbers, std::span<const std::size_t> nums_of_columns) {
  std::vector<std::optional<Views>> views;
  for (const double number : numbers)
    views.push_back(std::isfinite(number) ? std::optional(views_of(number)) : std::nullopt);
  std::vector<double> result;
  for (const std::size_t num_columns : nums_of_columns) result.push_back(separation(views, num_columns));
  return result;
}

}  // namespace vdbmap

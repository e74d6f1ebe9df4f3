// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/kitti/bin_columns.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbmap {
namespace {

constexpr std::size_t kNumbersPerPiece = 60;  // a whole number of points of 3, 4, 5 and 6 columns
constexpr std::size_t kNumPieces = 8;

// Two views of a number, with its sign and without: fourth roots, on which 0.1 counts beside 100.
using Views = std::array<double, 2>;

Views views_of(double number) {
  const double root = std::sqrt(std::sqrt(std::abs(number)));
  return {std::copysign(root, number), root};
}

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
  void add(const Sums& other) {
    count += other.count;
    sum += other.sum;
    sum_of_squares += other.sum_of_squares;
  }
  double variation() const { return count > 0 ? std::max(0.0, sum_of_squares - sum * sum / count) : 0.0; }
};

// Variation within the columns as a share of that of all numbers, in one view; 1 where all are equal.
double share_within(const std::vector<Views>& numbers, std::size_t view, std::size_t num_columns) {
  const std::size_t end = numbers.size() / num_columns * num_columns;
  Sums all;
  double within = 0;
  for (std::size_t column = 0; column < num_columns; ++column) {
    Sums sums;
    for (std::size_t i = column; i < end; i += num_columns) {
      if (std::isfinite(numbers[i][view])) sums.add(numbers[i][view]);
    }
    all.add(sums);
    within += sums.variation();
  }
  return all.variation() > 0 ? within / all.variation() : 1.0;
}

double separation(const std::vector<Views>& numbers, std::size_t num_columns) {
  const auto count = static_cast<double>(numbers.size() / num_columns * num_columns);
  const double freedom = count - static_cast<double>(num_columns);
  if (freedom < 1) return 0;
  const double within = (share_within(numbers, 0, num_columns) + share_within(numbers, 1, num_columns)) / 2;
  return 1 - within * (count - 1) / freedom;
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
  std::vector<Views> views;
  views.reserve(numbers.size());
  for (const double number : numbers) views.push_back(views_of(number));
  std::vector<double> result;
  for (const std::size_t num_columns : nums_of_columns) result.push_back(separation(views, num_columns));
  return result;
}

}  // namespace vdbmap

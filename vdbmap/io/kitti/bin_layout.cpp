// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/kitti/bin_layout.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vdbmap/io/kitti/bin_columns.h"

namespace vdbmap {
namespace {

using Names = std::vector<std::string>;
using Numbers = std::vector<double>;

constexpr std::array<std::size_t, 4> kNumbersOfColumns = {3, 4, 5, 6};

// On street scans of 32 and 64 beams, ordered and shuffled, the right number of columns reaches 0.2 to 1 and the others
// less than 0.01, or up to half of it where they share a divisor.
constexpr double kClearLead = 0.1;
constexpr double kNumbersForClearLead = 60;  // of fewer, chance alone parts some as well
constexpr std::size_t kFewestPoints = 4;
constexpr std::size_t kFewestForCutFiles = 60;  // numbers

bool all_of(const Numbers& numbers, auto&& holds) {
  return std::ranges::all_of(numbers, [&](double number) { return !std::isfinite(number) || holds(number); });
}

bool is_whole_up_to(double number, double largest) {
  return number >= 0 && number <= largest && number == std::floor(number);
}

// As intensities are written: from 0 to 1, or whole numbers.
bool are_intensities(const Numbers& numbers) {
  const bool are_shares = all_of(numbers, [](double number) { return number >= 0 && number <= 1; });
  return are_shares || all_of(numbers, [](double number) { return is_whole_up_to(number, 65535); });
}

bool are_not_negative(const Numbers& numbers) {
  return all_of(numbers, [](double number) { return number >= 0; });
}

bool are_rings(const Numbers& numbers) {
  return all_of(numbers, [](double number) { return is_whole_up_to(number, 1023); });
}

bool are_normals(const Numbers& numbers) {
  for (std::size_t i = 0; i + 6 <= numbers.size(); i += 6) {
    const double length = std::hypot(numbers[i + 3], numbers[i + 4], numbers[i + 5]);
    if (std::abs(length - 1) > 0.01) return false;
  }
  return true;
}

bool are_colors(const Numbers& numbers) {
  for (const std::size_t column : {3U, 4U, 5U}) {
    const bool are_whole =
        all_of(column_of(numbers, 6, column), [](double number) { return is_whole_up_to(number, 255); });
    if (!are_whole) return false;
  }
  return true;
}

// What is behind x, y and z; nothing where that is not plain.
std::optional<Names> names_of_rest(const Numbers& numbers, std::size_t num_columns) {
  if (num_columns == 3) return Names{};
  if (num_columns == 4) return Names{"intensity"};
  if (num_columns == 6 && are_normals(numbers)) return Names{"-", "-", "-"};
  if (num_columns == 6 && are_colors(numbers)) return std::nullopt;  // or an intensity, a ring and a whole number
  const bool has_ring =
      are_not_negative(column_of(numbers, num_columns, 3)) && are_rings(column_of(numbers, num_columns, 4));
  if (!has_ring) return std::nullopt;
  return num_columns == 5 ? Names{"intensity", "ring"} : Names{"intensity", "ring", "-"};
}

// Whether the numbers allow that many columns: the fourth of four is an intensity.
bool allows(const Numbers& numbers, std::size_t num_columns) {
  if (num_columns == 4) return are_not_negative(column_of(numbers, 4, 3));
  return names_of_rest(numbers, num_columns).has_value();
}

bool divides(std::size_t num_columns, std::size_t size, ScalarType type) {
  return size % (num_columns * size_of(type)) == 0;
}

// The number of columns that parts the numbers clearly better than the others do. Six do as well as three where three
// are right.
std::optional<std::size_t> clearly_parted(const Numbers& numbers) {
  const double lead = kClearLead * std::max(1.0, kNumbersForClearLead / static_cast<double>(numbers.size()));
  const std::vector<double> values = separations(numbers, kNumbersOfColumns);
  const bool is_three_or_six = std::max(values[0], values[3]) > std::max(values[1], values[2]);
  const bool are_six = is_three_or_six && values[3] > values[0] + lead;
  const std::size_t best = are_six ? 3 : is_three_or_six ? 0 : values[1] > values[2] ? 1 : 2;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool is_multiple = best == 0 && i == 3;
    if (i != best && !is_multiple && values[i] + lead > values[best]) return std::nullopt;
  }
  const bool are_enough = numbers.size() >= kFewestPoints * kNumbersOfColumns[best];
  return are_enough ? std::optional(kNumbersOfColumns[best]) : std::nullopt;
}

// Of few points or of points all over a cube: the one number of columns that the numbers allow. KITTI's comes first
// where its intensities are as intensities are.
std::optional<std::size_t> only_allowed(const Numbers& numbers, std::size_t size, ScalarType type) {
  std::vector<std::size_t> fitting;
  for (const std::size_t n : kNumbersOfColumns) {
    if (divides(n, size, type)) fitting.push_back(n);
  }
  if (fitting == std::vector<std::size_t>{4}) return 4;
  const bool may_be_kitti = std::ranges::find(fitting, 4U) != fitting.end();
  if (may_be_kitti && are_intensities(column_of(numbers, 4, 3))) return 4;
  std::erase_if(fitting, [&](std::size_t n) { return !allows(numbers, n); });
  return fitting.size() == 1 ? std::optional(fitting.front()) : std::nullopt;
}

std::optional<std::size_t> guess_num_columns(const Numbers& numbers, std::size_t size, ScalarType type) {
  const std::optional<std::size_t> parted = clearly_parted(numbers);
  const bool is_sure = parted && (divides(*parted, size, type) || numbers.size() >= kFewestForCutFiles);
  return is_sure ? parted : only_allowed(numbers, size, type);
}

// Short doubles are floats every other one of which is zero.
bool are_halves_of_doubles(const Numbers& numbers) {
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    if (numbers[i] != 0) return false;
  }
  return true;
}

bool holds_doubles(const Numbers& floats, const Numbers& doubles) {
  if (doubles.size() < 3) return false;
  if (share_of_likely_numbers(doubles) < 0.99) return false;
  return share_of_likely_numbers(floats) < 0.99 || are_halves_of_doubles(floats);
}

}  // namespace

bool BinLayout::is_kitti() const {
  return type == ScalarType::kFloat32 && columns.size() == 4 && columns[3] && columns[3]->role == FieldRole::kIntensity;
}

BinLayout bin_layout_of_names(const Names& names, ScalarType type) {
  std::vector<NamedField> fields;
  for (const std::string& name : names) fields.push_back({name, type});
  return {choose_point_fields(fields), type};
}

std::optional<BinLayout> guess_bin_layout(std::string_view bytes, std::optional<ScalarType> stated_type) {
  const Numbers floats = sample_numbers(bytes, ScalarType::kFloat32);
  const Numbers doubles = sample_numbers(bytes, ScalarType::kFloat64);
  const ScalarType likely = holds_doubles(floats, doubles) ? ScalarType::kFloat64 : ScalarType::kFloat32;
  const ScalarType type = stated_type.value_or(likely);
  const Numbers& numbers = type == ScalarType::kFloat64 ? doubles : floats;
  if (share_of_likely_numbers(numbers) < 0.9) return std::nullopt;

  const std::optional<std::size_t> num_columns = guess_num_columns(numbers, bytes.size(), type);
  if (!num_columns) return std::nullopt;
  const std::optional<Names> rest = names_of_rest(numbers, *num_columns);
  if (!rest) return std::nullopt;
  Names names = {"x", "y", "z"};
  names.insert(names.end(), rest->begin(), rest->end());
  return bin_layout_of_names(names, type);
}

std::string text_of(const BinLayout& layout) {
  std::string text = layout.type == ScalarType::kFloat64 ? "doubles x, y, z" : "x, y, z";
  for (std::size_t i = 3; i < layout.columns.size(); ++i) {
    const auto& column = layout.columns[i];
    const bool is_ring = column && column->role == FieldRole::kRing;
    text += !column ? ", -" : is_ring ? ", ring" : ", intensity";
  }
  return text;
}

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstddef>
#include <span>
#include <string>

namespace vdbmap {

/// The number types of PLY and PCD.
enum class ScalarType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kInt64, kUint64, kFloat32, kFloat64 };

std::size_t size_of(ScalarType type);  ///< [bytes]
bool is_integer(ScalarType type);

/// Numbers in memory: the i-th begins at first + i * stride. All are turned to double: 64-bit integers beyond 2^53
/// round.
struct StridedNumbers {
  const char* first = nullptr;
  std::size_t stride = 0;  ///< [bytes]
  ScalarType type = ScalarType::kFloat64;
  std::endian order = std::endian::little;
};

/// Loads numbers.size() numbers from the `begin`-th on.
void load_numbers(const StridedNumbers& source, std::size_t begin, std::span<double> numbers);

/// The number at `bytes`.
double load_number(const char* bytes, ScalarType type, std::endian order);

/// Appends a number that `type` can hold, little endian.
void append_binary(std::string& bytes, double number, ScalarType type);

/// Appends a number that `type` can hold, in the fewest characters that read back the same.
void append_text(std::string& text, double number, ScalarType type);

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/file/scalar_type.h"

#include <array>
#include <charconv>
#include <cstdint>

#include "vdbmap/io/file/byte_reader.h"

namespace vdbmap {
namespace {

// Calls `visitor` with a value of the C++ type that `type` names.
template <typename Visitor>
void visit_type(ScalarType type, Visitor&& visitor) {
  switch (type) {
    case ScalarType::kInt8:
      return visitor(std::int8_t{});
    case ScalarType::kUint8:
      return visitor(std::uint8_t{});
    case ScalarType::kInt16:
      return visitor(std::int16_t{});
    case ScalarType::kUint16:
      return visitor(std::uint16_t{});
    case ScalarType::kInt32:
      return visitor(std::int32_t{});
    case ScalarType::kUint32:
      return visitor(std::uint32_t{});
    case ScalarType::kInt64:
      return visitor(std::int64_t{});
    case ScalarType::kUint64:
      return visitor(std::uint64_t{});
    case ScalarType::kFloat32:
      return visitor(float{});
    case ScalarType::kFloat64:
      return visitor(double{});
  }
}

template <typename T, std::endian Order>
void load_typed(const char* from, std::size_t stride, std::span<double> numbers) {
  for (double& number : numbers) {
    number = static_cast<double>(load<T, Order>(from));
    from += stride;
  }
}

}  // namespace

std::size_t size_of(ScalarType type) {
  std::size_t size = 0;
  visit_type(type, [&](auto zero) { size = sizeof(zero); });
  return size;
}

bool is_integer(ScalarType type) { return type < ScalarType::kFloat32; }

void load_numbers(const StridedNumbers& source, std::size_t begin, std::span<double> numbers) {
  const char* from = source.first + begin * source.stride;
  visit_type(source.type, [&](auto zero) {
    if (source.order == std::endian::little) {
      load_typed<decltype(zero), std::endian::little>(from, source.stride, numbers);
    } else {
      load_typed<decltype(zero), std::endian::big>(from, source.stride, numbers);
    }
  });
}

double load_number(const char* bytes, ScalarType type, std::endian order) {
  double number = 0;
  load_numbers({bytes, 0, type, order}, 0, {&number, 1});
  return number;
}

void append_binary(std::string& bytes, double number, ScalarType type) {
  visit_type(type, [&](auto zero) {
    auto value = static_cast<decltype(zero)>(number);
    if constexpr (std::endian::native != std::endian::little) value = swap_bytes(value);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  });
}

void append_text(std::string& text, double number, ScalarType type) {
  std::array<char, 32> buffer;
  visit_type(type, [&](auto zero) {
    const auto value = static_cast<decltype(zero)>(number);
    text.append(buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr);
  });
}

}  // namespace vdbmap

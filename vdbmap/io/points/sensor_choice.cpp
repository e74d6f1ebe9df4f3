// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/points/sensor_choice.h"

#include <array>
#include <charconv>
#include <cstdio>

namespace vdbmap {
namespace {

// A whole text as a number up to `greatest`.
std::optional<std::uint32_t> parse_up_to(std::string_view text, std::uint32_t greatest, int base = 10) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  const bool is_whole = error == std::errc() && end == text.data() + text.size();
  return is_whole && value <= greatest ? std::optional(value) : std::nullopt;
}

// Cuts what is behind the last `separator` off `text`; nothing where there is none.
std::optional<std::string_view> cut_behind(std::string_view& text, char separator) {
  const std::size_t at = text.rfind(separator);
  if (at == std::string_view::npos) return std::nullopt;
  const std::string_view behind = text.substr(at + 1);
  text = text.substr(0, at);
  return behind;
}

std::optional<std::uint32_t> parse_address(std::string_view text) {
  std::uint32_t address = 0;
  for (int part = 0; part < 4; ++part) {
    const std::size_t length = part < 3 ? text.find('.') : text.size();
    if (length == std::string_view::npos) return std::nullopt;
    const auto number = parse_up_to(text.substr(0, length), 255);
    if (!number) return std::nullopt;
    address = address << 8 | *number;
    text.remove_prefix(part < 3 ? length + 1 : length);
  }
  return address;
}

}  // namespace

std::optional<SensorChoice> parse_sensor_choice(std::string_view text) {
  SensorChoice choice;
  if (const auto product = cut_behind(text, '/')) {
    const auto number = product->starts_with("0x") ? parse_up_to(product->substr(2), 0xff, 16) : std::nullopt;
    if (!number) return std::nullopt;
    choice.product = static_cast<std::uint8_t>(*number);
  }
  if (const auto port = cut_behind(text, ':')) {
    const auto number = parse_up_to(*port, 0xffff);
    if (!number) return std::nullopt;
    choice.port = static_cast<std::uint16_t>(*number);
  }
  const auto address = parse_address(text);
  if (!address) return std::nullopt;
  choice.address = *address;
  return choice;
}

std::string text_of(const SensorChoice& choice) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8) {
    text += std::to_string(choice.address >> shift & 0xff) + (shift > 0 ? "." : "");
  }
  if (choice.port) text.append(":").append(std::to_string(*choice.port));
  if (choice.product) {
    std::array<char, 8> product{};
    std::snprintf(product.data(), product.size(), "/0x%02x", static_cast<unsigned>(*choice.product));
    text += product.data();
  }
  return text;
}

}  // namespace vdbmap

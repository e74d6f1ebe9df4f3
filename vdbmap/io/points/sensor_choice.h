// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vdbmap {

/// Which of the sensors in a packet capture is meant.
struct SensorChoice {
  std::uint32_t address = 0;            ///< IPv4, of the sender
  std::optional<std::uint16_t> port;    ///< to which it sends; nothing: any
  std::optional<std::uint8_t> product;  ///< number by which it names itself; nothing: any

  bool operator==(const SensorChoice&) const = default;
};

/// "192.168.1.201", "192.168.1.201:2368" or "192.168.1.201:2368/0x22"; nothing for other texts.
std::optional<SensorChoice> parse_sensor_choice(std::string_view text);

/// The same text.
std::string text_of(const SensorChoice& choice);

}  // namespace vdbmap

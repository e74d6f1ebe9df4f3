// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/points/sensor_choice.h"

#include <gtest/gtest.h>

namespace vdbmap {
namespace {

TEST(SensorChoice, IsAnAddressWithOrWithoutPortAndProduct) {
  const std::uint32_t address = 0xc0a801c9;
  EXPECT_EQ(parse_sensor_choice("192.168.1.201"), (SensorChoice{address, {}, {}}));
  EXPECT_EQ(parse_sensor_choice("192.168.1.201:2368"), (SensorChoice{address, 2368, {}}));
  EXPECT_EQ(parse_sensor_choice("192.168.1.201/0x22"), (SensorChoice{address, {}, 0x22}));
  EXPECT_EQ(parse_sensor_choice("0.0.0.255:65535/0xff"), (SensorChoice{255, 65535, 0xff}));
}

TEST(SensorChoice, IsWrittenAsItIsRead) {
  for (const char* text : {"192.168.1.201", "192.168.1.201:2368", "10.0.0.1/0x22", "255.255.255.255:0/0x05"}) {
    EXPECT_EQ(text_of(parse_sensor_choice(text).value()), text);
  }
}

TEST(SensorChoice, IsNothingElse) {
  for (const char* text : {"", "192.168.1", "192.168.1.256", "192.168.1.201.", "192.168.1.201:", "192.168.1.201:65536",
                           "192.168.1.201:-1", "192.168.1.201/22", "192.168.1.201/0x", "192.168.1.201/0x100", ":2368",
                           "1.2.3.4 ", " 1.2.3.4", "1.2.3.4:5:6", "a.b.c.d", "+1.2.3.4"}) {
    EXPECT_EQ(parse_sensor_choice(text), std::nullopt) << text;
  }
}

}  // namespace
}  // namespace vdbmap

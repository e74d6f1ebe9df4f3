// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/vlp16_packets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace vdbmap::test {
namespace {

constexpr double kFiringPeriod = 55.296e-6;  // [s]
constexpr double kLaserPeriod = 2.304e-6;    // [s]

// Rings in the order of firing (VLP-16 manual, table 9-1: -15, 1, -13, 3, ... degrees).
constexpr std::array<int, 16> kRingOfLaser = {0, 8, 1, 9, 2, 10, 3, 11, 4, 12, 5, 13, 6, 14, 7, 15};

void append_little(std::string& bytes, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> 8 * i & 0xff);
}

void append_big(std::string& bytes, std::uint64_t value, int size) {
  for (int i = size - 1; i >= 0; --i) bytes += static_cast<char>(value >> 8 * i & 0xff);
}

void append_return(std::string& block, const RoundRoom& room, const Vlp16Recording& recording, double time, int ring,
                   bool is_strongest) {
  const double wall = room.horizontal_distance(recording.azimuth_at(time)) / std::cos(vlp16_elevation(ring));
  const bool is_glass = is_strongest && ring % 2 == 1;
  const double distance = is_glass ? wall / 2 : wall;
  append_little(block, distance > recording.unseen_beyond ? 0 : std::lround(distance / 0.002), 2);
  append_little(block, vlp16_intensity(ring), 1);
}

std::string data_block(const RoundRoom& room, const Vlp16Recording& recording, double time, bool is_strongest) {
  std::string block = "\xff\xee";
  const double degrees = recording.azimuth_at(time) * 180 / std::numbers::pi;
  append_little(block, static_cast<std::uint64_t>(std::lround(degrees * 100)) % 36000, 2);
  for (int firing = 0; firing < 2; ++firing) {
    for (int laser = 0; laser < 16; ++laser) {
      const double laser_time = time + firing * kFiringPeriod + laser * kLaserPeriod;
      append_return(block, room, recording, laser_time, kRingOfLaser[static_cast<std::size_t>(laser)], is_strongest);
    }
  }
  return block;
}

std::string data_packet(const RoundRoom& room, const Vlp16Recording& recording, double time) {
  std::string packet;
  for (int i = 0; i < 12; ++i) {
    const int block = recording.has_dual_returns ? i / 2 : i;
    const bool is_strongest = recording.has_dual_returns && i % 2 == 1;
    packet += data_block(room, recording, time + block * 2 * kFiringPeriod, is_strongest);
  }
  const auto microseconds = static_cast<std::uint64_t>(std::llround(time * 1e6));
  append_little(packet, (recording.start_us + microseconds) % 3'600'000'000, 4);
  append_little(packet, recording.has_dual_returns ? 0x39 : 0x37, 1);
  append_little(packet, recording.product, 1);
  return packet;
}

}  // namespace

double RoundRoom::horizontal_distance(double azimuth) const {
  const Eigen::Vector2d direction(std::cos(azimuth), -std::sin(azimuth));
  const double along = direction.dot(center);
  return along + std::sqrt(along * along + radius * radius - center.squaredNorm());
}

double Vlp16Recording::packet_period() const { return (has_dual_returns ? 12 : 24) * kFiringPeriod; }

double Vlp16Recording::azimuth_at(double time) const {
  return start_azimuth_deg * std::numbers::pi / 180 + 2 * std::numbers::pi * turns_per_second * time;
}

double vlp16_elevation(int ring) { return (-15 + 2 * ring) * std::numbers::pi / 180; }

double vlp16_vertical_offset(int ring) {
  constexpr std::array<double, 16> kMillimetres = {11.2, 9.7,  8.1,  6.6,  5.1,  3.7,  2.2,  0.7,
                                                   -0.7, -2.2, -3.7, -5.1, -6.6, -8.1, -9.7, -11.2};
  return kMillimetres[static_cast<std::size_t>(ring)] / 1000;
}

std::vector<std::string> vlp16_payloads(const RoundRoom& room, const Vlp16Recording& recording) {
  std::vector<std::string> payloads;
  for (int i = 0; i < recording.num_packets; ++i) {
    payloads.push_back(data_packet(room, recording, i * recording.packet_period()));
  }
  return payloads;
}

std::string ipv4_udp_packet(const std::string& payload, std::uint16_t port, std::uint8_t last_of_source) {
  std::string packet = "\x45";
  append_big(packet, 0, 1);
  append_big(packet, 28 + payload.size(), 2);
  append_big(packet, 0x00004000, 4);  // do not fragment
  append_big(packet, 0xff11, 2);      // time to live, UDP
  append_big(packet, 0, 2);
  append_big(packet, 0xc0a80100u + last_of_source, 4);
  append_big(packet, 0xffffffff, 4);
  append_big(packet, 443, 2);
  append_big(packet, port, 2);
  append_big(packet, 8 + payload.size(), 2);
  append_big(packet, 0, 2);
  return packet + payload;
}

std::string link_frame(int link_type, const std::string& ip_packet, int num_vlan_tags) {
  std::string header;
  if (link_type == 0) append_little(header, 2, 4);
  if (link_type == 108) append_big(header, 2, 4);
  if (link_type == 1) header.append(12, '\x60');
  if (link_type == 113) header.append(14, '\0');
  for (int i = 0; i < num_vlan_tags; ++i) append_big(header, 0x81000007, 4);
  if (link_type == 1 || link_type == 113 || link_type == 276) append_big(header, 0x0800, 2);
  if (link_type == 276) header.append(18, '\0');
  return header + ip_packet;
}

std::string pcap_file(int link_type, const std::vector<std::string>& frames, std::size_t snap_length) {
  std::string file;
  append_little(file, 0xa1b2c3d4, 4);
  append_little(file, 2, 2);
  append_little(file, 4, 2);
  append_little(file, 0, 8);
  append_little(file, snap_length, 4);
  append_little(file, static_cast<std::uint64_t>(link_type), 4);
  for (const std::string& frame : frames) {
    const std::string captured = frame.substr(0, std::min(frame.size(), snap_length));
    append_little(file, 0, 8);
    append_little(file, captured.size(), 4);
    append_little(file, frame.size(), 4);
    file += captured;
  }
  return file;
}

std::string ethernet_capture(const std::vector<std::string>& payloads) {
  std::vector<std::string> frames;
  for (const std::string& payload : payloads) frames.push_back(link_frame(1, ipv4_udp_packet(payload)));
  return pcap_file(1, frames);
}

}  // namespace vdbmap::test

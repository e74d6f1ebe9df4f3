// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace vdbmap::test {

/// A round room with the sensor anywhere in it: where each ray ends is known in closed form.
struct RoundRoom {
  Eigen::Vector2d center{1.0, -2.0};  ///< [m] of the room, seen from the sensor
  double radius = 8.0;                ///< [m]

  /// Horizontal distance to the wall [m] at an azimuth [rad] that runs clockwise from the x axis.
  double horizontal_distance(double azimuth) const;
};

/// How a VLP-16 was set up while it scanned the room.
struct Vlp16Recording {
  int num_packets = 1;
  double start_azimuth_deg = 0;
  double turns_per_second = 10;
  std::uint32_t start_us = 0;     ///< microseconds after the hour
  bool has_dual_returns = false;  ///< then odd rings see glass at half the distance, their strongest return
  std::uint8_t product = 0x22;
  double unseen_beyond = 1e9;  ///< [m] no return from farther away

  double packet_period() const;          ///< [s]
  double azimuth_at(double time) const;  ///< [rad] exact, `time` in seconds after the recording began
};

/// Elevation [rad] and height over the sensor's origin [m] of the lasers, lowest first, from the manual's table.
double vlp16_elevation(int ring);
double vlp16_vertical_offset(int ring);

/// The intensity that the packets give to a ring.
inline std::uint8_t vlp16_intensity(int ring) { return static_cast<std::uint8_t>(10 * ring + 5); }

/// The data packets as UDP payloads of 1206 bytes.
std::vector<std::string> vlp16_payloads(const RoundRoom& room, const Vlp16Recording& recording);

/// An IPv4 packet with one UDP datagram.
std::string ipv4_udp_packet(const std::string& payload, std::uint16_t port = 2368, std::uint8_t last_of_source = 201);

/// The packet in the frame of a link layer (pcap's numbers: 0, 1, 101, 108, 113, 276); num_vlan_tags for Ethernet.
std::string link_frame(int link_type, const std::string& ip_packet, int num_vlan_tags = 0);

/// A pcap file of frames that were cut off after `snap_length` bytes.
std::string pcap_file(int link_type, const std::vector<std::string>& frames, std::size_t snap_length = 65535);

/// A pcap file of payloads over Ethernet to port 2368.
std::string ethernet_capture(const std::vector<std::string>& payloads);

}  // namespace vdbmap::test

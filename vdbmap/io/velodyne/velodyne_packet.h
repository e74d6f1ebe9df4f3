// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace vdbmap {

/// Size of the UDP payload of a data packet; position packets have 512 [bytes].
constexpr std::size_t kVelodynePacketSize = 1206;

using VelodynePayload = std::span<const std::uint8_t, kVelodynePacketSize>;

/// One echo of one laser.
struct VelodyneReturn {
  Eigen::Vector3d point_in_lidar;   ///< [m] x forward, y left, z up
  float intensity = 0;              ///< calibrated reflectivity, 0..255
  double seconds_after_packet = 0;  ///< [s] from the packet's timestamp to the firing
  std::uint16_t ring = 0;           ///< lasers numbered by vertical angle, the lowest is 0
  std::size_t block = 0;            ///< data block in the packet; in dual return mode the first of its pair
};

/// Data blocks of a packet.
constexpr std::size_t kVelodyneBlocks = 12;

/// Whether a payload is a data packet of a Velodyne sensor at all: it begins with a data block's flag.
bool is_velodyne_packet(VelodynePayload payload);

/// The number by which the sensor names itself.
std::uint8_t velodyne_product(VelodynePayload payload);

/// Whether the sensors of a product can be decoded.
bool is_supported_velodyne(std::uint8_t product);

/// "VLP-16", and for others "product id 0x63" or what is known of it.
std::string velodyne_name(std::uint8_t product);

/// Why a data packet cannot be decoded (sensor not supported, damaged block); nothing where it can.
std::optional<std::string> velodyne_packet_defect(VelodynePayload payload);

/// Time of the packet's first firing [microseconds after the hour].
std::uint32_t velodyne_timestamp_us(VelodynePayload payload);

/// Azimuth of a data block, clockwise seen from above [0.01 deg].
std::uint16_t velodyne_azimuth(VelodynePayload payload, std::size_t block);

/// Appends the returns of a packet without defect in the order of their firing. In dual return mode a firing's last
/// return comes before its strongest, and the second is left out where both are the same.
void decode_velodyne_packet(VelodynePayload payload, std::vector<VelodyneReturn>& returns);

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/velodyne/velodyne_packet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace vdbmap {
namespace {

// VLP-16 User Manual 63-9243 Rev. E, section 9.3.2; the HDL-32E (63-9113) shares the layout.
constexpr std::size_t kFiringBlockSize = 100;
constexpr std::size_t kChannelsPerBlock = 32;
constexpr std::size_t kTimestampAt = 1200;
constexpr std::size_t kReturnModeAt = 1204;
constexpr std::size_t kProductAt = 1205;
constexpr std::uint16_t kBlockFlag = 0xeeff;
constexpr int kFullTurn = 36000;         // [0.01 deg]
constexpr double kDistanceUnit = 0.002;  // [m]
constexpr std::uint8_t kDualReturn = 0x39;

struct Laser {
  double cos_elevation = 1;
  double sin_elevation = 0;
  double vertical_offset = 0;  // [m] of the laser above the sensor's origin
  std::uint16_t ring = 0;
};

struct Sensor {
  std::size_t lasers = 16;        // a multiple of 16; kChannelsPerBlock / lasers firings share a block
  double laser_period = 0;        // [s] from one laser to the next
  double firing_period = 0;       // [s] from one firing of all lasers to the next
  std::array<Laser, 32> laser{};  // in the order of firing
};

// 16 lasers that alternate between the lower half, bottom first, and the upper half (table 9-1 of the VLP-16 manual).
// `offsets_mm` belong to the lower half and mirror in the upper.
Sensor sensor_with_16_lasers(double lowest_deg, double step_deg, const std::array<double, 8>& offsets_mm) {
  Sensor sensor{16, 2.304e-6, 55.296e-6, {}};
  for (std::uint16_t i = 0; i < 16; ++i) {
    const auto ring = static_cast<std::uint16_t>(i / 2 + (i % 2) * 8);
    const double elevation = (lowest_deg + step_deg * ring) * std::numbers::pi / 180;
    const double offset_mm = ring < 8 ? offsets_mm[ring] : -offsets_mm[15u - ring];
    sensor.laser[i] = {std::cos(elevation), std::sin(elevation), offset_mm / 1000, ring};
  }
  return sensor;
}

// HDL-32E: -92/3 to 32/3 degrees in steps of 4/3, lower and upper half in turn.
Sensor sensor_with_32_lasers() {
  Sensor sensor{32, 1.152e-6, 46.08e-6, {}};
  for (std::uint16_t i = 0; i < 32; ++i) {
    const auto ring = static_cast<std::uint16_t>(i / 2 + (i % 2) * 16);
    const double elevation = (-92.0 + 4.0 * ring) / 3 * std::numbers::pi / 180;
    sensor.laser[i] = {std::cos(elevation), std::sin(elevation), 0, ring};
  }
  return sensor;
}

// The sensor of a product id (table 9-2), nothing where its geometry is not known here.
const Sensor* find_sensor(std::uint8_t product) {
  static const Sensor vlp16 = sensor_with_16_lasers(-15, 2, {11.2, 9.7, 8.1, 6.6, 5.1, 3.7, 2.2, 0.7});
  static const Sensor puck_hi_res = sensor_with_16_lasers(-10, 4.0 / 3, {7.4, 6.5, 5.5, 4.6, 3.7, 2.7, 1.8, 0.9});
  static const Sensor hdl32 = sensor_with_32_lasers();
  switch (product) {
    case 0x21:
      return &hdl32;
    case 0x22:
      return &vlp16;
    case 0x24:
      return &puck_hi_res;
    default:
      return nullptr;
  }
}

std::uint16_t little_endian_16(VelodynePayload payload, std::size_t at) {
  return static_cast<std::uint16_t>(payload[at] | payload[at + 1] << 8);
}

std::uint16_t block_flag(VelodynePayload payload, std::size_t block) {
  return little_endian_16(payload, block * kFiringBlockSize);
}

// How far the sensor turned from each block to the next that was fired after it [0.01 deg].
std::vector<int> azimuth_steps(VelodynePayload payload, std::size_t blocks_per_firing) {
  std::vector<int> steps;
  for (std::size_t block = 0; block + blocks_per_firing < kVelodyneBlocks; block += blocks_per_firing) {
    const int step = velodyne_azimuth(payload, block + blocks_per_firing) - velodyne_azimuth(payload, block);
    steps.push_back((step + kFullTurn) % kFullTurn);
  }

  std::vector<int> sorted = steps;
  std::sort(sorted.begin(), sorted.end());
  const int median = sorted[sorted.size() / 2];
  // A sensor told to look in one sector only jumps from its end to its start: no measure of its speed.
  for (int& step : steps) {
    if (step > 2 * median) step = median;
  }
  steps.push_back(median);  // the block after the last one is in the next packet
  return steps;
}

// How far the sensor turned from the first data block to the last [0.01 deg]. It turns one way, so that one azimuth
// which is wrong costs a whole turn, but a sensor at rest trembles.
int turn_of_blocks(VelodynePayload payload) {
  constexpr int kTremor = 20;  // [0.01 deg]
  int turn = 0;
  for (std::size_t block = 1; block < kVelodyneBlocks; ++block) {
    const int step = velodyne_azimuth(payload, block) - velodyne_azimuth(payload, block - 1);
    const bool is_tremor = step < 0 && step >= -kTremor;
    turn += is_tremor ? step : (step + kFullTurn) % kFullTurn;
  }
  return turn;
}

struct Echo {
  std::uint16_t distance = 0;  // [kDistanceUnit], 0 where nothing came back
  std::uint8_t intensity = 0;

  bool operator==(const Echo&) const = default;
};

Echo echo(VelodynePayload payload, std::size_t block, std::size_t channel) {
  const std::size_t at = block * kFiringBlockSize + 4 + 3 * channel;
  return {little_endian_16(payload, at), payload[at + 2]};
}

Eigen::Vector3d point_in_lidar(const Laser& laser, double distance, double azimuth) {
  const double horizontal = distance * laser.cos_elevation;
  return {horizontal * std::cos(azimuth), -horizontal * std::sin(azimuth),
          distance * laser.sin_elevation + laser.vertical_offset};
}

// One block, or the two of the same firings in dual return mode.
struct BlockGroup {
  std::size_t first = 0;
  std::size_t size = 1;
  double azimuth_step = 0;         // [0.01 deg] during the group's firings
  std::size_t firings_before = 0;  // in the packet
};

void decode_group(VelodynePayload payload, const Sensor& sensor, const BlockGroup& group,
                  std::vector<VelodyneReturn>& returns) {
  const std::uint16_t start_azimuth = velodyne_azimuth(payload, group.first);
  const double firings_per_block = static_cast<double>(kChannelsPerBlock / sensor.lasers);
  for (std::size_t channel = 0; channel < kChannelsPerBlock; ++channel) {
    const Laser& laser = sensor.laser[channel % sensor.lasers];
    const double seconds = static_cast<double>(channel / sensor.lasers) * sensor.firing_period +
                           static_cast<double>(channel % sensor.lasers) * sensor.laser_period;
    const double azimuth = (start_azimuth + group.azimuth_step * seconds / (firings_per_block * sensor.firing_period)) *
                           2 * std::numbers::pi / kFullTurn;

    for (std::size_t i = 0; i < group.size; ++i) {
      const Echo received = echo(payload, group.first + i, channel);
      if (received.distance == 0) continue;
      if (i > 0 && received == echo(payload, group.first, channel)) continue;
      returns.push_back(
          {point_in_lidar(laser, received.distance * kDistanceUnit, azimuth), static_cast<float>(received.intensity),
           static_cast<double>(group.firings_before) * sensor.firing_period + seconds, laser.ring, group.first});
    }
  }
}

}  // namespace

bool is_velodyne_packet(VelodynePayload payload) { return block_flag(payload, 0) == kBlockFlag; }

std::uint8_t velodyne_product(VelodynePayload payload) { return payload[kProductAt]; }

bool is_supported_velodyne(std::uint8_t product) { return find_sensor(product) != nullptr; }

std::string velodyne_name(std::uint8_t product) {
  std::array<char, 8> hexadecimal{};
  std::snprintf(hexadecimal.data(), hexadecimal.size(), "0x%02x", static_cast<unsigned>(product));
  const std::string id = "product id " + std::string(hexadecimal.data());
  if (product == 0x21) return "HDL-32E";
  if (product == 0x22) return "VLP-16";
  if (product == 0x24) return "Puck Hi-Res";
  if (product == 0x28) return "VLP-32C (" + id + ")";
  if (product == 0x31) return "Velarray (" + id + ")";
  if (product == 0x63 || product == 0xa1) return "VLS-128 (" + id + ")";
  return id;
}

std::optional<std::string> velodyne_packet_defect(VelodynePayload payload) {
  if (!is_supported_velodyne(velodyne_product(payload))) {
    return "sensor " + velodyne_name(velodyne_product(payload)) +
           " is not supported, only VLP-16, Puck Hi-Res and HDL-32E";
  }
  const std::uint8_t mode = payload[kReturnModeAt];
  if (mode < 0x37 || mode > kDualReturn) {
    return "return mode " + std::to_string(mode) + ", expected 55 (strongest), 56 (last) or 57 (dual)";
  }
  for (std::size_t block = 0; block < kVelodyneBlocks; ++block) {
    if (block_flag(payload, block) != kBlockFlag) return "data block " + std::to_string(block) + " lacks its flag";
    if (velodyne_azimuth(payload, block) >= kFullTurn) {
      return "azimuth " + std::to_string(velodyne_azimuth(payload, block)) + " of data block " + std::to_string(block) +
             ", expected 0..35999";
    }
  }
  if (turn_of_blocks(payload) >= kFullTurn) return "the azimuths of its data blocks do not rise";
  return std::nullopt;
}

std::uint32_t velodyne_timestamp_us(VelodynePayload payload) {
  return little_endian_16(payload, kTimestampAt) |
         static_cast<std::uint32_t>(little_endian_16(payload, kTimestampAt + 2)) << 16;
}

std::uint16_t velodyne_azimuth(VelodynePayload payload, std::size_t block) {
  return little_endian_16(payload, block * kFiringBlockSize + 2);
}

void decode_velodyne_packet(VelodynePayload payload, std::vector<VelodyneReturn>& returns) {
  const Sensor& sensor = *find_sensor(payload[kProductAt]);
  const std::size_t blocks_per_firing = payload[kReturnModeAt] == kDualReturn ? 2 : 1;
  const std::vector<int> steps = azimuth_steps(payload, blocks_per_firing);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const BlockGroup group{i * blocks_per_firing, blocks_per_firing, static_cast<double>(steps[i]),
                           i * (kChannelsPerBlock / sensor.lasers)};
    decode_group(payload, sensor, group, returns);
  }
}

}  // namespace vdbmap

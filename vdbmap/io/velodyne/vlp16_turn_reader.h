// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vdbmap/core/point_cloud.h"
#include "vdbmap/io/file/read_finding.h"
#include "vdbmap/io/points/sensor_choice.h"
#include "vdbmap/io/velodyne/udp_capture.h"
#include "vdbmap/io/velodyne/velodyne_packet.h"
#include "vdbmap/io/velodyne/velodyne_sensors.h"

namespace vdbmap {

/// A packet of a capture that waits for the next one.
struct HeldPacket {
  std::array<std::uint8_t, kVelodynePacketSize> payload{};
  std::uint64_t number = 0;  ///< of the packet in the file
};

/// The turns of a Velodyne capture one after the other, as vlp16_pcap.h describes them; only the current one is in
/// memory.
class Vlp16TurnReader {
 public:
  /// Throws IoError where the file is no capture, or holds no data packets of a sensor that is meant.
  explicit Vlp16TurnReader(const std::filesystem::path& path, const std::optional<SensorChoice>& sensor = {});

  /// The next turn that has points, nothing at the end. Packets that are damaged are left out, and so is what follows
  /// where the file itself is. Throws IoError at the end of a capture without points, with the first damage where there
  /// was any.
  std::optional<PointCloud> next();

  /// What was noticed since the last call.
  std::vector<ReadFinding> take_findings();

 private:
  // Continues microseconds after the hour over the hour's end.
  class HourClock {
   public:
    double seconds(std::uint32_t microseconds_after_hour);

   private:
    std::int64_t latest_ = 0;         // [us]
    std::int64_t start_of_hour_ = 0;  // [us]
  };

  // The packet read last, whose time stamp the next one tells to be right.
  bool read_packet();
  void hold(VelodynePayload payload);
  void decode_held(std::optional<std::uint32_t> next_time_us);
  void note_end();
  void note_damage(const ReadFinding& finding);
  [[noreturn]] void fail_without_points() const;
  std::array<std::uint64_t, kVelodyneBlocks> turns_of_blocks(VelodynePayload payload);
  void decode(VelodynePayload payload);
  void add(const VelodyneReturn& received, double packet_time, std::uint64_t turn);

  std::filesystem::path path_;
  VelodyneSensor sensor_;
  UdpCapture capture_;
  HourClock clock_;
  std::optional<HeldPacket> held_;
  std::optional<std::uint32_t> latest_time_us_;  // after the hour, of the packet decoded last
  int latest_azimuth_ = 0;                       // [0.01 deg]
  std::uint64_t latest_turn_ = 0;
  std::uint64_t current_turn_ = 0;       // that of the last point
  std::vector<VelodyneReturn> returns_;  // of one packet
  PointCloud current_;
  std::deque<PointCloud> finished_;  // a packet may end more than one
  bool has_points_ = false;
  bool has_ended_ = false;
  std::string first_damage_;
  std::vector<ReadFinding> findings_;
};

}  // namespace vdbmap

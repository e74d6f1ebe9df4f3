// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vlp16_pcap.h"

#include <array>
#include <optional>
#include <string>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/io/udp_capture.h"
#include "vdbmap/io/velodyne_packet.h"

namespace vdbmap {
namespace {

constexpr std::uint16_t kUsualPort = 2368;
// [0.01 deg] An azimuth that falls by less is a packet that came late, not a new turn.
constexpr int kLeastFallOfNewTurn = 2000;

// Continues microseconds after the hour over the hour's end.
class HourClock {
 public:
  double seconds(std::uint32_t microseconds_after_hour) {
    constexpr std::int64_t kHour = 3'600'000'000;
    const std::int64_t now = microseconds_after_hour;
    if (now + kHour / 2 < latest_) start_of_hour_ += kHour;
    latest_ = now;
    return static_cast<double>(start_of_hour_ + now) * 1e-6;
  }

 private:
  std::int64_t latest_ = 0;         // [us]
  std::int64_t start_of_hour_ = 0;  // [us]
};

struct Source {
  std::uint32_t address = 0;
  std::uint16_t port = 0;

  bool operator==(const Source&) const = default;
};

struct Recording {
  PointCloud cloud;
  std::vector<std::size_t> turn_starts;  // indices of points
};

class RecordingDecoder {
 public:
  // Whether packets of this source are wanted; a better source than the one so far makes it start anew.
  bool accept(const Source& source) {
    const bool is_better = source_ && source.port == kUsualPort && source_->port != kUsualPort;
    if (is_better) *this = RecordingDecoder();
    if (!source_) source_ = source;
    return source == *source_;
  }

  void add(VelodynePayload payload) {
    const std::array<std::uint64_t, kVelodyneBlocks> turns = turns_of_blocks(payload);
    const double packet_time = clock_.seconds(velodyne_timestamp_us(payload));
    returns_.clear();
    decode_velodyne_packet(payload, returns_);
    for (const VelodyneReturn& received : returns_) add(received, packet_time, turns[received.block]);
  }

  Recording& recording() { return recording_; }

 private:
  std::array<std::uint64_t, kVelodyneBlocks> turns_of_blocks(VelodynePayload payload) {
    std::array<std::uint64_t, kVelodyneBlocks> turns{};
    for (std::size_t block = 0; block < kVelodyneBlocks; ++block) {
      const int azimuth = velodyne_azimuth(payload, block);
      if (azimuth + kLeastFallOfNewTurn < latest_azimuth_) ++latest_turn_;
      latest_azimuth_ = azimuth;
      turns[block] = latest_turn_;
    }
    return turns;
  }

  void add(const VelodyneReturn& received, double packet_time, std::uint64_t turn) {
    PointCloud& cloud = recording_.cloud;
    if (cloud.empty() || turn != turn_of_last_point_) recording_.turn_starts.push_back(cloud.size());
    turn_of_last_point_ = turn;

    cloud.positions.push_back(received.point_in_lidar);
    cloud.intensities.push_back(received.intensity);
    cloud.times.push_back(packet_time + received.seconds_after_packet);
    cloud.rings.push_back(received.ring);
  }

  std::optional<Source> source_;
  HourClock clock_;
  int latest_azimuth_ = 0;  // [0.01 deg]
  std::uint64_t latest_turn_ = 0;
  std::uint64_t turn_of_last_point_ = 0;
  std::vector<VelodyneReturn> returns_;
  Recording recording_;
};

Recording read_recording(const std::filesystem::path& path) {
  UdpCapture capture(path);
  RecordingDecoder decoder;
  while (const auto datagram = capture.next()) {
    if (datagram->full_size != kVelodynePacketSize) continue;
    const std::string place = "packet " + std::to_string(capture.packet_number()) + ": ";
    if (datagram->payload.size() < kVelodynePacketSize) {
      throw IoError::malformed(
          path, place + "only " + std::to_string(datagram->payload.size()) + " of 1206 bytes were captured");
    }
    const VelodynePayload payload = datagram->payload.first<kVelodynePacketSize>();
    if (!is_velodyne_packet(payload) || !decoder.accept({datagram->source_address, datagram->destination_port}))
      continue;

    if (const auto defect = velodyne_packet_defect(payload)) throw IoError::malformed(path, place + *defect);
    decoder.add(payload);
  }

  if (decoder.recording().cloud.empty()) {
    throw IoError::malformed(path, "holds no points: no returns in Velodyne data packets among " +
                                       std::to_string(capture.packet_number()) + " packets");
  }
  return std::move(decoder.recording());
}

PointCloud slice(const PointCloud& cloud, std::size_t begin, std::size_t end) {
  const auto part = [&](const auto& values) {
    using Difference = std::ptrdiff_t;
    return std::decay_t<decltype(values)>(values.begin() + static_cast<Difference>(begin),
                                          values.begin() + static_cast<Difference>(end));
  };
  PointCloud turn;
  turn.positions = part(cloud.positions);
  turn.intensities = part(cloud.intensities);
  turn.times = part(cloud.times);
  turn.rings = part(cloud.rings);
  return turn;
}

}  // namespace

ReadResult read_vlp16_pcap(const std::filesystem::path& path) {
  ReadResult result;
  result.cloud = std::move(read_recording(path).cloud);
  return result;
}

std::vector<PointCloud> read_vlp16_scans(const std::filesystem::path& path) {
  const Recording recording = read_recording(path);
  std::vector<PointCloud> scans;
  for (std::size_t i = 0; i < recording.turn_starts.size(); ++i) {
    const bool is_last = i + 1 == recording.turn_starts.size();
    const std::size_t end = is_last ? recording.cloud.size() : recording.turn_starts[i + 1];
    scans.push_back(slice(recording.cloud, recording.turn_starts[i], end));
  }
  return scans;
}

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vlp16_turn_reader.h"

#include <string>
#include <utility>

#include "vdbmap/core/error.h"

namespace vdbmap {
namespace {

constexpr std::uint16_t kUsualPort = 2368;
// [0.01 deg] An azimuth that falls by less is a packet that came late, not a new turn.
constexpr int kLeastFallOfNewTurn = 2000;

struct VelodynePacket {
  UdpSource source;
  VelodynePayload payload;
};

std::string place_in(const UdpCapture& capture) { return "packet " + std::to_string(capture.packet_number()) + ": "; }

// The next data packet of any Velodyne sensor, nothing at the end.
std::optional<VelodynePacket> next_packet(UdpCapture& capture, const std::filesystem::path& path) {
  while (const auto datagram = capture.next()) {
    if (datagram->full_size != kVelodynePacketSize) continue;
    if (datagram->payload.size() < kVelodynePacketSize) {
      throw IoError::malformed(path, place_in(capture) + "only " + std::to_string(datagram->payload.size()) +
                                         " of 1206 bytes were captured");
    }
    const VelodynePayload payload = datagram->payload.first<kVelodynePacketSize>();
    if (is_velodyne_packet(payload)) return VelodynePacket{datagram->source, payload};
  }
  return std::nullopt;
}

IoError no_points(const std::filesystem::path& path, const UdpCapture& capture) {
  return IoError::malformed(path, "holds no points: no returns in Velodyne data packets among " +
                                      std::to_string(capture.packet_number()) + " packets");
}

// The first sensor on the usual port, else the first.
UdpSource choose_sensor(const std::filesystem::path& path) {
  UdpCapture capture(path);
  std::optional<UdpSource> first;
  while (const auto packet = next_packet(capture, path)) {
    if (packet->source.destination_port == kUsualPort) return packet->source;
    if (!first) first = packet->source;
  }
  if (!first) throw no_points(path, capture);
  return *first;
}

}  // namespace

double Vlp16TurnReader::HourClock::seconds(std::uint32_t microseconds_after_hour) {
  constexpr std::int64_t kHour = 3'600'000'000;
  const std::int64_t now = microseconds_after_hour;
  if (now + kHour / 2 < latest_) start_of_hour_ += kHour;
  latest_ = now;
  return static_cast<double>(start_of_hour_ + now) * 1e-6;
}

Vlp16TurnReader::Vlp16TurnReader(const std::filesystem::path& path)
    : path_(path), sensor_(choose_sensor(path)), capture_(path) {}

std::optional<PointCloud> Vlp16TurnReader::next() {
  while (finished_.empty() && read_packet()) {
  }
  if (finished_.empty() && !current_.empty()) finished_.push_back(std::exchange(current_, {}));
  if (finished_.empty()) {
    if (!has_points_) throw no_points(path_, capture_);
    return std::nullopt;
  }
  PointCloud turn = std::move(finished_.front());
  finished_.pop_front();
  return turn;
}

// False at the end of the capture.
bool Vlp16TurnReader::read_packet() {
  const auto packet = next_packet(capture_, path_);
  if (!packet) return false;
  if (packet->source != sensor_) return true;
  if (const auto defect = velodyne_packet_defect(packet->payload)) {
    throw IoError::malformed(path_, place_in(capture_) + *defect);
  }
  decode(packet->payload);
  return true;
}

std::array<std::uint64_t, kVelodyneBlocks> Vlp16TurnReader::turns_of_blocks(VelodynePayload payload) {
  std::array<std::uint64_t, kVelodyneBlocks> turns{};
  for (std::size_t block = 0; block < kVelodyneBlocks; ++block) {
    const int azimuth = velodyne_azimuth(payload, block);
    if (azimuth + kLeastFallOfNewTurn < latest_azimuth_) ++latest_turn_;
    latest_azimuth_ = azimuth;
    turns[block] = latest_turn_;
  }
  return turns;
}

void Vlp16TurnReader::decode(VelodynePayload payload) {
  const std::array<std::uint64_t, kVelodyneBlocks> turns = turns_of_blocks(payload);
  const double packet_time = clock_.seconds(velodyne_timestamp_us(payload));
  returns_.clear();
  decode_velodyne_packet(payload, returns_);
  for (const VelodyneReturn& received : returns_) add(received, packet_time, turns[received.block]);
}

void Vlp16TurnReader::add(const VelodyneReturn& received, double packet_time, std::uint64_t turn) {
  if (!current_.empty() && turn != current_turn_) finished_.push_back(std::exchange(current_, {}));
  current_turn_ = turn;
  has_points_ = true;

  current_.positions.push_back(received.point_in_lidar);
  current_.intensities.push_back(received.intensity);
  current_.times.push_back(packet_time + received.seconds_after_packet);
  current_.rings.push_back(received.ring);
}

}  // namespace vdbmap

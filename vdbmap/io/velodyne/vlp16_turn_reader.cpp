// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/velodyne/vlp16_turn_reader.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>

#include "vdbmap/core/error.h"

namespace vdbmap {
namespace {

constexpr std::int64_t kHour = 3'600'000'000;  // [us]

// [0.01 deg] An azimuth that falls by less is a packet that came late, not a new turn.
constexpr int kLeastFallOfNewTurn = 2000;

constexpr std::size_t kPositionPacketSize = 512;  // [bytes]

// The sensor that is meant among those of the capture.
VelodyneSensor meant_sensor(const std::filesystem::path& path, const std::vector<VelodyneSensor>& sensors,
                            const std::optional<SensorChoice>& choice) {
  const auto sensor = choose_sensor(sensors, choice);
  if (sensor) return *sensor;
  if (sensors.empty()) return {};
  std::string known;
  for (const VelodyneSensor& other : sensors) {
    known += (known.empty() ? "" : ", ") + text_of(choice_of(other, sensors));
  }
  throw IoError::malformed(path, "no sensor at " + text_of(*choice) + ", only " + known);
}

// Why a datagram of the sensor cannot be decoded, nothing where it can.
std::optional<std::string> datagram_defect(const UdpDatagram& datagram) {
  if (datagram.full_size != kVelodynePacketSize) {
    return std::to_string(datagram.full_size) + " bytes, expected " + std::to_string(kVelodynePacketSize);
  }
  if (datagram.payload.size() < kVelodynePacketSize) {
    return "only " + std::to_string(datagram.payload.size()) + " of 1206 bytes were captured";
  }
  return velodyne_packet_defect(datagram.payload.first<kVelodynePacketSize>());
}

// Of two time stamps after the hour, whichever hour [us].
std::int64_t time_between(std::int64_t a, std::int64_t b) {
  const std::int64_t difference = std::abs(a - b);
  return std::min(difference, std::abs(kHour - difference));
}

// Whether the packets before and after one belong together, and it does not to them.
bool stands_alone(std::uint32_t before_us, std::uint32_t time_us, std::uint32_t after_us) {
  constexpr std::int64_t kSecond = 1'000'000;  // [us] hundreds of packets
  return time_between(before_us, after_us) < kSecond && time_between(before_us, time_us) > kSecond &&
         time_between(time_us, after_us) > kSecond;
}

}  // namespace

double Vlp16TurnReader::HourClock::seconds(std::uint32_t microseconds_after_hour) {
  const std::int64_t now = microseconds_after_hour;
  if (now + kHour / 2 < latest_) start_of_hour_ += kHour;
  latest_ = now;
  return static_cast<double>(start_of_hour_ + now) * 1e-6;
}

Vlp16TurnReader::Vlp16TurnReader(const std::filesystem::path& path, const std::optional<SensorChoice>& sensor)
    : path_(path), capture_(path) {
  const std::vector<VelodyneSensor> sensors = list_velodyne_sensors(path);
  sensor_ = meant_sensor(path, sensors, sensor);
  if (!sensor) findings_ = findings_of_others(sensors, sensor_);
}

std::vector<ReadFinding> Vlp16TurnReader::take_findings() { return std::exchange(findings_, {}); }

std::optional<PointCloud> Vlp16TurnReader::next() {
  while (finished_.empty() && read_packet()) {
  }
  if (finished_.empty() && !current_.empty()) finished_.push_back(std::exchange(current_, {}));
  if (finished_.empty()) {
    if (!has_points_) fail_without_points();
    return std::nullopt;
  }
  PointCloud turn = std::move(finished_.front());
  finished_.pop_front();
  return turn;
}

// False at the end of the capture.
bool Vlp16TurnReader::read_packet() {
  const auto datagram = capture_.next();
  if (!datagram) {
    note_end();
    return false;
  }
  if (datagram->source != sensor_.source || datagram->full_size == kPositionPacketSize) return true;
  if (const auto defect = datagram_defect(*datagram)) {
    note_damage({"damaged data packets left out", 1,
                 "packet " + std::to_string(capture_.packet_number()) + ": " + *defect, true});
    return true;
  }
  const VelodynePayload payload = datagram->payload.first<kVelodynePacketSize>();
  if (velodyne_product(payload) == sensor_.product) hold(payload);
  return true;
}

void Vlp16TurnReader::hold(VelodynePayload payload) {
  decode_held(velodyne_timestamp_us(payload));
  held_ = HeldPacket{{}, capture_.packet_number()};
  std::ranges::copy(payload, held_->payload.begin());
}

// One wrong time would shift all that follow, as if an hour had passed.
void Vlp16TurnReader::decode_held(std::optional<std::uint32_t> next_time_us) {
  if (!held_) return;
  const VelodynePayload payload(held_->payload);
  const std::uint32_t time_us = velodyne_timestamp_us(payload);
  if (latest_time_us_ && next_time_us && stands_alone(*latest_time_us_, time_us, *next_time_us)) {
    note_damage({"damaged data packets left out", 1,
                 "packet " + std::to_string(held_->number) + ": time stamp " + std::to_string(time_us) +
                     " us, expected about " + std::to_string(*next_time_us),
                 true});
  } else {
    decode(payload);
    latest_time_us_ = time_us;
  }
  held_.reset();
}

void Vlp16TurnReader::note_end() {
  if (has_ended_) return;
  has_ended_ = true;
  decode_held(std::nullopt);
  if (!capture_.damage().empty()) {
    note_damage({"the capture is cut off or damaged, its rest is left out", 0, capture_.damage(), true});
  }
}

void Vlp16TurnReader::note_damage(const ReadFinding& finding) {
  if (first_damage_.empty()) first_damage_ = finding.first;
  add_finding(findings_, finding);
}

void Vlp16TurnReader::fail_without_points() const {
  if (!first_damage_.empty()) throw IoError::malformed(path_, first_damage_);
  throw IoError::malformed(path_, "holds no points: no returns in Velodyne data packets among " +
                                      std::to_string(capture_.packet_number()) + " packets");
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

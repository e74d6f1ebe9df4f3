// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/velodyne/velodyne_sensors.h"

#include <algorithm>

#include "vdbmap/io/velodyne/velodyne_packet.h"

namespace vdbmap {
namespace {

constexpr std::uint16_t kUsualPort = 2368;

// The product that a datagram names, 0 where it is cut off; nothing where it is no data packet.
std::optional<std::uint8_t> product_of(const UdpDatagram& datagram) {
  if (datagram.full_size != kVelodynePacketSize) return std::nullopt;
  if (datagram.payload.size() < kVelodynePacketSize) return std::uint8_t{0};
  const VelodynePayload payload = datagram.payload.first<kVelodynePacketSize>();
  return is_velodyne_packet(payload) ? std::optional(velodyne_product(payload)) : std::nullopt;
}

// Numbers that stand for no sensor known here are one: damaged packets have any.
bool is_of(const VelodyneSensor& sensor, const UdpSource& source, std::uint8_t product) {
  const bool is_unknown = !is_supported_velodyne(sensor.product) && !is_supported_velodyne(product);
  return sensor.source == source && (sensor.product == product || is_unknown);
}

void count_packet(std::vector<VelodyneSensor>& sensors, const UdpSource& source, std::uint8_t product) {
  auto sensor = std::ranges::find_if(sensors, [&](const auto& known) { return is_of(known, source, product); });
  if (sensor == sensors.end()) sensor = sensors.insert(sensor, {source, product, 0});
  ++sensor->num_packets;
}

bool is_meant_by(const VelodyneSensor& sensor, const SensorChoice& choice) {
  return sensor.source.address == choice.address &&
         choice.port.value_or(sensor.source.destination_port) == sensor.source.destination_port &&
         choice.product.value_or(sensor.product) == sensor.product;
}

int preference(const VelodyneSensor& sensor) {
  return (is_supported_velodyne(sensor.product) ? 0 : 2) + (sensor.source.destination_port == kUsualPort ? 0 : 1);
}

}  // namespace

std::vector<VelodyneSensor> list_velodyne_sensors(const std::filesystem::path& path) {
  UdpCapture capture(path);
  std::vector<VelodyneSensor> sensors;
  while (const auto datagram = capture.next()) {
    if (const auto product = product_of(*datagram)) count_packet(sensors, datagram->source, *product);
  }
  const std::vector<VelodyneSensor> all = sensors;
  std::erase_if(sensors, [&](const VelodyneSensor& sensor) {
    return !is_supported_velodyne(sensor.product) && std::ranges::any_of(all, [&](const VelodyneSensor& other) {
      return other.source == sensor.source && is_supported_velodyne(other.product);
    });
  });
  return sensors;
}

std::optional<VelodyneSensor> choose_sensor(const std::vector<VelodyneSensor>& sensors,
                                            const std::optional<SensorChoice>& choice) {
  std::optional<VelodyneSensor> best;
  for (const VelodyneSensor& sensor : sensors) {
    if (choice && !is_meant_by(sensor, *choice)) continue;
    if (!best || preference(sensor) < preference(*best)) best = sensor;
  }
  return best;
}

SensorChoice choice_of(const VelodyneSensor& sensor, const std::vector<VelodyneSensor>& sensors) {
  const auto num_alike = std::ranges::count(sensors, sensor.source, &VelodyneSensor::source);
  return {sensor.source.address, sensor.source.destination_port,
          num_alike > 1 ? std::optional(sensor.product) : std::nullopt};
}

std::vector<ReadFinding> findings_of_others(const std::vector<VelodyneSensor>& sensors, const VelodyneSensor& chosen) {
  std::vector<ReadFinding> findings;
  for (const VelodyneSensor& sensor : sensors) {
    if (sensor == chosen) continue;
    const std::string place = text_of(choice_of(sensor, sensors));
    findings.push_back({"a second sensor at " + place + " is left out: --sensor " + place + " chooses it", 0,
                        velodyne_name(sensor.product) + ", " + std::to_string(sensor.num_packets) + " data packets"});
  }
  return findings;
}

}  // namespace vdbmap

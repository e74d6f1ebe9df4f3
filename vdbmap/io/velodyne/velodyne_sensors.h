// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vdbmap/io/file/read_finding.h"
#include "vdbmap/io/points/sensor_choice.h"
#include "vdbmap/io/velodyne/udp_capture.h"

namespace vdbmap {

/// A sensor in a capture: what one product sends from one address to one port. All that is sent from there and has no
/// known product, as damaged packets have none, belongs to it.
struct VelodyneSensor {
  UdpSource source;
  std::uint8_t product = 0;  ///< 0 where none of its packets was captured whole
  std::size_t num_packets = 0;

  bool operator==(const VelodyneSensor&) const = default;
};

/// The sensors of a capture, each in the place of its first packet. Throws IoError where it cannot be opened.
std::vector<VelodyneSensor> list_velodyne_sensors(const std::filesystem::path& capture);

/// The first of those that the choice means which can be decoded, before others one on the usual port 2368. Nothing
/// where there is none.
std::optional<VelodyneSensor> choose_sensor(const std::vector<VelodyneSensor>& sensors,
                                            const std::optional<SensorChoice>& choice);

/// The choice that means this sensor among others.
SensorChoice choice_of(const VelodyneSensor& sensor, const std::vector<VelodyneSensor>& sensors);

/// One finding for each of the other sensors: "a second sensor at 192.168.1.202:2368 is left out: ...".
std::vector<ReadFinding> findings_of_others(const std::vector<VelodyneSensor>& sensors, const VelodyneSensor& chosen);

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/velodyne/vlp16_pcap.h"

#include <utility>

#include "vdbmap/io/velodyne/vlp16_turn_reader.h"

namespace vdbmap {
namespace {

void append(PointCloud& cloud, const PointCloud& turn) {
  const auto append_values = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  append_values(cloud.positions, turn.positions);
  append_values(cloud.intensities, turn.intensities);
  append_values(cloud.times, turn.times);
  append_values(cloud.rings, turn.rings);
}

}  // namespace

ReadResult read_vlp16_pcap(const std::filesystem::path& path, const ReadOptions& options) {
  ReadResult result;
  Vlp16TurnReader turns(path, options.sensor);
  while (const auto turn = turns.next()) append(result.cloud, *turn);
  result.findings = turns.take_findings();
  return result;
}

std::vector<PointCloud> read_vlp16_scans(const std::filesystem::path& path) {
  std::vector<PointCloud> scans;
  Vlp16TurnReader turns(path);
  while (auto turn = turns.next()) scans.push_back(std::move(*turn));
  return scans;
}

}  // namespace vdbmap

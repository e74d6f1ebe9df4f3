// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace vdbmap {

/// A source of points that was counted: a file, or a scan with its pose.
struct MapSource {
  std::string name;  ///< of the file, without its folder
  std::string hash;  ///< of its content, its pose and what else decides about its points: 32 hexadecimal digits
  std::uint64_t num_points = 0;  ///< counted
  std::int32_t epoch = 0;        ///< in which it was added

  bool operator==(const MapSource&) const = default;
};

/// What an epoch changed, in voxels of the finest level.
struct MapChanges {
  std::uint64_t added = 0;      ///< new in the map
  std::uint64_t confirmed = 0;  ///< of the map, seen again: points were added
  std::uint64_t replaced = 0;   ///< of the map, where something else was seen
  std::uint64_t gone = 0;       ///< of the map, seen through
  std::uint64_t unseen = 0;     ///< of the map, as they were
  std::uint64_t moved = 0;      ///< seen, but left out: something was there for a while only

  bool operator==(const MapChanges&) const = default;
};

inline MapChanges operator+(const MapChanges& a, const MapChanges& b) {
  return {a.added + b.added, a.confirmed + b.confirmed, a.replaced + b.replaced,
          a.gone + b.gone,   a.unseen + b.unseen,       a.moved + b.moved};
}

/// A survey or drive that went into a map.
struct MapEpoch {
  std::int32_t number = 0;
  std::string date;  ///< ISO 8601, "2023-09-14"; empty where nobody said
  MapChanges changes;

  bool operator==(const MapEpoch&) const = default;
};

/// Adds an epoch to those before. Where it is the last of them, which goes on, changes add up.
inline void add_epoch(std::vector<MapEpoch>& epochs, const MapEpoch& epoch) {
  const bool goes_on = !epochs.empty() && epochs.back().number == epoch.number;
  if (!goes_on) return epochs.push_back(epoch);
  if (!epoch.date.empty()) epochs.back().date = epoch.date;
  epochs.back().changes = epochs.back().changes + epoch.changes;
}

/// From what a map was made, epoch by epoch.
struct MapHistory {
  std::vector<MapEpoch> epochs;    ///< sorted by number
  std::vector<MapSource> sources;  ///< in the order in which they were added

  bool empty() const { return epochs.empty() && sources.empty(); }
  bool operator==(const MapHistory&) const = default;

  bool has_source(const std::string& hash) const {
    return std::ranges::any_of(sources, [&](const MapSource& source) { return source.hash == hash; });
  }
};

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/tile_findings.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <span>
#include <system_error>
#include <utility>

#include "vdbmap/change/voxel_fates.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/store/city_folder.h"

namespace vdbmap {
namespace {

constexpr std::size_t kWordsOfLeaf = 8;

// A leaf of seen voxels in a file.
struct StoredLeaf {
  std::array<std::int32_t, 3> origin;
  std::int32_t unused = 0;
  std::array<std::uint64_t, kWordsOfLeaf> words;
};

StoredLeaf stored(const VoxelLeaf& leaf) {
  StoredLeaf stored{{leaf.origin().x(), leaf.origin().y(), leaf.origin().z()}, 0, {}};
  for (std::size_t i = 0; i < kWordsOfLeaf; ++i) {
    stored.words[i] = leaf.getValueMask().getWord<openvdb::Index64>(static_cast<openvdb::Index>(i));
  }
  return stored;
}

VoxelLeaf restored(const StoredLeaf& stored) {
  VoxelLeaf::NodeMaskType mask;
  for (std::size_t i = 0; i < kWordsOfLeaf; ++i) {
    mask.getWord<openvdb::Index64>(static_cast<openvdb::Index>(i)) = stored.words[i];
  }
  VoxelLeaf leaf(VoxelIndex(stored.origin[0], stored.origin[1], stored.origin[2]), false, false);
  leaf.setValueMask(mask);
  return leaf;
}

template <typename Value>
void write_values(std::ostream& stream, std::span<const Value> values) {
  const std::uint64_t count = values.size();
  stream.write(reinterpret_cast<const char*>(&count), sizeof(count));
  stream.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size_bytes()));
}

template <typename Value>
std::vector<Value> read_values(ByteReader& file) {
  const auto count = file.read_le<std::uint64_t>();
  if (count > file.remaining() / sizeof(Value)) file.fail("ends too early");
  std::vector<Value> values(count);
  const std::string_view bytes = file.bytes(count * sizeof(Value));
  if (count > 0) std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
  return values;
}

template <typename Value>
bool has_any(const std::vector<Value>& values) {
  return std::ranges::any_of(values, [](const Value& value) {
    if constexpr (std::is_same_v<Value, TimeBins>) {
      return value.bits() != 0;
    } else {
      return value != 0;
    }
  });
}

}  // namespace

bool TileFindings::is_any() const {
  return !seen_empty.leaves().empty() || has_any(presence) ||
         std::ranges::any_of(maps, [](const OfMap& map) { return has_any(map.passes); });
}

void add(TileFindings& to, const TileFindings& more) {
  for (std::size_t map = 0; map < to.maps.size(); ++map) {
    TileFindings::OfMap& sums = to.maps[map];
    const TileFindings::OfMap& added = more.maps.at(map);
    for (std::size_t i = 0; i < sums.passes.size(); ++i) {
      sums.passes[i] += added.passes.at(i);
      sums.pass_times[i] |= added.pass_times.at(i);
    }
  }
  for (std::size_t i = 0; i < to.presence.size(); ++i) to.presence[i] |= more.presence.at(i);
  to.seen_empty = united(to.seen_empty, more.seen_empty);
}

void FindingsFolder::add(const TileId& tile, TileFindings findings) const {
  if (!findings.is_any()) return;
  if (const std::optional<TileFindings> before = read(tile)) vdbmap::add(findings, *before);
  const std::filesystem::path path = path_of(tile);
  std::ofstream stream(path, std::ios::binary);
  const std::uint64_t num_maps = findings.maps.size();
  stream.write(reinterpret_cast<const char*>(&num_maps), sizeof(num_maps));
  for (const TileFindings::OfMap& map : findings.maps) {
    write_values(stream, std::span(map.passes));
    write_values(stream, std::span(map.pass_times));
  }
  write_values(stream, std::span(std::as_const(findings.presence)));
  std::vector<StoredLeaf> leaves;
  for (const VoxelLeaf& leaf : findings.seen_empty.leaves()) leaves.push_back(stored(leaf));
  write_values(stream, std::span(std::as_const(leaves)));
  stream.close();
  if (!stream) throw IoError::system(path, "cannot write", errno);
}

std::optional<TileFindings> FindingsFolder::read(const TileId& tile) const {
  std::error_code missing;
  if (!std::filesystem::exists(path_of(tile), missing)) return std::nullopt;
  ByteReader file(path_of(tile));
  TileFindings findings;
  findings.maps.resize(file.read_le<std::uint64_t>());
  for (TileFindings::OfMap& map : findings.maps) {
    map.passes = read_values<std::uint32_t>(file);
    map.pass_times = read_values<TimeBins>(file);
  }
  findings.presence = read_values<TimeBins>(file);
  LargeVector<VoxelLeaf> leaves;
  for (const StoredLeaf& leaf : read_values<StoredLeaf>(file)) leaves.push_back(restored(leaf));
  findings.seen_empty = VoxelTree(std::move(leaves));
  return findings;
}

std::filesystem::path FindingsFolder::path_of(const TileId& tile) const { return folder_ / tile_name(tile); }

}  // namespace vdbmap

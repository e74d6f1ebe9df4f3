// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/source_hash.h"

#include <cstdint>
#include <filesystem>
#include <set>

#include "vdbmap/core/parallel.h"
#include "vdbmap/store/content_hash.h"

namespace vdbmap {
namespace {

// A whole file in map coordinates is its content; for others the hash goes on.
std::string hash_of_input(const MapInput& input, const std::string& hash_of_content) {
  if (!input.map_from_scan && !input.scan.turn) return hash_of_content;
  ContentHash hash;
  hash.add(hash_of_content.data(), hash_of_content.size());
  const std::uint64_t turn = input.scan.turn ? *input.scan.turn + 1 : 0;
  hash.add(&turn, sizeof(turn));
  if (input.map_from_scan) {
    const Eigen::Matrix<double, 3, 4> pose = input.map_from_scan->matrix().topRows<3>();
    hash.add(pose.data(), sizeof(double) * static_cast<std::size_t>(pose.size()));
  }
  return hash.digits();
}

}  // namespace

std::string source_name(const MapInput& input) { return ScanPlace{input.scan.file.filename(), input.scan.turn}.name(); }

MapSource identify_source(const MapInput& input) {
  return {source_name(input), hash_of_input(input, hash_of_file(input.scan.file))};
}

std::vector<MapSource> identify_sources(const std::vector<MapInput>& inputs,
                                        const std::function<void()>& on_file_done) {
  std::set<std::filesystem::path> distinct;
  for (const MapInput& input : inputs) distinct.insert(input.scan.file);
  const std::vector<std::filesystem::path> files(distinct.begin(), distinct.end());
  std::vector<std::string> hashes(files.size());
  parallel_for(files.size(), [&](std::size_t i) {
    hashes[i] = hash_of_file(files[i]);
    on_file_done();
  });
  std::vector<MapSource> sources;
  for (const MapInput& input : inputs) {
    const auto file = std::ranges::lower_bound(files, input.scan.file);
    sources.push_back(
        {source_name(input), hash_of_input(input, hashes[static_cast<std::size_t>(file - files.begin())])});
  }
  return sources;
}

}  // namespace vdbmap

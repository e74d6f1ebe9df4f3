// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/map_summary.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

namespace vdbmap::cli {
namespace {

using Json = nlohmann::ordered_json;

struct EpochRange {
  std::int32_t first;
  std::int32_t last;
};

std::optional<EpochRange> epochs_of(const VoxelChannels& channels) {
  if (channels.first_epochs.empty() || channels.last_epochs.empty()) return std::nullopt;
  return EpochRange{*std::ranges::min_element(channels.first_epochs), *std::ranges::max_element(channels.last_epochs)};
}

// Voxels of each class, the largest class first.
std::vector<std::pair<std::int32_t, std::size_t>> classes_of(const VoxelChannels& channels) {
  std::map<std::int32_t, std::size_t> counts;
  for (const std::int32_t label : channels.labels) ++counts[label];
  std::vector<std::pair<std::int32_t, std::size_t>> classes(counts.begin(), counts.end());
  std::ranges::stable_sort(classes, std::ranges::greater(), &std::pair<std::int32_t, std::size_t>::second);
  return classes;
}

// "semantickitti: road 40.1 %, car 3.0 %".
std::string classes_text(const VoxelMap& map) {
  std::vector<std::string> shares;
  for (const auto& [label, count] : classes_of(map.finest().channels())) {
    const double percent = 100 * static_cast<double>(count) / static_cast<double>(map.finest().size());
    shares.push_back(fmt::format("{} {:.1f} %", label_name(map.label_scheme, label), percent));
  }
  return fmt::format("{}: {}", text_of(map.label_scheme), fmt::join(shares, ", "));
}

std::vector<std::string> attributes_of(const VoxelMap& map) {
  const VoxelChannels& channels = map.finest().channels();
  std::vector<std::string> names = {"mean", "covariance", "count", "normal", "planarity"};
  if (map.has_color) names.emplace_back("color");
  for_each_channel([&](const char* name, auto channel) {
    if (!(channels.*channel).empty()) names.emplace_back(name);
  });
  return names;
}

std::optional<double> per_voxel(std::uintmax_t bytes, const VoxelMap& map) {
  if (map.finest().size() == 0) return std::nullopt;
  return static_cast<double>(bytes) / static_cast<double>(map.finest().size());
}

std::string text_of(const Eigen::Vector3d& point) {
  return fmt::format("{:.10g}, {:.10g}, {:.10g}", point.x(), point.y(), point.z());
}

std::string line(const std::string& name, const std::string& value) { return fmt::format("{:<11}{}\n", name, value); }

std::string size_text(const VoxelMap& map, std::uintmax_t file_bytes) {
  const std::optional<double> in_memory = per_voxel(memory_bytes(map), map);
  if (!in_memory) return fmt::format("{} bytes in the file", file_bytes);
  return fmt::format("{:.1f} bytes a voxel in memory, {:.1f} in the file of {:.1f} MB", *in_memory,
                     *per_voxel(file_bytes, map), static_cast<double>(file_bytes) / 1e6);
}

template <typename Value>
Json json_of(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json json_of(const Eigen::Vector3d& point) { return {point.x(), point.y(), point.z()}; }

Json json_of_classes(const VoxelMap& map) {
  if (map.finest().channels().labels.empty()) return nullptr;
  auto classes = Json::array();
  for (const auto& [label, count] : classes_of(map.finest().channels())) {
    classes.push_back({{"label", label}, {"name", label_name(map.label_scheme, label)}, {"voxels", count}});
  }
  return {{"scheme", text_of(map.label_scheme)}, {"classes", classes}};
}

Json json_of_levels(const VoxelMap& map) {
  auto levels = Json::array();
  for (const VoxelLevel& level : map.levels) {
    levels.push_back({{"voxel_size_m", level.voxel_size()}, {"voxels", level.size()}});
  }
  return levels;
}

Json json_of_extent(const std::optional<Extent>& box) {
  if (!box) return nullptr;
  return {{"min", json_of(box->min)}, {"max", json_of(box->max)}};
}

Json json_of_epochs(const std::optional<EpochRange>& epochs) {
  if (!epochs) return nullptr;
  return {{"first", epochs->first}, {"last", epochs->last}};
}

}  // namespace

std::string text_of_map(const VoxelMap& map, const std::filesystem::path& file) {
  std::string text = line("points", std::to_string(num_points(map.finest())));
  for (const VoxelLevel& level : map.levels) {
    text += line("level", fmt::format("{:g} m, {} voxels", level.voxel_size(), level.size()));
  }
  if (const auto box = extent(map)) text += line("extent", text_of(box->min) + " to " + text_of(box->max));
  text += line("anchor", text_of(map.frame.anchor));
  text += line("EPSG", map.frame.epsg ? std::to_string(*map.frame.epsg) : "unknown");
  text += line("attributes", fmt::format("{}", fmt::join(attributes_of(map), ", ")));
  text += line("colours", map.has_color ? "yes" : "no");
  if (!map.finest().channels().labels.empty()) text += line("classes", classes_text(map));
  if (const auto epochs = epochs_of(map.finest().channels())) {
    text += line("epochs", fmt::format("{} to {}", epochs->first, epochs->last));
  }
  return text + line("size", size_text(map, std::filesystem::file_size(file)));
}

Json json_of_map(const VoxelMap& map, const std::filesystem::path& file) {
  const std::uintmax_t file_bytes = std::filesystem::file_size(file);
  return {{"file", file.string()},
          {"is_map", true},
          {"points", num_points(map.finest())},
          {"levels", json_of_levels(map)},
          {"extent", json_of_extent(extent(map))},
          {"anchor", json_of(map.frame.anchor)},
          {"epsg", json_of(map.frame.epsg)},
          {"attributes", attributes_of(map)},
          {"has_color", map.has_color},
          {"labels", json_of_classes(map)},
          {"epochs", json_of_epochs(epochs_of(map.finest().channels()))},
          {"bytes_per_voxel",
           {{"memory", json_of(per_voxel(memory_bytes(map), map))}, {"file", json_of(per_voxel(file_bytes, map))}}},
          {"file_bytes", file_bytes}};
}

}  // namespace vdbmap::cli

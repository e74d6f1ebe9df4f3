// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/city_summary.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "vdbmap/io/file/text.h"

namespace vdbmap::cli {
namespace {

std::string fact(const char* name, const std::string& value) { return fmt::format("{:<11}{}\n", name, value); }

std::string corner_text(const Eigen::Vector3d& point) {
  return fmt::format("{:.10g}, {:.10g}, {:.10g}", point.x(), point.y(), point.z());
}

nlohmann::ordered_json json_of_corner(const Eigen::Vector3d& point) { return {point.x(), point.y(), point.z()}; }

std::vector<std::string> attributes_of_city(const CityLayout& layout) {
  std::vector<std::string> names = {"mean", "covariance", "count", "normal", "planarity"};
  if (layout.has_color) names.emplace_back("color");
  names.insert(names.end(), layout.channels.begin(), layout.channels.end());
  return names;
}

std::string date_text(const CityManifest& manifest) {
  const std::string date = date_of(manifest);
  return date.empty() ? "" : ", " + printable(date);
}

std::uint64_t num_bytes(const CityManifest& manifest) {
  std::uint64_t bytes = 0;
  for (const CityTile& tile : manifest.tiles) bytes += tile.num_bytes;
  return bytes;
}

std::uint64_t num_part_bytes(const CityManifest& manifest) {
  std::uint64_t bytes = 0;
  for (const CityPart& part : manifest.parts) bytes += part.num_bytes;
  return bytes;
}

std::string text_of_parts(const CityManifest& manifest) {
  const auto bytes = static_cast<double>(num_part_bytes(manifest));
  const auto voxels = static_cast<double>(num_voxels(manifest).front());
  return fmt::format("kept of each source, {:.1f} MB, {:.1f} bytes a voxel", bytes / 1e6, bytes / voxels);
}

}  // namespace

std::string text_of_city(const CityManifest& manifest) {
  const CityLayout& layout = manifest.layout;
  std::string text = fact("points", std::to_string(num_points(manifest)));
  const std::vector<std::uint64_t> voxels = num_voxels(manifest);
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    text += fact("level", fmt::format("{:g} m, {} voxels", layout.voxel_sizes[i], voxels[i]));
  }
  if (const auto box = extent(manifest)) text += fact("extent", corner_text(box->min) + " to " + corner_text(box->max));
  text += fact("anchor", corner_text(layout.frame.anchor));
  text += fact("EPSG", layout.frame.epsg ? std::to_string(*layout.frame.epsg) : "unknown");
  text += fact("attributes", fmt::format("{}", fmt::join(attributes_of_city(layout), ", ")));
  text += fact("colours", layout.has_color ? "yes" : "no");
  const auto num_seen = static_cast<std::size_t>(std::ranges::count(manifest.tiles, true, &CityTile::has_rays));
  text += fact("rays", num_seen == 0 ? "none: what is not occupied was never seen"
                                     : fmt::format("kept in {} of {} tiles: what is free is known there", num_seen,
                                                   manifest.tiles.size()));
  text += fact("epoch", std::to_string(manifest.epoch) + date_text(manifest));
  text += fact("sources", std::to_string(manifest.sources.size()));
  if (keeps_parts(manifest)) text += fact("parts", text_of_parts(manifest));
  return text + fact("size", fmt::format("{} tiles, {:.1f} MB", manifest.tiles.size(),
                                         static_cast<double>(num_bytes(manifest)) / 1e6));
}

nlohmann::ordered_json json_of_city(const CityManifest& manifest, const std::filesystem::path& folder) {
  const CityLayout& layout = manifest.layout;
  const std::vector<std::uint64_t> voxels = num_voxels(manifest);
  auto levels = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    levels.push_back({{"voxel_size_m", layout.voxel_sizes[i]}, {"voxels", voxels[i]}});
  }
  nlohmann::ordered_json box = nullptr;
  if (const auto all = extent(manifest)) box = {{"min", json_of_corner(all->min)}, {"max", json_of_corner(all->max)}};
  return {{"folder", folder.string()},
          {"is_city", true},
          {"epoch", manifest.epoch},
          {"tiles", manifest.tiles.size()},
          {"sources", manifest.sources.size()},
          {"points", num_points(manifest)},
          {"levels", levels},
          {"extent", box},
          {"anchor", json_of_corner(layout.frame.anchor)},
          {"epsg", layout.frame.epsg ? nlohmann::ordered_json(*layout.frame.epsg) : nlohmann::ordered_json(nullptr)},
          {"attributes", attributes_of_city(layout)},
          {"has_color", layout.has_color},
          {"visibility", has_rays(manifest)},
          {"date", date_of(manifest).empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(date_of(manifest))},
          {"bytes", num_bytes(manifest)},
          {"keeps_parts", keeps_parts(manifest)},
          {"part_bytes", num_part_bytes(manifest)}};
}

}  // namespace vdbmap::cli

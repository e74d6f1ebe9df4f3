// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <set>

#include <openvdb/io/Compression.h>

#include "vdbmap/core/error.h"
#include "vdbmap/io/vdb/map_metadata.h"
#include "vdbmap/io/vdb/map_rules.h"

namespace vdbmap {
namespace {

constexpr std::uint32_t kFileVersion = 224;  // OpenVDB 5 to 12 write it and read it

bool is_simple_name(const std::string& name) {
  const auto is_simple = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  return !name.empty() && std::ranges::all_of(name, is_simple);
}

bool is_level_suffix(std::string_view text) {
  if (text.empty()) return true;
  if (!text.starts_with("_") || !text.ends_with("m")) return false;
  text = text.substr(1, text.size() - (text.ends_with("mm") ? 3 : 2));
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

GridRole role_of_grid(const openvdb::GridBase& grid) {
  constexpr std::array kChannels = {"voxels",    "density",     "color",      "count",     "mean",
                                    "cov_diag",  "cov_offdiag", "normal",     "planarity", "label",
                                    "intensity", "first_epoch", "last_epoch", "hits",      "passes"};
  const std::string name = grid.getName();
  for (const std::string channel : kChannels) {
    if (!name.starts_with(channel) || !is_level_suffix(std::string_view(name).substr(channel.size()))) continue;
    return {channel, name.substr(channel.size())};
  }
  return {};
}

openvdb::GridBase::ConstPtr find_grid(const CheckedFile& file, const std::string& name) {
  const auto found = std::ranges::find_if(file.grids, [&](const auto& grid) { return grid->getName() == name; });
  return found == file.grids.end() ? nullptr : *found;
}

Finding check_file_version(const CheckedFile& file) {
  Finding finding{{}, std::to_string(file.outline.version)};
  if (file.outline.version == kFileVersion) return finding;
  finding.problems.push_back("file version is " + std::to_string(file.outline.version) + ", expected " +
                             std::to_string(kFileVersion));
  return finding;
}

Finding check_grid_offsets(const CheckedFile& file) {
  if (file.outline.has_grid_offsets) return {};
  return {{"written as a stream: single grids cannot be read"}, ""};
}

Finding check_compression(const CheckedFile& file) {
  using namespace openvdb::io;
  Finding finding;
  if (!file.outline.has_grid_offsets) finding.problems.push_back("unknown");
  for (const VdbGridOutline& grid : file.outline.grids) {
    const std::uint32_t flags = grid.compression;
    finding.remark = compressionToString(flags);
    if ((flags & COMPRESS_ACTIVE_MASK) && (flags & (COMPRESS_BLOSC | COMPRESS_ZIP))) continue;
    finding.problems.push_back("grid '" + grid.name + "' has compression '" + compressionToString(flags) +
                               "', expected active values with blosc or zip");
  }
  return finding;
}

Finding check_creator(const CheckedFile& file) {
  const auto creator = file.metadata->getMetadata<openvdb::StringMetadata>("creator");
  if (!creator) return {{}, "none"};
  const std::string& name = creator->value();
  if (!name.starts_with("Houdini")) return {{}, name};
  if (!file.is_ours) return {{}, name + ": Y up, as Blender takes files of Houdini"};
  return {{"creator is '" + name + "': Blender turns files of Houdini as Y up"}, ""};
}

Finding check_grid_names(const CheckedFile& file) {
  Finding finding;
  std::set<std::string> names;
  for (const auto& grid : file.grids) {
    const std::string name = grid->getName();
    if (name.empty()) finding.problems.push_back("a grid without a name");
    if (file.is_ours && !name.empty() && !is_simple_name(name)) {
      finding.problems.push_back("grid name '" + name + "', expected lower case, digits and underscores");
    }
    if (!names.insert(name).second)
      finding.problems.push_back("grid name '" + name + "' is there twice: readers find grids by name");
    finding.remark += (finding.remark.empty() ? "" : ", ") + name;
  }
  return finding;
}

Finding check_anchor_metadata(const CheckedFile& file) {
  Finding finding;
  try {
    const MapFrame frame = frame_of_metadata(*file.metadata, file.path);
    finding.remark = "EPSG " + (frame.epsg ? std::to_string(*frame.epsg) : "unknown");
  } catch (const IoError& error) {
    // The rest of the line is not about one rule, but about the file.
    finding.problems.push_back(std::string(error.what()).substr(file.path.string().size() + 2));
  }
  for (const auto& grid : file.grids) {
    if (grid->getMetadata<openvdb::DoubleMetadata>("voxel_size")) continue;
    finding.problems.push_back("grid '" + grid->getName() + "' lacks 'voxel_size'");
  }
  return finding;
}

}  // namespace vdbmap

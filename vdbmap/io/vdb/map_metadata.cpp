// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/map_metadata.h"

#include <array>
#include <optional>
#include <stdexcept>
#include <string>

#include "vdbmap/core/error.h"
#include "vdbmap/io/vdb/map_grids.h"

namespace vdbmap {
namespace {

constexpr std::array kAnchorNames = {"anchor_x", "anchor_y", "anchor_z"};
constexpr const char* kCreatorName = "creator";
constexpr const char* kCreator = "vdbmap";
constexpr const char* kFormatName = "map_format";
constexpr const char* kEpsgName = "epsg";
constexpr const char* kLabelSchemeName = "label_scheme";

}  // namespace

openvdb::MetaMap metadata_of_map(const VoxelMap& map) {
  const MapFrame& frame = map.frame;
  openvdb::MetaMap metadata;
  metadata.insertMeta(kCreatorName, openvdb::StringMetadata(kCreator));
  metadata.insertMeta(kFormatName, openvdb::Int32Metadata(kMapFormat));
  for (int axis = 0; axis < 3; ++axis) {
    metadata.insertMeta(kAnchorNames[axis], openvdb::DoubleMetadata(frame.anchor[axis]));
  }
  if (frame.epsg) metadata.insertMeta(kEpsgName, openvdb::Int32Metadata(*frame.epsg));
  if (map.label_scheme != LabelScheme::kUnknown) {
    metadata.insertMeta(kLabelSchemeName, openvdb::StringMetadata(std::string(text_of(map.label_scheme))));
  }
  return metadata;
}

openvdb::GridBase::Ptr labelled(openvdb::GridBase::Ptr grid, const std::string& channel, const VoxelMap& map,
                                const VoxelLevel& level) {
  grid->setName(channel + level_suffix(level.voxel_size(), &level == &map.finest()));
  grid->insertMeta(metadata_of_map(map));
  grid->insertMeta("voxel_size", openvdb::DoubleMetadata(level.voxel_size()));
  return grid;
}

MapFrame frame_of_metadata(const openvdb::MetaMap& metadata, const std::filesystem::path& path) {
  const auto format = metadata.getMetadata<openvdb::Int32Metadata>(kFormatName);
  if (!format) throw IoError::malformed(path, "is an OpenVDB file but not a map of vdbmap: it has no 'map_format'");
  if (format->value() != kMapFormat) {
    throw IoError::malformed(
        path, "has map format " + std::to_string(format->value()) + ", expected " + std::to_string(kMapFormat));
  }
  MapFrame frame;
  for (int axis = 0; axis < 3; ++axis) {
    const auto value = metadata.getMetadata<openvdb::DoubleMetadata>(kAnchorNames[axis]);
    if (!value) throw IoError::malformed(path, std::string("lacks '") + kAnchorNames[axis] + "'");
    frame.anchor[axis] = value->value();
  }
  const auto epsg = metadata.getMetadata<openvdb::Int32Metadata>(kEpsgName);
  if (epsg) frame.epsg = epsg->value();
  try {
    check_anchor(frame.anchor);
  } catch (const std::invalid_argument& error) {
    throw IoError::malformed(path, error.what());
  }
  return frame;
}

LabelScheme label_scheme_of_metadata(const openvdb::MetaMap& metadata) {
  const auto scheme = metadata.getMetadata<openvdb::StringMetadata>(kLabelSchemeName);
  return (scheme ? label_scheme_of(scheme->value()) : std::nullopt).value_or(LabelScheme::kUnknown);
}

bool has_map_format(const openvdb::MetaMap& metadata) {
  return metadata.getMetadata<openvdb::Int32Metadata>(kFormatName) != nullptr;
}

bool is_file_of_vdbmap(const openvdb::MetaMap& metadata) {
  const auto creator = metadata.getMetadata<openvdb::StringMetadata>(kCreatorName);
  return has_map_format(metadata) || (creator && creator->value() == kCreator);
}

}  // namespace vdbmap

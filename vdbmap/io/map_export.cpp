// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/map_export.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include "vdbmap/core/srgb.h"
#include "vdbmap/io/las/las.h"
#include "vdbmap/io/ply/ply.h"
#include "vdbmap/io/points/point_cloud_filter.h"
#include "vdbmap/io/table/xyz.h"

namespace vdbmap {
namespace {

Rgb16 srgb_of(const VoxelRecord& record) {
  const Eigen::Vector3d linear = color_of(record);
  return {srgb_from_linear(linear.x()), srgb_from_linear(linear.y()), srgb_from_linear(linear.z())};
}

std::vector<std::uint16_t> point_labels(const std::vector<std::int32_t>& labels) {
  const auto fits = [](std::int32_t label) { return label >= 0 && label <= std::numeric_limits<std::uint16_t>::max(); };
  std::vector<std::uint16_t> codes;
  codes.reserve(labels.size());
  for (const std::int32_t label : labels) codes.push_back(static_cast<std::uint16_t>(fits(label) ? label : kNoLabel));
  return codes;
}

void make_las_labels(std::vector<std::uint16_t>& labels, LabelScheme scheme) {
  constexpr std::int32_t kHighestLasLabel = 31;
  constexpr std::uint16_t kUnclassified = 1;
  for (std::uint16_t& label : labels) {
    const std::int32_t in_las = asprs_label(scheme, label);
    label = in_las <= kHighestLasLabel ? static_cast<std::uint16_t>(in_las) : kUnclassified;
  }
}

// For formats that keep all digits; LAS rounds to digits of its own, and from the mean itself.
void make_decimal(std::vector<Eigen::Vector3d>& positions, const VoxelMap& map, const VoxelLevel& level) {
  parallel_for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    positions[number] = mean_in_original_system(map.frame, level.records()[number], voxel, level.voxel_size());
  });
}

// The points as a format keeps them.
PointCloud cloud_for(PointFormat format, const VoxelMap& map, const VoxelLevel& level) {
  PointCloud cloud = points_of_level(map, level);
  if (format == PointFormat::kLas) {
    make_las_labels(cloud.labels, map.label_scheme);
  } else {
    make_decimal(cloud.positions, map, level);
  }
  return cloud;
}

}  // namespace

PointCloud points_of_level(const VoxelMap& map, const VoxelLevel& level) {
  PointCloud cloud;
  cloud.positions.resize(level.size());
  if (map.has_color) cloud.colors.resize(level.size());
  cloud.intensities = level.channels().intensities;
  cloud.labels = point_labels(level.channels().labels);
  parallel_for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    const VoxelRecord& record = level.records()[number];
    cloud.positions[number] = map.frame.anchor + mean_of(record, voxel, level.voxel_size());
    if (map.has_color) cloud.colors[number] = srgb_of(record);
  });
  return cloud;
}

PointFormat export_format(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  if (extension == ".ply") return PointFormat::kPly;
  if (extension == ".las") return PointFormat::kLas;
  if (extension == ".xyz") return PointFormat::kXyz;
  throw std::invalid_argument(path.string() + ": extension is '" + extension + "', expected .ply, .las or .xyz");
}

void write_points(const std::filesystem::path& path, const PointCloud& cloud, const std::optional<int>& epsg) {
  const PointFormat format = export_format(path);
  if (format == PointFormat::kPly) {
    write_ply(path, cloud);
  } else if (format == PointFormat::kLas) {
    write_las(path, cloud, {.epsg = epsg});
  } else {
    write_xyz(path, cloud);
  }
}

void export_points(const std::filesystem::path& path, const VoxelMap& map, const VoxelLevel& level) {
  write_points(path, cloud_for(export_format(path), map, level), map.frame.epsg);
}

std::size_t export_points_in_box(const std::filesystem::path& path, const VoxelMap& map, const VoxelLevel& level,
                                 const Extent& box) {
  PointCloud cloud = cloud_for(export_format(path), map, level);
  std::vector<std::size_t> outside;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Array3d point = cloud.positions[i];
    const bool is_inside = (point >= box.min.array()).all() && (point <= box.max.array()).all();
    if (!is_inside) outside.push_back(i);
  }
  remove_points(cloud, outside);
  if (cloud.empty()) throw std::invalid_argument("no voxel of the level has its mean in the box");
  write_points(path, cloud, map.frame.epsg);
  return cloud.size();
}

}  // namespace vdbmap

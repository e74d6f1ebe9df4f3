// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/odometry_outputs.h"

#include <stdexcept>
#include <string>
#include <utility>

#include <spdlog/spdlog.h>

#include "tools/cli/map_output.h"
#include "vdbmap/core/cloud_append.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/file/output_path.h"
#include "vdbmap/io/map_export.h"
#include "vdbmap/io/vdb/map_file.h"

namespace vdbmap::cli {
namespace {

BuildOptions map_options() {
  BuildOptions options;
  options.anchor = Eigen::Vector3d::Zero();
  return options;
}

}  // namespace

void OdometryOutputs::check(const std::vector<std::filesystem::path>& inputs) const {
  if (combined) export_format(*combined);
  std::vector<std::pair<std::filesystem::path, OutputKind>> outputs = {{poses, kPosesKind}};
  if (combined) outputs.emplace_back(*combined, kPointsKind);
  if (map) outputs.emplace_back(*map, kMapKind);
  const auto place = [](const std::filesystem::path& path) {
    return std::filesystem::weakly_canonical(follow_links(path));
  };
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const auto& [path, kind] = outputs[i];
    for (std::size_t j = 0; j < i; ++j) {
      if (place(path) == place(outputs[j].first)) {
        throw std::invalid_argument(path.string() + ": two outputs go to this file");
      }
    }
    check_output(path, kind, inputs);
  }
}

OdometryCollector::OdometryCollector(const OdometryOutputs& outputs)
    : outputs_(outputs),
      stream_([this](const PointCloud& scan, const Eigen::Isometry3d& pose, const auto&) { receive(scan, pose); }),
      map_(map_options()) {}

void OdometryCollector::add(PointCloud scan, const registration::OdometryStep& step) {
  if (outputs_.combined || outputs_.map) stream_.add(std::move(scan), step);
}

void OdometryCollector::receive(const PointCloud& deskewed_scan, const Eigen::Isometry3d& first_from_scan) {
  if (outputs_.combined) append_cloud(combined_, deskewed_scan, first_from_scan);
  if (!outputs_.map) return;
  try {
    map_.add(deskewed_scan, first_from_scan);
  } catch (const std::out_of_range& error) {
    throw IoError::malformed(*outputs_.map, error.what());
  }
}

void OdometryCollector::write() {
  stream_.finish();
  if (outputs_.combined && combined_.empty())
    spdlog::warn("{}: not written, no scan has a pose", outputs_.combined->string());
  if (outputs_.combined && !combined_.empty()) write_points(*outputs_.combined, combined_);
  if (outputs_.map && map_.num_points() == 0)
    spdlog::warn("{}: not written, no scan has a pose", outputs_.map->string());
  if (outputs_.map && map_.num_points() > 0) save_map(*outputs_.map, map_.finish());
}

}  // namespace vdbmap::cli

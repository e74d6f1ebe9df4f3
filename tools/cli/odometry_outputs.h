// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "registration/odometry/deskew_stream.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/point_cloud.h"

namespace vdbmap::cli {

/// What `vdbmap odometry` writes, all of it in the frame of the first scan.
struct OdometryOutputs {
  std::filesystem::path poses;
  std::optional<std::filesystem::path> combined;
  std::optional<std::filesystem::path> map;

  /// Before the work: throws std::invalid_argument where an output is an input or another output, or has an extension
  /// that no writer knows, and IoError where it cannot be written.
  void check(const std::vector<std::filesystem::path>& inputs) const;
};

/// Gathers registered scans for the outputs that are made of points; without such outputs nothing.
class OdometryCollector {
 public:
  explicit OdometryCollector(const OdometryOutputs& outputs);

  /// A scan as it was read, and its step.
  void add(PointCloud scan, const registration::OdometryStep& step);

  /// Writes the outputs; none of no points. Throws IoError.
  void write();

 private:
  void receive(const PointCloud& deskewed_scan, const Eigen::Isometry3d& first_from_scan);

  OdometryOutputs outputs_;
  registration::DeskewStream stream_;
  PointCloud combined_;
  MapBuilder map_;
};

}  // namespace vdbmap::cli

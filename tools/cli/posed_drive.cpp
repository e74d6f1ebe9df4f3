// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/posed_drive.h"

#include <algorithm>
#include <string>
#include <utility>

#include <spdlog/spdlog.h>

#include "registration/posed_scans.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/kitti/label_file.h"
#include "vdbmap/io/points/class_filter.h"
#include "vdbmap/io/points/point_cloud_filter.h"

namespace vdbmap::cli {
namespace {

const std::vector<Eigen::Vector3d>& sensor_itself() {
  static const std::vector<Eigen::Vector3d> kOrigin = {Eigen::Vector3d::Zero()};
  return kOrigin;
}

}  // namespace

PosedDrive::PosedDrive(const std::vector<MapInput>& inputs, const std::vector<ScanPlace>& all, Options options)
    : inputs_(inputs), options_(std::move(options)) {
  options_.read.is_in_sensor_frame = true;
  std::size_t place = 0;
  for (const MapInput& input : inputs) {
    while (place < all.size() && !(all[place] == input.scan)) ++place;
    places_.push_back(place++);
  }
}

void PosedDrive::for_each(const std::function<void(const PosedCloud&)>& take) {
  constexpr double kUsualTurn = 0.1;  // [s] of scans whose times are not looked at
  ScanReader reader(options_.read);
  registration::PosedScans deskewed(take);
  std::size_t next_place = places_.empty() ? 0 : places_.front();
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    if (places_[i] > next_place) deskewed.pass_over(places_[i] - next_place);
    next_place = places_[i] + 1;
    std::optional<PointCloud> scan = read(reader, inputs_[i]);
    if (!scan) {
      deskewed.pass_over(1);
    } else if (options_.deskews) {
      deskewed.add(std::move(*scan), pose_of(inputs_[i]));
    } else {
      scan->times.clear();
      take({*scan, pose_of(inputs_[i]), sensor_itself(), kUsualTurn * static_cast<double>(places_[i])});
    }
    options_.on_scan_done();
  }
  deskewed.finish();
  is_first_time_ = false;
}

std::optional<PointCloud> PosedDrive::read(ScanReader& reader, const MapInput& input) {
  const std::filesystem::path& file = input.scan.file;
  try {
    ReadResult read = reader.read(input.scan);
    if (input.labels) attach_labels(read, *input.labels);
    const ClassOptions& classes = options_.classes;
    const std::size_t num_of_classes = drop_classes(file, read, classes.dropped, classes.scheme());
    const std::size_t num_dropped = options_.range ? drop_out_of_range(read, *options_.range) : 0;
    if (is_first_time_) {
      reading_.add(file, read.findings);
      num_of_dropped_classes_ += num_of_classes;
      if (!read.cloud.labels.empty()) schemes_.insert(classes.scheme().value_or(read.label_scheme));
      num_out_of_range_ += num_dropped;
    }
    return std::move(read.cloud);
  } catch (const IoError& error) {
    if (error.kind() != IoError::Kind::kMalformed || options_.read.strict) throw;
    if (is_first_time_) {
      ++num_damaged_;
      spdlog::warn("{}, left out", error.what());
    }
    return std::nullopt;
  }
}

}  // namespace vdbmap::cli

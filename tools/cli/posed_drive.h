// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <vector>

#include "tools/cli/class_options.h"
#include "tools/cli/reading.h"
#include "tools/cli/scan_selection.h"
#include "vdbmap/core/posed_cloud.h"
#include "vdbmap/core/range_limits.h"
#include "vdbmap/io/map_inputs.h"
#include "vdbmap/io/scans/scan_poses.h"

namespace vdbmap::cli {

/// Scans with a pose each, as a drive took them.
class PosedDrive {
 public:
  struct Options {
    ReadOptions read;
    std::optional<RangeLimits> range;  ///< from the sensor
    ClassOptions classes;              ///< of which points are left out
    bool deskews = true;               ///< scans with times; else their points are taken as if moved already
    std::function<void()> on_scan_done = [] {};
  };

  /// `inputs` are scans of the sequence `all`, in its order, each with a pose. Keeps references to both.
  PosedDrive(const std::vector<MapInput>& inputs, const std::vector<ScanPlace>& all, Options options);

  /// Goes through the drive once: deskewed scans, with the places from which their points were measured. Scans with
  /// damage are left out. Throws IoError for those that cannot be read at all.
  void for_each(const std::function<void(const PosedCloud&)>& take);

  /// Of the first time: what was noticed in the files, points beyond the limits and of classes not wanted, scans that
  /// were left out.
  const ReadingReport& reading() const { return reading_; }
  std::size_t num_of_dropped_classes() const { return num_of_dropped_classes_; }
  std::size_t num_out_of_range() const { return num_out_of_range_; }
  /// Whose numbers the labels of the points are; unknown where one scan does not say, or says another.
  LabelScheme label_scheme() const { return schemes_.size() == 1 ? *schemes_.begin() : LabelScheme::kUnknown; }
  bool has_labels() const { return !schemes_.empty(); }
  std::size_t num_damaged() const { return num_damaged_; }

 private:
  std::optional<PointCloud> read(ScanReader& reader, const MapInput& input);

  const std::vector<MapInput>& inputs_;
  std::vector<std::size_t> places_;  // of the inputs in the sequence
  Options options_;
  bool is_first_time_ = true;
  ReadingReport reading_;
  std::size_t num_out_of_range_ = 0;
  std::size_t num_of_dropped_classes_ = 0;
  std::size_t num_damaged_ = 0;
  std::set<LabelScheme> schemes_;
};

}  // namespace vdbmap::cli

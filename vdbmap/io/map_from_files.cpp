// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/map_from_files.h"

#include <future>
#include <sstream>
#include <stdexcept>
#include <string>

#include "vdbmap/core/error.h"
#include "vdbmap/io/kitti/label_file.h"
#include "vdbmap/io/points/point_cloud_filter.h"

namespace vdbmap {
namespace {

struct ReadScan {
  ReadResult read;
  std::size_t num_out_of_range = 0;
};

// The reader serves one scan at a time: the one before must have been taken.
std::future<ReadScan> start_reading(ScanReader& reader, const MapInput& input, const MapFromFilesOptions& options) {
  return std::async(options.reads_ahead ? std::launch::async : std::launch::deferred, [&reader, &input, &options] {
    ReadScan scan{reader.read(input.scan)};
    if (input.labels) attach_labels(scan.read, *input.labels);
    if (options.range && input.map_from_scan) scan.num_out_of_range = drop_out_of_range(scan.read, *options.range);
    return scan;
  });
}

ReadOptions read_options(const std::vector<MapInput>& inputs, ReadOptions options) {
  options.is_in_sensor_frame = inputs.front().map_from_scan.has_value();
  return options;
}

void note_epsg(MapFromFiles& result, const std::filesystem::path& file, const std::optional<int>& epsg) {
  if (!epsg) return;
  if (result.epsg_of_files.value_or(*epsg) != *epsg) {
    throw IoError::malformed(file, "is in EPSG:" + std::to_string(*epsg) +
                                       ", files before it are in EPSG:" + std::to_string(*result.epsg_of_files));
  }
  result.epsg_of_files = epsg;
}

// What the files say of their labels.
class SchemeNotes {
 public:
  void note(const std::filesystem::path& file, LabelScheme scheme) {
    has_unknown_ |= scheme == LabelScheme::kUnknown;
    if (scheme != LabelScheme::kUnknown && known_.value_or(scheme) != scheme) {
      throw IoError::malformed(file, "has labels of " + std::string(text_of(scheme)) + ", files before it of " +
                                         std::string(text_of(*known_)));
    }
    if (scheme != LabelScheme::kUnknown) known_ = scheme;
  }

  // One file that does not say whose numbers its labels are is enough for nobody to know.
  LabelScheme of_all() const { return has_unknown_ ? LabelScheme::kUnknown : known_.value_or(LabelScheme::kUnknown); }

 private:
  std::optional<LabelScheme> known_;
  bool has_unknown_ = false;
};

void note(MapFromFiles& result, const MapInput& input, const ReadResult& read) {
  result.num_points += read.cloud.size();
  result.num_dropped += read.num_non_finite;
  for (const ReadFinding& finding : read.findings) result.findings.push_back({input.scan.file, finding});
  if (read.metres_per_unit != 1.0) result.foreign_units.push_back({input.scan.file, read.metres_per_unit});
  if (!input.map_from_scan) note_epsg(result, input.scan.file, read.epsg);
}

Eigen::Isometry3d pose_of(const MapInput& input) { return input.map_from_scan.value_or(Eigen::Isometry3d::Identity()); }

// Adds a cloud; the last one makes the map.
void add(MapFromFiles& result, MapBuilder& builder, const MapInput& input, const PointCloud& cloud, bool is_last) {
  try {
    if (is_last) {
      result.map = builder.finish(cloud, pose_of(input));
    } else {
      builder.add(cloud, pose_of(input));
    }
  } catch (const std::out_of_range& error) {
    throw IoError::malformed(input.scan.name(), error.what());
  }
}

ReadFinding finding_of(const UnreachablePoints& unreachable) {
  std::ostringstream what;
  what.precision(10);
  what << "points left out that are more than " << unreachable.reach << " m from the map's anchor";
  std::ostringstream first;
  first.precision(10);
  first << unreachable.first.x() << ", " << unreachable.first.y() << ", " << unreachable.first.z();
  return {what.str(), unreachable.count, first.str(), /*is_damage=*/true};
}

void note(MapFromFiles& result, const MapInput& input, const UnreachablePoints& unreachable, bool is_strict) {
  if (unreachable.count == 0) return;
  const ReadFinding finding = finding_of(unreachable);
  if (is_strict) refuse_damage(input.scan.file, {finding});
  result.num_points -= unreachable.count;
  result.findings.push_back({input.scan.file, finding});
}

}  // namespace

MapFromFiles build_map_from_files(const std::vector<MapInput>& inputs, const MapFromFilesOptions& options) {
  if (inputs.empty()) throw std::invalid_argument("no scans to build a map from");
  MapBuilder builder(options.build);
  MapFromFiles result;
  SchemeNotes schemes;
  ScanReader reader(read_options(inputs, options.read));
  std::future<ReadScan> next = start_reading(reader, inputs.front(), options);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const auto [read, num_out_of_range] = next.get();
    const bool is_last = i + 1 == inputs.size();
    if (!is_last) next = start_reading(reader, inputs[i + 1], options);
    note(result, inputs[i], read);
    result.num_out_of_range += num_out_of_range;
    if (!read.cloud.labels.empty()) schemes.note(inputs[i].scan.file, options.label_scheme.value_or(read.label_scheme));
    add(result, builder, inputs[i], read.cloud, is_last);
    note(result, inputs[i], builder.unreachable(), options.read.strict);
    options.on_scan_done();
  }
  if (result.num_points == 0) throw std::invalid_argument("no point of the scans is within the range");
  result.map.label_scheme = schemes.of_all();
  if (!result.map.frame.epsg) result.map.frame.epsg = result.epsg_of_files;
  return result;
}

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/map_inputs.h"

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
std::future<ReadScan> start_reading(ScanReader& reader, const MapInput& input, const InputOptions& options) {
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

void note_epsg(InputNotes& notes, const std::filesystem::path& file, const std::optional<int>& epsg) {
  if (!epsg) return;
  if (notes.epsg_of_files.value_or(*epsg) != *epsg) {
    throw IoError::malformed(file, "is in EPSG:" + std::to_string(*epsg) +
                                       ", files before it are in EPSG:" + std::to_string(*notes.epsg_of_files));
  }
  notes.epsg_of_files = epsg;
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

void note(InputNotes& notes, const MapInput& input, const ReadResult& read) {
  notes.num_points += read.cloud.size();
  notes.num_dropped += read.num_non_finite;
  for (const ReadFinding& finding : read.findings) notes.findings.push_back({input.scan.file, finding});
  if (read.metres_per_unit != 1.0) notes.foreign_units.push_back({input.scan.file, read.metres_per_unit});
  if (!input.map_from_scan) note_epsg(notes, input.scan.file, read.epsg);
}

// What take() leaves out, where that is less than half; an error of it or here names the scan.
template <typename Take>
UnreachablePoints take_reached(const MapInput& input, const PointCloud& cloud, const Take& take) {
  try {
    const UnreachablePoints unreachable = take();
    check_reached(unreachable, cloud.size());
    return unreachable;
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

void note(InputNotes& notes, const MapInput& input, const UnreachablePoints& unreachable, bool is_strict) {
  if (unreachable.count == 0) return;
  const ReadFinding finding = finding_of(unreachable);
  if (is_strict) refuse_damage(input.scan.file, {finding});
  notes.num_points -= unreachable.count;
  notes.findings.push_back({input.scan.file, finding});
}

}  // namespace

Eigen::Isometry3d pose_of(const MapInput& input) { return input.map_from_scan.value_or(Eigen::Isometry3d::Identity()); }

InputNotes read_inputs(const std::vector<MapInput>& inputs, const InputOptions& options, const TakePoints& take) {
  if (inputs.empty()) throw std::invalid_argument("no scans to build a map from");
  InputNotes notes;
  SchemeNotes schemes;
  ScanReader reader(read_options(inputs, options.read));
  std::future<ReadScan> next = start_reading(reader, inputs.front(), options);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const auto [read, num_out_of_range] = next.get();
    if (i + 1 < inputs.size()) next = start_reading(reader, inputs[i + 1], options);
    note(notes, inputs[i], read);
    notes.num_out_of_range += num_out_of_range;
    if (!read.cloud.labels.empty()) schemes.note(inputs[i].scan.file, options.label_scheme.value_or(read.label_scheme));
    note(notes, inputs[i], take_reached(inputs[i], read.cloud, [&] { return take(i, read.cloud); }),
         options.read.strict);
    options.on_scan_done();
  }
  if (notes.num_points == 0) throw std::invalid_argument("no point of the scans is within the range");
  notes.label_scheme = schemes.of_all();
  return notes;
}

}  // namespace vdbmap

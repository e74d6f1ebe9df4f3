// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/map_inputs.h"

#include <future>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/io/kitti/label_file.h"
#include "vdbmap/io/las/las_pieces.h"
#include "vdbmap/io/points/class_filter.h"
#include "vdbmap/io/points/point_cloud_filter.h"

namespace vdbmap {
namespace {

// Points that were read together.
struct Piece {
  std::size_t index = 0;  // of the input
  ReadResult read;
  std::size_t num_out_of_range = 0;
  std::size_t num_of_dropped_classes = 0;
  bool is_first = true;  // of the input
  bool is_last = true;
};

// Goes through the inputs, one piece after the other.
class PieceReader {
 public:
  PieceReader(const std::vector<MapInput>& inputs, const InputOptions& options, const ReadOptions& read)
      : inputs_(inputs), options_(options), reader_(read) {}

  bool is_at_end() const { return next_ == inputs_.size(); }

  Piece read() {
    const bool is_first = !pieces_;
    if (is_first) open_large_file();
    if (!pieces_) return read_whole();
    Piece piece{next_, pieces_->next(), 0, 0, is_first, pieces_->is_at_end()};
    drop(piece);
    if (piece.is_last) {
      pieces_.reset();
      ++next_;
    }
    return piece;
  }

 private:
  // Labels of a file of their own, and turns of a capture, belong to the places of points in whole files.
  void open_large_file() {
    const MapInput& input = inputs_[next_];
    const bool is_limited = options_.most_points < std::numeric_limits<std::size_t>::max();
    if (!is_limited || input.labels || input.scan.turn) return;
    pieces_ = LasPieces::open(input.scan.file, reader_.options(), options_.most_points);
  }

  Piece read_whole() {
    const MapInput& input = inputs_[next_];
    Piece piece{next_++, reader_.read(input.scan)};
    if (input.labels) attach_labels(piece.read, *input.labels);
    drop(piece);
    if (options_.range && input.map_from_scan) piece.num_out_of_range = drop_out_of_range(piece.read, *options_.range);
    return piece;
  }

  void drop(Piece& piece) const {
    piece.num_of_dropped_classes =
        drop_classes(inputs_[piece.index].scan.file, piece.read, options_.dropped_classes, options_.label_scheme);
  }

  const std::vector<MapInput>& inputs_;
  const InputOptions& options_;
  ScanReader reader_;
  std::optional<LasPieces> pieces_;
  std::size_t next_ = 0;
};

// The reader serves one piece at a time: the one before must have been taken.
std::future<Piece> start_reading(PieceReader& reader, const InputOptions& options) {
  return std::async(options.reads_ahead ? std::launch::async : std::launch::deferred,
                    [&reader] { return reader.read(); });
}

ReadOptions read_options(const std::vector<MapInput>& inputs, ReadOptions options) {
  options.is_in_sensor_frame = inputs.front().map_from_scan.has_value();
  return options;
}

void note(InputNotes& notes, const MapInput& input, const ReadResult& read) {
  notes.num_dropped += read.num_non_finite;
  for (const ReadFinding& finding : read.findings) notes.findings.push_back({input.scan.file, finding});
  if (read.metres_per_unit != 1.0) notes.foreign_units.push_back({input.scan.file, read.metres_per_unit});
}

// What is left out of an input, piece by piece.
struct LeftOut {
  UnreachablePoints unreachable;
  std::size_t num_points = 0;  // left out or not

  void add(const UnreachablePoints& of_piece, std::size_t num_points_of_piece) {
    if (unreachable.count == 0) unreachable.first = of_piece.first;
    unreachable.reach = of_piece.reach;
    unreachable.count += of_piece.count;
    num_points += num_points_of_piece;
  }
};

// An error of the body is one of the scan.
template <typename Body>
void name_scan(const MapInput& input, const Body& body) {
  try {
    body();
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

void InputAgreement::add_epsg(const std::filesystem::path& file, const std::optional<int>& epsg) {
  if (!epsg) return;
  if (epsg_.value_or(*epsg) != *epsg) {
    throw IoError::malformed(
        file, "is in EPSG:" + std::to_string(*epsg) + ", files before it are in EPSG:" + std::to_string(*epsg_));
  }
  epsg_ = epsg;
}

void InputAgreement::add_labels(const std::filesystem::path& file, LabelScheme scheme) {
  if (scheme == LabelScheme::kUnknown) {
    has_unknown_ = true;
    return;
  }
  if (known_ != LabelScheme::kUnknown && known_ != scheme) {
    throw IoError::malformed(
        file, "has labels of " + std::string(text_of(scheme)) + ", files before it of " + std::string(text_of(known_)));
  }
  known_ = scheme;
}

void check_any_point(const InputNotes& notes) {
  if (notes.num_points == 0) {
    throw std::invalid_argument(notes.num_of_dropped_classes > 0 ? "all points of the scans are of classes not wanted"
                                                                 : "no point of the scans is within the range");
  }
}

Eigen::Isometry3d pose_of(const MapInput& input) { return input.map_from_scan.value_or(Eigen::Isometry3d::Identity()); }

InputNotes read_inputs(const std::vector<MapInput>& inputs, const InputOptions& options, const TakePoints& take) {
  if (inputs.empty()) throw std::invalid_argument("no scans to build a map from");
  InputNotes notes;
  InputAgreement agreement;
  LeftOut left_out;
  PieceReader reader(inputs, options, read_options(inputs, options.read));
  std::future<Piece> next = start_reading(reader, options);
  while (next.valid()) {
    const Piece piece = next.get();
    if (!reader.is_at_end()) next = start_reading(reader, options);
    const MapInput& input = inputs[piece.index];
    const PointCloud& cloud = piece.read.cloud;
    if (piece.is_first) {
      note(notes, input, piece.read);
      left_out = {};
      if (!input.map_from_scan) agreement.add_epsg(input.scan.file, piece.read.epsg);
      if (!cloud.labels.empty()) {
        agreement.add_labels(input.scan.file, options.label_scheme.value_or(piece.read.label_scheme));
      }
    }
    notes.num_points += cloud.size();
    notes.num_out_of_range += piece.num_out_of_range;
    notes.num_of_dropped_classes += piece.num_of_dropped_classes;
    name_scan(input, [&] {
      left_out.add(take({piece.index, cloud, piece.is_first && piece.is_last}), cloud.size());
      if (piece.is_last) check_reached(left_out.unreachable, left_out.num_points);
    });
    if (!piece.is_last) continue;
    note(notes, input, left_out.unreachable, options.read.strict);
    options.on_scan_done();
  }
  notes.epsg_of_files = agreement.epsg();
  notes.label_scheme = agreement.label_scheme();
  return notes;
}

}  // namespace vdbmap

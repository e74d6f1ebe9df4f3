// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/las/las_pieces.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/las/las_columns.h"
#include "vdbmap/io/las/las_header.h"
#include "vdbmap/io/las/las_point_count.h"
#include "vdbmap/io/las/las_records.h"
#include "vdbmap/io/las/las_reference_system.h"
#include "vdbmap/io/laz/laszip_record.h"
#include "vdbmap/io/laz/laz_points.h"
#include "vdbmap/io/points/color_range.h"
#include "vdbmap/io/points/point_format.h"

namespace vdbmap {
namespace {

// Colours in the scale that the largest of the file says: it is scaled with those of each piece.
void scale_colors_by(const Rgb16& largest, std::vector<Rgb16>& colors) {
  colors.push_back(largest);
  scale_colors(colors);
  colors.pop_back();
}

}  // namespace

struct LasPieces::State {
  // What all points of a file have in common.
  struct PointSurvey {
    Rgb16 largest_color;  // channel by channel
    bool has_intensity = false;
    bool has_label = false;
    bool has_dropped = false;  // points that read_points() may leave out

    void add(const PointCloud& piece) {
      for (const Rgb16& color : piece.colors) {
        largest_color = {std::max(largest_color.r, color.r), std::max(largest_color.g, color.g),
                         std::max(largest_color.b, color.b)};
      }
      const auto is_set = [](auto value) { return value != 0; };
      has_intensity = has_intensity || std::ranges::any_of(piece.intensities, is_set);
      has_label = has_label || std::ranges::any_of(piece.labels, is_set);
      has_dropped = has_dropped || std::ranges::any_of(piece.positions, [](const Eigen::Vector3d& point) {
                      return !point.allFinite() || point.isZero(0);
                    });
    }

    bool has_color() const { return largest_color != Rgb16{}; }
  };

  State(const std::filesystem::path& path, std::size_t points_a_piece)
      : file(path, ByteReader::Loading::kOnDemand), header(read_las_header(file)), most_points(points_a_piece) {}

  ByteReader file;
  LasHeader header;
  std::size_t most_points;
  std::uint64_t num_points = 0;
  std::uint64_t next_point = 0;
  std::optional<laz::LazChunks> chunks;  // of compressed points
  std::size_t next_chunk = 0;
  PointSurvey survey;
  ReadResult about;  // without a cloud

  std::size_t size_of_next() const {
    return static_cast<std::size_t>(std::min<std::uint64_t>(most_points, num_points - next_point));
  }

  const char* read_records(std::size_t count) {
    const std::uint64_t begin = header.points_offset + next_point * header.record_length;
    file.forget_before(begin);
    file.seek(begin);
    return file.bytes(count * header.record_length).data();
  }

  // Stores the next `cloud.size()` points.
  void read_into(PointCloud& cloud) {
    const char* records = read_records(cloud.size());
    store_las_points(cloud, 0, records, cloud.size(), header);
    std::vector<std::size_t> withheld;
    append_withheld(withheld, 0, records, cloud.size(), header);
    survey.has_dropped = survey.has_dropped || !withheld.empty();
    next_point += cloud.size();
  }

  // The next chunks: `at_once` points at most, or one chunk.
  PointCloud read_chunks(std::size_t at_once) {
    file.forget_before(chunks->begin_of(next_chunk));
    const std::size_t count = chunks->count_within(next_chunk, at_once);
    laz::LazChunks::Points points = chunks->read(next_chunk, count);
    survey.has_dropped = survey.has_dropped || points.has_left_out;
    next_chunk += count;
    next_point += points.cloud.size();
    return std::move(points.cloud);
  }

  PointCloud read_cloud() {
    if (chunks) return read_chunks(most_points);
    PointCloud cloud = make_las_cloud(header, size_of_next());
    read_into(cloud);
    return cloud;
  }

  void make_survey() {
    if (chunks) {
      survey_chunks();
    } else {
      survey_records();
    }
    next_point = 0;
    next_chunk = 0;
  }

  void survey_chunks() {
    while (next_point < num_points && !survey.has_dropped) survey.add(read_chunks(most_points));
  }

  // In small pieces, all in the same memory.
  void survey_records() {
    constexpr std::size_t kPointsAtOnce = 1 << 14;
    const std::size_t points_a_piece = std::exchange(most_points, std::min(most_points, kPointsAtOnce));
    PointCloud cloud;
    while (next_point < num_points && !survey.has_dropped) {
      if (cloud.size() != size_of_next()) cloud = make_las_cloud(header, size_of_next());
      read_into(cloud);
      survey.add(cloud);
    }
    most_points = points_a_piece;
  }
};

LasPieces::LasPieces(std::unique_ptr<State> state) : state_(std::move(state)) {}
LasPieces::~LasPieces() = default;
LasPieces::LasPieces(LasPieces&&) noexcept = default;
LasPieces& LasPieces::operator=(LasPieces&&) noexcept = default;

std::optional<LasPieces> LasPieces::open(const std::filesystem::path& path, const ReadOptions& options,
                                         std::size_t most_points) {
  if (detect_point_format(path) != PointFormat::kLas) return std::nullopt;
  auto state = std::make_unique<State>(path, most_points);
  const LasRecords records = read_las_records(state->file, state->header);
  LasPointCount count;
  std::uint64_t most_in_one_piece = most_points;
  if (state->header.is_compressed || laz::is_compressed(records.records)) {
    state->chunks = laz::LazChunks::find(state->file, state->header, records);
    if (!state->chunks) return std::nullopt;
    count.num_points = state->chunks->num_points();
    most_in_one_piece *= 2;  // decoding takes longer than all that follows, and pieces are decoded twice
  } else {
    count = count_las_points(state->file, state->header, records);
  }
  const LasReferenceSystem system = find_reference_system(state->header, records.records);
  const bool is_judged_whole = system.kind == CoordinateKind::kGeographic || system.kind == CoordinateKind::kGeocentric;
  if (count.num_points <= most_in_one_piece || is_judged_whole || options.is_in_sensor_frame) return std::nullopt;

  state->num_points = count.num_points;
  state->make_survey();
  if (state->survey.has_dropped) return std::nullopt;
  ReadResult& about = state->about;
  for (const auto& findings : {state->header.findings, records.findings, system.findings, count.findings}) {
    about.findings.insert(about.findings.end(), findings.begin(), findings.end());
  }
  if (options.strict) refuse_damage(path, about.findings);
  about.epsg = system.epsg;
  about.metres_per_unit = system.metres_per_unit.value_or(1.0);
  if (state->survey.has_label) about.label_scheme = LabelScheme::kAsprs;
  return LasPieces(std::move(state));
}

bool LasPieces::is_at_end() const { return state_->next_point == state_->num_points; }

ReadResult LasPieces::next() {
  ReadResult piece = state_->about;
  piece.cloud = state_->read_cloud();
  const State::PointSurvey& survey = state_->survey;
  if (!survey.has_intensity) piece.cloud.intensities = {};
  if (!survey.has_label) piece.cloud.labels = {};
  if (survey.has_color()) {
    scale_colors_by(survey.largest_color, piece.cloud.colors);
  } else {
    piece.cloud.colors = {};
  }
  return piece;
}

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/scans/scan_sequence.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/io/points/point_cloud_filter.h"
#include "vdbmap/io/points/point_format.h"
#include "vdbmap/io/velodyne/vlp16_turn_reader.h"

namespace vdbmap {
namespace {

// 0 where the capture cannot be read.
std::size_t count_turns(const std::filesystem::path& capture, const ReadOptions& options) {
  try {
    Vlp16TurnReader turns(capture, options.sensor);
    std::size_t count = 0;
    while (turns.next()) ++count;
    if (options.strict) refuse_damage(capture, turns.take_findings());
    return count;
  } catch (const IoError& error) {
    if (error.kind() != IoError::Kind::kMalformed) throw;
    return 0;
  }
}

// A file of no known content is no capture: reading it says what is wrong with it.
bool is_capture(const std::filesystem::path& file) {
  try {
    return detect_point_format(file) == PointFormat::kVlp16Pcap;
  } catch (const IoError& error) {
    if (error.kind() != IoError::Kind::kMalformed) throw;
    return false;
  }
}

// A chosen sensor that no capture holds is an error, not a sequence of scans that cannot be read.
void check_sensor(const std::vector<std::filesystem::path>& captures, const std::vector<ScanPlace>& scans,
                  const ReadOptions& options) {
  if (captures.empty()) {
    throw std::invalid_argument("sensor " + text_of(*options.sensor) + " is chosen, but no file is a packet capture");
  }
  const auto is_turn = [](const ScanPlace& scan) { return scan.turn.has_value(); };
  if (std::ranges::none_of(scans, is_turn)) read_points(captures.front(), options);  // says why
}

}  // namespace

std::string ScanPlace::name() const {
  return turn ? file.string() + ", turn " + std::to_string(*turn + 1) : file.string();
}

std::vector<ScanPlace> list_scans(const std::vector<std::filesystem::path>& files, const ReadOptions& options) {
  std::vector<ScanPlace> scans;
  std::vector<std::filesystem::path> captures;
  for (const std::filesystem::path& file : files) {
    const bool is_of_turns = is_capture(file);
    if (is_of_turns) captures.push_back(file);
    const std::size_t num_turns = is_of_turns ? count_turns(file, options) : 0;
    for (std::size_t turn = 0; turn < num_turns; ++turn) scans.push_back({file, turn});
    if (num_turns == 0) scans.push_back({file, std::nullopt});
  }
  if (options.sensor) check_sensor(captures, scans, options);
  return scans;
}

ScanReader::ScanReader(const ReadOptions& options) : options_(options) {}
ScanReader::~ScanReader() = default;
ScanReader::ScanReader(ScanReader&&) noexcept = default;
ScanReader& ScanReader::operator=(ScanReader&&) noexcept = default;

ReadResult ScanReader::read(const ScanPlace& scan) {
  if (!scan.turn) return read_points(scan.file, options_);
  ReadResult read = read_turn(scan);
  drop_points_at_origin(scan.file, read, options_.is_in_sensor_frame);
  if (options_.strict) refuse_damage(scan.file, read.findings);
  return read;
}

ReadResult ScanReader::read_turn(const ScanPlace& scan) {
  if (!turns_ || capture_ != scan.file || *scan.turn < next_turn_) {
    turns_ = std::make_unique<Vlp16TurnReader>(scan.file, options_.sensor);
    capture_ = scan.file;
    next_turn_ = 0;
  }
  while (auto turn = turns_->next()) {
    if (next_turn_++ != *scan.turn) continue;
    ReadResult read;
    read.cloud = std::move(*turn);
    read.findings = turns_->take_findings();
    return read;
  }
  throw IoError::malformed(scan.file,
                           "has no turn " + std::to_string(*scan.turn + 1) + ", only " + std::to_string(next_turn_));
}

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/scan_sequence.h"

#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/io/point_format.h"
#include "vdbmap/io/vlp16_turn_reader.h"

namespace vdbmap {
namespace {

std::size_t count_turns(const std::filesystem::path& capture) {
  Vlp16TurnReader turns(capture);
  std::size_t count = 0;
  while (turns.next()) ++count;
  return count;
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

}  // namespace

std::string ScanPlace::name() const {
  return turn ? file.string() + ", turn " + std::to_string(*turn + 1) : file.string();
}

std::vector<ScanPlace> list_scans(const std::vector<std::filesystem::path>& files) {
  std::vector<ScanPlace> scans;
  for (const std::filesystem::path& file : files) {
    if (!is_capture(file)) {
      scans.push_back({file, std::nullopt});
      continue;
    }
    const std::size_t num_turns = count_turns(file);
    for (std::size_t turn = 0; turn < num_turns; ++turn) scans.push_back({file, turn});
  }
  return scans;
}

ScanReader::ScanReader(const ReadOptions& options) : options_(options) {}
ScanReader::~ScanReader() = default;
ScanReader::ScanReader(ScanReader&&) noexcept = default;
ScanReader& ScanReader::operator=(ScanReader&&) noexcept = default;

ReadResult ScanReader::read(const ScanPlace& scan) {
  if (!scan.turn) return read_points(scan.file, options_);
  ReadResult result;
  result.cloud = read_turn(scan);
  return result;
}

PointCloud ScanReader::read_turn(const ScanPlace& scan) {
  if (!turns_ || capture_ != scan.file || *scan.turn < next_turn_) {
    turns_ = std::make_unique<Vlp16TurnReader>(scan.file);
    capture_ = scan.file;
    next_turn_ = 0;
  }
  while (auto turn = turns_->next()) {
    if (next_turn_++ == *scan.turn) return std::move(*turn);
  }
  throw IoError::malformed(scan.file,
                           "has no turn " + std::to_string(*scan.turn + 1) + ", only " + std::to_string(next_turn_));
}

}  // namespace vdbmap

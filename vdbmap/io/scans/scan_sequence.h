// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vdbmap/io/points/point_reader.h"

namespace vdbmap {

class Vlp16TurnReader;

/// Where a scan of a sequence lies: a whole file, or one turn of a Velodyne capture.
struct ScanPlace {
  std::filesystem::path file;
  std::optional<std::size_t> turn;  ///< counted from 0; nothing: the whole file

  /// For messages: "hdl32.pcap, turn 3", counted from 1.
  std::string name() const;

  bool operator==(const ScanPlace&) const = default;
};

/// The scans in the point files, in order: each file is one, of a Velodyne capture each turn that has points. To count
/// its turns a capture is decoded once, one turn at a time. A capture without a turn that the options allow is one
/// scan: reading it says what is wrong with it. Throws IoError where a file cannot be opened and where no capture holds
/// the sensor that the options choose, and std::invalid_argument where they choose one and no file is a capture.
std::vector<ScanPlace> list_scans(const std::vector<std::filesystem::path>& files, const ReadOptions& options = {});

/// Reads scans of a sequence. In the order of the sequence, left-out scans included, each capture is gone through once;
/// going back in a capture starts it anew. One scan is in memory at a time.
class ScanReader {
 public:
  explicit ScanReader(const ReadOptions& options = {});
  ~ScanReader();
  ScanReader(ScanReader&&) noexcept;
  ScanReader& operator=(ScanReader&&) noexcept;

  const ReadOptions& options() const { return options_; }

  /// Throws IoError as read_points() does, and for a turn that the capture does not have. What is found in a capture
  /// comes with the first turn that is read after its place.
  ReadResult read(const ScanPlace& scan);

 private:
  ReadResult read_turn(const ScanPlace& scan);

  ReadOptions options_;
  std::filesystem::path capture_;  // that `turns_` reads
  std::unique_ptr<Vlp16TurnReader> turns_;
  std::size_t next_turn_ = 0;  // of `turns_`
};

}  // namespace vdbmap

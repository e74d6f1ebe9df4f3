// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "vdbmap/io/poses/trajectory_file.h"
#include "vdbmap/io/scans/scan_sequence.h"

namespace vdbmap::cli {

/// Which scans of a sequence to use: number `offset`, counted from 0, and each `every`-th after it.
struct ScanSelection {
  std::size_t every = 1;
  std::size_t offset = 0;

  /// Positions in a sequence of `count`.
  std::vector<std::size_t> indices(std::size_t count) const;

  /// As on the command line: "--every 2 --offset 1".
  std::string text() const;
};

/// Declares --every and --offset.
void add_scan_selection(CLI::App& app, ScanSelection& selection);

/// The chosen scans of a sequence.
std::vector<ScanPlace> select(const std::vector<ScanPlace>& scans, const ScanSelection& selection);

/// The chosen poses, with their times.
Trajectory select(const Trajectory& poses, const ScanSelection& selection);

/// Of the poses that `path` holds those for the `num_wanted` chosen scans: all of them when there are just so many,
/// else those at the places of the selection. Throws IoError naming both counts when neither fits.
Trajectory selected_poses(const Trajectory& poses, const std::filesystem::path& path, const ScanSelection& selection,
                          std::size_t num_wanted);

}  // namespace vdbmap::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/scan_selection.h"

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <spdlog/fmt/fmt.h>

#include "vdbmap/core/error.h"

namespace vdbmap::cli {
namespace {

constexpr int kMaxScans = 1'000'000'000;

}  // namespace

std::vector<std::size_t> ScanSelection::indices(std::size_t count) const {
  std::vector<std::size_t> chosen;
  for (std::size_t i = offset; i < count; i += every) chosen.push_back(i);
  return chosen;
}

std::string ScanSelection::text() const { return fmt::format("--every {} --offset {}", every, offset); }

void add_scan_selection(CLI::App& app, ScanSelection& selection) {
  app.add_option("--every", selection.every, "Use each N-th scan of the sequence, and each N-th pose with it")
      ->check(CLI::Range(1, kMaxScans).description(""))
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--offset", selection.offset, "Number of the first scan to use, counted from 0")
      ->check(CLI::Range(0, kMaxScans).description(""))
      ->type_name("K")
      ->capture_default_str();
}

std::vector<ScanPlace> select(const std::vector<ScanPlace>& scans, const ScanSelection& selection) {
  std::vector<ScanPlace> chosen;
  for (const std::size_t i : selection.indices(scans.size())) chosen.push_back(scans[i]);
  return chosen;
}

Trajectory select(const Trajectory& poses, const ScanSelection& selection) {
  Trajectory chosen;
  chosen.findings = poses.findings;
  for (const std::size_t i : selection.indices(poses.size())) {
    chosen.map_from_scan.push_back(poses.map_from_scan[i]);
    if (!poses.times.empty()) chosen.times.push_back(poses.times[i]);
  }
  return chosen;
}

Trajectory selected_poses(const Trajectory& poses, const std::filesystem::path& path, const ScanSelection& selection,
                          std::size_t num_wanted) {
  if (poses.size() == num_wanted) return poses;
  const Trajectory chosen = select(poses, selection);
  if (chosen.size() == num_wanted) return chosen;
  throw IoError::malformed(path, fmt::format("{} poses, {} of them chosen by {}, but {} are needed", poses.size(),
                                             chosen.size(), selection.text(), num_wanted));
}

}  // namespace vdbmap::cli

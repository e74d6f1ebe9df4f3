// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/build_inputs.h"

#include <stdexcept>
#include <string>
#include <system_error>

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "vdbmap/core/error.h"
#include "vdbmap/io/trajectory_file.h"

namespace vdbmap::cli {
namespace {

// A file of poses may go on after the last scan, as that of a whole drive does, but not end before it.
Trajectory read_poses(const std::filesystem::path& path, std::size_t num_scans) {
  Trajectory poses = read_trajectory(path);
  const std::string counts = fmt::format("{} poses for {} scans", poses.size(), num_scans);
  if (poses.size() < num_scans) throw IoError::malformed(path, counts);
  if (poses.size() > num_scans) spdlog::warn("{}: {}, those left over are not used", path.string(), counts);
  return poses;
}

std::vector<MapInput> with_poses(const std::vector<ScanPlace>& scans, const std::vector<std::size_t>& chosen,
                                 const std::filesystem::path& path) {
  const Trajectory poses = read_poses(path, scans.size());
  std::vector<MapInput> inputs;
  for (const std::size_t i : chosen) {
    if (poses.map_from_scan[i]) inputs.push_back({scans[i], poses.map_from_scan[i]});
  }
  if (inputs.empty()) throw IoError::malformed(path, "none of the chosen scans has a pose");
  if (const std::size_t num_missing = chosen.size() - inputs.size(); num_missing > 0) {
    spdlog::warn("{}: {} of {} scans have no pose and are left out", path.string(), num_missing, chosen.size());
  }
  return inputs;
}

}  // namespace

std::vector<MapInput> choose_inputs(const std::vector<ScanPlace>& scans, const ScanSelection& selection,
                                    const std::optional<std::filesystem::path>& poses) {
  const std::vector<std::size_t> chosen = selection.indices(scans.size());
  if (chosen.empty()) {
    throw std::invalid_argument(fmt::format("{} chooses none of {} scans", selection.text(), scans.size()));
  }
  if (poses) return with_poses(scans, chosen, *poses);
  std::vector<MapInput> inputs;
  for (const std::size_t i : chosen) inputs.push_back({scans[i], std::nullopt});
  return inputs;
}

void add_label_files(std::vector<MapInput>& inputs, const std::filesystem::path& labels) {
  const bool is_folder = std::filesystem::is_directory(labels);
  if (!is_folder && inputs.size() > 1) {
    throw std::invalid_argument(
        fmt::format("--labels names a file, but there are {} scans: expected a folder with a "
                    ".label file for each",
                    inputs.size()));
  }
  for (MapInput& input : inputs) {
    if (input.scan.turn) throw std::invalid_argument(input.scan.name() + ": no label file can belong to a turn");
    input.labels = is_folder ? labels / input.scan.file.filename().replace_extension(".label") : labels;
    std::error_code error;
    if (!std::filesystem::exists(*input.labels, error)) {
      throw IoError::malformed(*input.labels, "is missing, the labels of " + input.scan.file.string());
    }
  }
}

}  // namespace vdbmap::cli

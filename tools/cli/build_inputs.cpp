// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/build_inputs.h"

#include <cerrno>
#include <map>
#include <stdexcept>
#include <string>
#include <system_error>

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "vdbmap/core/error.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::cli {
namespace {

// A file of poses may go on after the last scan, as that of a whole drive does, but not end before it.
void check_count(const Trajectory& poses, const std::filesystem::path& path, std::size_t num_scans) {
  const std::string counts = fmt::format("{} poses for {} scans", poses.size(), num_scans);
  if (poses.size() < num_scans) throw IoError::malformed(path, counts);
  if (poses.size() > num_scans) spdlog::warn("{}: {}, those left over are not used", path.string(), counts);
}

std::vector<MapInput> with_poses(const std::vector<ScanPlace>& scans, const std::vector<std::size_t>& chosen,
                                 const Trajectory& poses, const std::filesystem::path& path) {
  check_count(poses, path, scans.size());
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

void require_existing(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw IoError::system(path, "cannot open", error ? error.value() : ENOENT);
}

}  // namespace

ChosenInputs choose_inputs(const std::vector<ScanPlace>& scans, const ScanSelection& selection,
                           const std::optional<std::filesystem::path>& poses, PoseFrame frame) {
  const std::vector<std::size_t> chosen = selection.indices(scans.size());
  if (chosen.empty()) {
    throw std::invalid_argument(fmt::format("{} chooses none of {} scans", selection.text(), scans.size()));
  }
  ChosenInputs result;
  if (poses) {
    result.poses = read_scan_poses(*poses, scans, frame);
    result.inputs = with_poses(scans, chosen, result.poses->poses, *poses);
  } else {
    for (const std::size_t i : chosen) result.inputs.push_back({scans[i], std::nullopt});
  }
  return result;
}

void add_label_files(std::vector<MapInput>& inputs, const std::filesystem::path& labels) {
  require_existing(labels);
  std::error_code error;
  const bool is_folder = std::filesystem::is_directory(labels, error);
  std::map<std::filesystem::path, std::filesystem::path> scan_of_labels;
  for (MapInput& input : inputs) {
    const std::filesystem::path& scan = input.scan.file;
    if (input.scan.turn) throw std::invalid_argument(input.scan.name() + ": no label file can belong to a turn");
    input.labels = is_folder ? labels / scan.filename().replace_extension(".label") : labels;
    require_existing(*input.labels);
    const auto [first, is_new] = scan_of_labels.emplace(*input.labels, scan);
    if (is_new) continue;
    throw std::invalid_argument(fmt::format("{}: cannot hold the labels of both {} and {}", input.labels->string(),
                                            first->second.string(), scan.string()));
  }
}

}  // namespace vdbmap::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/segmentation/segment.h"

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/Option.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "parking/segmentation/default_weights.h"
#include "parking/segmentation/label_city.h"
#include "tools/cli/city_output.h"
#include "tools/cli/command.h"
#include "tools/cli/map_output.h"
#include "tools/cli/output.h"
#include "tools/cli/output_ending.h"
#include "tools/cli/progress.h"
#include "tools/cli/reading.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/file/atomic_folder.h"
#include "vdbmap/io/kitti/label_file.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/io/vdb/visibility_file.h"
#include "vdbmap/store/city_folder.h"
#include "vdbmap/store/city_window.h"

namespace vdbmap::cli {
namespace {

struct SegmentCommandOptions {
  std::vector<std::filesystem::path> inputs;
  MapOutput output;
  std::filesystem::path weights;
  ReadOptions read;
};

// How many voxels or points of each class were found, by label.
using Shares = std::map<std::int32_t, std::size_t>;

void add_options(CLI::App& app, SegmentCommandOptions& options) {
  app.add_option("INPUTS", options.inputs, "A map (.vdb) or a city; or clouds and scans, each segmented by itself")
      ->type_name("FILE|FOLDER...")
      ->required();
  add_map_output(app, options.output);
  app.get_option("--output")
      ->description(
          "A .vdb file: the map with classes. A .label file: the classes of the points of one input, in their order. "
          "Another name: a folder of .label files, one an input");
  app.add_option("--weights", options.weights, "Weights of the network instead of those that come with the program")
      ->type_name("FILE");
  add_read_options(app, options.read);
}

std::shared_ptr<const parking::NetworkWeights> weights_of(const SegmentCommandOptions& options) {
  return parking::read_network(options.weights.empty() ? parking::default_weights() : options.weights);
}

void count(const std::vector<std::int32_t>& labels, Shares& shares) {
  for (const std::int32_t label : labels) ++shares[label];
}

nlohmann::ordered_json json_of(const Shares& shares) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [label, number] : shares) json[label_name(LabelScheme::kSemanticKitti, label)] = number;
  return json;
}

void report(const SegmentCommandOptions& options, const CommonOptions& common, const std::string& what,
            const Shares& shares, double seconds) {
  std::size_t all = 0;
  for (const auto& [label, number] : shares) all += number;
  if (common.json) {
    print_json(
        {{"output", options.output.file.string()}, {what, all}, {"classes", json_of(shares)}, {"seconds", seconds}});
    return;
  }
  std::string text = fmt::format("{}: {} {} segmented in {:.1f} s\n", options.output.file.string(), all, what, seconds);
  for (const auto& [label, number] : shares) {
    text += fmt::format("{:<13} {:5.1f} %\n", label_name(LabelScheme::kSemanticKitti, label),
                        100.0 * static_cast<double>(number) / static_cast<double>(all));
  }
  print_result(text);
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

ExitCode run_map(const SegmentCommandOptions& options, const CommonOptions& common) {
  if (options.inputs.size() != 1) throw std::invalid_argument("one map is segmented into one .vdb file");
  check_output(options.output.file, kMapKind, options.inputs);
  const auto network = weights_of(options);
  const std::filesystem::path& input = options.inputs.front();
  VoxelMap map = load_map_or_city(input);
  MapExtras extras;
  if (!is_city(input)) extras = {load_visibility(input, map), load_history(input)};
  const auto start = std::chrono::steady_clock::now();
  try {
    parking::label_map(map, *network);
  } catch (const std::invalid_argument& error) {
    throw IoError::malformed(input, error.what());
  }
  const double seconds = seconds_since(start);
  save_map(options.output.file, map, extras, options.output.save);
  Shares shares;
  count(map.finest().channels().labels, shares);
  report(options, common, "voxels", shares, seconds);
  return ExitCode::kDone;
}

void check_new_folder(const std::filesystem::path& folder) {
  std::error_code error;
  if (std::filesystem::is_directory(folder, error) && !std::filesystem::is_empty(folder, error)) {
    throw std::invalid_argument(folder.string() + ": is a folder with something in it, expected a new or empty one");
  }
}

// Whether an input is a city, and no folder of clouds or scans.
bool is_manifest_there(const std::filesystem::path& input) {
  if (!is_city(input)) return false;
  std::error_code error;
  return !std::filesystem::is_directory(input, error) || std::filesystem::exists(manifest_path(input), error);
}

ExitCode run_city(const SegmentCommandOptions& options, const CommonOptions& common) {
  if (options.inputs.size() != 1) throw std::invalid_argument("one city is segmented into one folder");
  check_ending(options.output.file, kMapKind);
  if (has_ending(options.output.file, kLabelsKind)) {
    throw std::invalid_argument(options.output.file.string() + ": a city is written as a city, .label is for points");
  }
  check_new_folder(options.output.file);
  const auto network = weights_of(options);
  City city = open_city(options.inputs.front());
  const auto start = std::chrono::steady_clock::now();
  Progress progress("segmenting tiles", city.manifest.tiles.size(), common);
  parking::LabelCityOptions label;
  label.on_tiles_done = [&](std::size_t num_tiles) { progress.advance(num_tiles); };
  CityManifest manifest;
  try {
    manifest = parking::label_city(city, city_folder(options.output.file), *network, label);
  } catch (const std::invalid_argument& error) {
    throw IoError::malformed(options.inputs.front(), error.what());
  }
  const double seconds = seconds_since(start);
  const std::vector<std::uint64_t> voxels = num_voxels(manifest);
  if (common.json) {
    print_json({{"output", options.output.file.string()},
                {"tiles", manifest.tiles.size()},
                {"voxels", voxels.empty() ? 0 : voxels.front()},
                {"seconds", seconds}});
  } else {
    print_result(fmt::format("{}: {} tiles, {} voxels segmented in {:.1f} s\n", options.output.file.string(),
                             manifest.tiles.size(), voxels.empty() ? 0 : voxels.front(), seconds));
  }
  return ExitCode::kDone;
}

// Labels of all points of a file, those that were left out included, which have none.
std::vector<PointLabel> labels_of_file(const ReadResult& read, const std::vector<std::int32_t>& labels) {
  std::vector<PointLabel> all;
  all.reserve(labels.size() + read.dropped.size());
  auto next_dropped = read.dropped.begin();
  for (const std::int32_t label : labels) {
    for (; next_dropped != read.dropped.end() && *next_dropped == all.size(); ++next_dropped) all.push_back({0, 0});
    all.push_back({static_cast<std::uint16_t>(label), 0});
  }
  all.resize(labels.size() + read.dropped.size(), {0, 0});
  return all;
}

void segment_file(const std::filesystem::path& input, const std::filesystem::path& output,
                  const SegmentCommandOptions& options, const parking::NetworkWeights& network, ReadingReport& reading,
                  Shares& shares) {
  const ReadResult read = read_points(input, options.read);
  reading.add(input, read.findings);
  const std::vector<std::int32_t> labels = parking::point_labels(read.cloud, network);
  count(labels, shares);
  write_labels(output, labels_of_file(read, labels));
}

// Each file's name with .label; two that would have the same are refused.
std::vector<std::filesystem::path> label_names(const std::vector<std::filesystem::path>& files) {
  std::vector<std::filesystem::path> names;
  std::set<std::filesystem::path> taken;
  for (const std::filesystem::path& file : files) {
    names.push_back(file.filename().replace_extension(".label"));
    if (!taken.insert(names.back()).second) {
      throw std::invalid_argument("two inputs would be written to " + names.back().string());
    }
  }
  return names;
}

ExitCode run_points(const SegmentCommandOptions& options, const CommonOptions& common) {
  ReadingReport reading;
  const std::vector<std::filesystem::path> files = list_inputs(options.inputs, reading);
  const bool is_file = has_ending(options.output.file, kLabelsKind);
  if (is_file && files.size() != 1) {
    throw std::invalid_argument("labels of several inputs are written to a folder, not to one .label file");
  }
  const std::vector<std::filesystem::path> names = label_names(files);
  if (is_file) {
    check_output(options.output.file, kLabelsKind, files);
  } else {
    check_ending(options.output.file, kLabelsKind);
    check_new_folder(options.output.file);
  }
  const auto network = weights_of(options);

  const auto start = std::chrono::steady_clock::now();
  Shares shares;
  if (is_file) {
    segment_file(files.front(), options.output.file, options, *network, reading, shares);
  } else {
    AtomicFolder folder(options.output.file);
    Progress progress("segmenting", files.size(), common);
    for (std::size_t i = 0; i < files.size(); ++i) {
      segment_file(files[i], folder.temporary_path() / names[i], options, *network, reading, shares);
      progress.advance();
    }
    folder.commit();
  }
  reading.warn();
  report(options, common, "points", shares, seconds_since(start));
  return ExitCode::kDone;
}

ExitCode run(const SegmentCommandOptions& options, const CommonOptions& common) {
  if (has_ending(options.output.file, kMapKind)) return run_map(options, common);
  const bool is_labelled_city = is_manifest_there(options.inputs.front());
  return is_labelled_city ? run_city(options, common) : run_points(options, common);
}

}  // namespace

Command segment_command() {
  return make_command<SegmentCommandOptions>("segment",
                                             "Tell ground, buildings, vegetation, vehicles, poles, persons apart",
                                             "vdbmap segment map.vdb -o labelled.vdb\n"
                                             "vdbmap segment city/ -o labelled/\n"
                                             "vdbmap segment survey.laz -o survey.label\n"
                                             "vdbmap segment drive/velodyne -o drive/labels --weights own.kpconv",
                                             add_options, run);
}

}  // namespace vdbmap::cli

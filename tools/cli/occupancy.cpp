// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <CLI/Option.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "parking/exchange/city_documents.h"
#include "parking/exchange/occupancy_files.h"
#include "parking/occupancy/drive_evidence.h"
#include "parking/segmentation/default_weights.h"
#include "parking/segmentation/segment.h"
#include "parking/spaces/find_spaces.h"
#include "parking/spaces/iso_date.h"
#include "tools/cli/build_inputs.h"
#include "tools/cli/command.h"
#include "tools/cli/date_option.h"
#include "tools/cli/geo_output.h"
#include "tools/cli/labelled_map.h"
#include "tools/cli/map_output.h"
#include "tools/cli/occupancy_outputs.h"
#include "tools/cli/output.h"
#include "tools/cli/pose_frame.h"
#include "tools/cli/posed_drive.h"
#include "tools/cli/progress.h"
#include "tools/cli/reading.h"
#include "tools/cli/scan_selection.h"
#include "vdbmap/core/error.h"
#include "vdbmap/store/city_folder.h"
#include "vdbmap/store/city_window.h"

namespace vdbmap::cli {
namespace {

struct OccupancyCommandOptions {
  std::filesystem::path map;
  std::filesystem::path spaces;
  std::vector<std::filesystem::path> later;
  std::optional<std::filesystem::path> poses;
  OccupancyOutputs outputs;
  parking::OccupancyRule rule;
  std::filesystem::path weights;
  std::string date;
  bool has_moved_points = false;
  PoseFrame pose_frame = PoseFrame::kUnknown;
  ScanSelection selection;
  ReadOptions read;
};

void add_scan_options(CLI::App& app, OccupancyCommandOptions& options) {
  app.add_option("--poses", options.poses, "Poses of the scans in the map (KITTI or TUM), as of vdbmap localize")
      ->type_name("FILE");
  app.add_flag("--no-deskew", options.has_moved_points,
               "The points of scans with times were moved to one time already");
  app.add_option("--weights", options.weights, "Weights of the network instead of those that come with the program")
      ->type_name("FILE");
  add_pose_frame(app, options.pose_frame);
  add_read_options(app, options.read);
  add_scan_selection(app, options.selection);
}

void add_options(CLI::App& app, OccupancyCommandOptions& options) {
  app.add_option("MAP", options.map, "The map with classes that the spaces are of, or a city")
      ->type_name("FILE|FOLDER")
      ->required();
  app.add_option("SPACES", options.spaces, "The spaces (GeoJSON), of vdbmap spaces or a city's own")
      ->type_name("FILE")
      ->required();
  app.add_option(
         "LATER", options.later,
         "Scans of a later drive in the frame of the sensor, in order, and folders of them; or a map or city of a "
         "later epoch")
      ->type_name("PATH...")
      ->required();
  add_occupancy_outputs(app, options.outputs);
  app.add_flag("--as-paper", options.rule.as_paper,
               "As in Mortazavi 2023: a space without a vehicle point is vacant, whether it was seen or not");
  add_date(app, options.date,
           "the later epoch; default: that of its map, or the time stamps of the drive where they are dates");
  add_scan_options(app, options);
}

bool is_map(const std::filesystem::path& path) {
  if (has_ending(path, kMapKind)) return true;
  std::error_code error;
  return is_city(path) &&
         (!std::filesystem::is_directory(path, error) || std::filesystem::exists(manifest_path(path), error));
}

// The tiles of a city that decide about the spaces: as far around them as the network looks, and whole vehicles.
TileChoice tiles_near(const std::vector<parking::ParkingSpace>& spaces, const MapFrame& frame) {
  constexpr double kAround = 40;  // [m]
  std::vector<TileChoice> choices;
  for (const parking::ParkingSpace& space : spaces) {
    Extent box = kNoExtent;
    for (const Eigen::Vector2d& corner : space.outline) {
      const Eigen::Vector3d place = frame.anchor + Eigen::Vector3d(corner.x(), corner.y(), 0);
      box.min = box.min.cwiseMin(place - Eigen::Vector3d::Constant(kAround));
      box.max = box.max.cwiseMax(place + Eigen::Vector3d::Constant(kAround));
    }
    choices.push_back(tiles_in_box(box));
  }
  return [choices](const CityTile& tile) {
    return std::ranges::any_of(choices, [&](const TileChoice& is_near) { return is_near(tile); });
  };
}

// What the later epoch says.
struct LaterEpoch {
  parking::EpochEvidence evidence;
  VoxelMap map;  // labelled
  std::string date;
};

// The date of a time stamp, where it is one since 1970: scanners may count from anywhere.
std::string date_of_time(double seconds) {
  constexpr double kEarliest = 9.5e8, kLatest = 4.1e9;  // [s] 2000 to 2100
  return seconds > kEarliest && seconds < kLatest ? parking::date_of_seconds(std::llround(std::floor(seconds))) : "";
}

LaterEpoch look_at_scans(const OccupancyCommandOptions& options, const CommonOptions& common, const VoxelMap& map,
                         const std::vector<parking::ParkingSpace>& spaces, const parking::GroundPlan& ground) {
  if (!options.poses) throw std::invalid_argument("scans need --poses, as vdbmap localize writes them");
  ReadingReport listed;
  const std::vector<ScanPlace> all = list_scans(list_inputs(options.later, listed), options.read);
  listed.warn();
  const ChosenInputs chosen = choose_inputs(all, options.selection, options.poses, options.pose_frame);
  const auto network = parking::read_network(options.weights.empty() ? parking::default_weights() : options.weights);

  LaterEpoch later;
  if (!chosen.poses->poses.times.empty()) later.date = date_of_time(chosen.poses->poses.times.front());
  Progress progress("looking along rays", chosen.inputs.size(), common);
  PosedDrive drive(chosen.inputs, all,
                   {.read = options.read,
                    .range = std::nullopt,
                    .classes = {},
                    .deskews = !options.has_moved_points,
                    .on_scan_done = [&progress] { progress.advance(); }});
  parking::DriveEvidence evidence(map, spaces, ground);
  drive.for_each([&](const PosedCloud& scan) {
    if (later.date.empty() && !scan.cloud.times.empty()) later.date = date_of_time(scan.cloud.times.front());
    evidence.add(scan);
  });
  drive.reading().warn();
  std::tie(later.map, later.evidence) = evidence.finish(*network);
  return later;
}

LaterEpoch look_at_map(const OccupancyCommandOptions& options, const VoxelMap& map,
                       const std::vector<parking::ParkingSpace>& spaces, const parking::GroundPlan& ground) {
  if (options.later.size() != 1) throw std::invalid_argument("one map of a later epoch is looked at, or scans");
  if (options.poses) throw std::invalid_argument("a map of a later epoch has no use for --poses");
  const std::filesystem::path& path = options.later.front();
  LaterEpoch later;
  LoadedMap loaded = load_seen_labelled_map(path, [&](const MapFrame& frame) { return tiles_near(spaces, frame); });
  later.map = std::move(loaded.map);
  if (!(later.map.frame == map.frame)) {
    throw IoError::malformed(path, "has another anchor or EPSG code than " + options.map.string());
  }
  later.date = date_of_map(path);
  const std::optional<Visibility>& visibility = loaded.visibility;
  if (!visibility) {
    spdlog::warn("{}: does not say what rays passed: no space is known to be vacant by it", path.string());
  }
  later.evidence = parking::evidence_of_level(spaces, ground, map.finest(), later.map.finest(), visibility);
  return later;
}

// States in the epoch before: what the file of the spaces says, else what stands in the map they were found in.
std::vector<std::optional<parking::SpaceState>> previous_states(const LoadedMap& loaded,
                                                                const std::vector<parking::ParkingSpace>& spaces,
                                                                const parking::GroundPlan& ground) {
  const VoxelLevel& level = loaded.map.finest();
  const parking::EpochEvidence evidence = parking::evidence_of_level(spaces, ground, level, level, loaded.visibility);
  std::vector<std::optional<parking::SpaceState>> states;
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    states.push_back(spaces[i].history.empty() ? parking::judge(evidence.spaces[i]).state
                                               : spaces[i].history.back().state);
  }
  return states;
}

void check_spaces(const OccupancyCommandOptions& options, const std::vector<parking::ParkingSpace>& spaces,
                  const parking::GroundPlan& ground) {
  if (spaces.empty()) throw IoError::malformed(options.spaces, "holds no spaces");
  const auto rooms = parking::rooms_over(spaces, ground);
  const auto num_outside =
      static_cast<std::size_t>(std::ranges::count_if(rooms, [](const auto& room) { return !room; }));
  if (num_outside == spaces.size()) {
    throw IoError::malformed(
        options.spaces, fmt::format("none of its {} spaces lies on ground of {}", spaces.size(), options.map.string()));
  }
  if (num_outside > 0) {
    spdlog::warn("{}: {} of {} spaces lie where the map has no ground: unknown", options.spaces.string(), num_outside,
                 spaces.size());
  }
  for (const parking::SpaceOverlap& overlap : parking::find_overlaps(spaces)) {
    spdlog::warn("{}: spaces '{}' and '{}' overlap by {:.0f} % of the smaller one", options.spaces.string(),
                 spaces[overlap.a].id, spaces[overlap.b].id, 100 * overlap.share);
  }
}

bool is_anything_seen(const parking::EpochEvidence& evidence) {
  return std::ranges::any_of(evidence.spaces, [](const parking::SpaceEvidence& space) {
    return space.num_passed > 0 || space.vehicle_points > 0 || space.num_with_other > 0;
  });
}

ExitCode run(const OccupancyCommandOptions& options, const CommonOptions& common) {
  options.rule.check();
  std::vector<std::filesystem::path> inputs = options.later;
  inputs.insert(inputs.end(), {options.map, options.spaces});
  if (options.poses) inputs.push_back(*options.poses);
  check_outputs(options.outputs, inputs);

  parking::OccupancyRecord record;
  const LoadedMap loaded = load_seen_labelled_map(options.map, [&](const MapFrame& frame) {
    record.spaces = parking::read_spaces(options.spaces, frame, options.outputs.geo);
    return tiles_near(record.spaces, frame);
  });
  const VoxelMap& map = loaded.map;
  record.map_name =
      options.map.has_filename() ? options.map.stem().string() : options.map.parent_path().stem().string();
  record.place = options.outputs.city.city.empty() ? record.map_name : options.outputs.city.city;
  record.frame = map.frame;
  record.rule = options.rule;
  if (!is_city(options.map)) record.spaces = parking::read_spaces(options.spaces, map.frame, options.outputs.geo);
  const parking::GroundPlan ground(map.finest());
  check_spaces(options, record.spaces, ground);
  LaterEpoch later = is_map(options.later.front()) ? look_at_map(options, map, record.spaces, ground)
                                                   : look_at_scans(options, common, map, record.spaces, ground);
  record.date = options.date.empty() ? later.date : options.date;
  record.vehicles = std::move(later.evidence.vehicles);
  const auto before = previous_states(loaded, record.spaces, ground);
  for (std::size_t i = 0; i < record.spaces.size(); ++i) {
    record.states.push_back(parking::judge(later.evidence.spaces[i], options.rule));
    record.states.back().previous = before[i];
  }
  if (!is_anything_seen(later.evidence)) {
    spdlog::warn("{}: comes near none of the spaces, nothing is known of them", options.later.front().string());
  }
  write_outputs(options.outputs, record, map, later.map, ground);
  print_summary(options.outputs, record, common);
  const parking::StreetOccupancy street = parking::street_occupancy(record.spaces, record.states);
  return street.num_unknown < street.num_spaces() || street.num_spaces() == 0 ? ExitCode::kDone : ExitCode::kNo;
}

}  // namespace

Command occupancy_command() {
  return make_command<OccupancyCommandOptions>(
      "occupancy", "Tell which parking spaces are taken in a later epoch",
      "vdbmap occupancy labelled.vdb spaces.geojson velodyne/ --poses poses.txt -o occupancy.json --report report.png\n"
      "vdbmap occupancy labelled.vdb spaces.geojson velodyne/ --poses poses.txt -o occupancy.json --geojson "
      "now.geojson\n"
      "vdbmap occupancy labelled.vdb spaces.geojson later.vdb -o occupancy.json --date 2023-03-02 --cds curbs.json",
      add_options, run);
}

}  // namespace vdbmap::cli

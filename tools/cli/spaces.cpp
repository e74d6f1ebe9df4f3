// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <CLI/Option.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "parking/exchange/spaces_file.h"
#include "parking/spaces/find_spaces.h"
#include "tools/cli/command.h"
#include "tools/cli/date_option.h"
#include "tools/cli/geo_output.h"
#include "tools/cli/labelled_map.h"
#include "tools/cli/map_output.h"
#include "tools/cli/output.h"
#include "tools/cli/output_ending.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/file/atomic_file.h"

namespace vdbmap::cli {
namespace {

struct SpacesCommandOptions {
  std::filesystem::path map;
  std::filesystem::path output;
  std::vector<std::filesystem::path> merge;
  std::string date;
  parking::GeoOptions geo;
};

void add_options(CLI::App& app, SpacesCommandOptions& options) {
  app.add_option("MAP", options.map, "A map with classes, as of vdbmap segment, or a city")
      ->type_name("FILE|FOLDER")
      ->required();
  app.add_option("-o,--output", options.output, "Where to write the spaces (GeoJSON)")->type_name("FILE")->required();
  app.add_option("--merge", options.merge,
                 "Spaces that are known already (GeoJSON): of earlier epochs, or a city's own; they keep their ids and "
                 "outlines, and those of the map get new numbers. May be given more than once: ids of the first count")
      ->type_name("FILE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  add_date(app, options.date, "the map, [what its file says]");
  add_geo_options(app, options.geo);
}

// All known spaces. Of a later file those that lie on spaces of an earlier one are these; ids that are taken are given
// anew.
std::vector<parking::ParkingSpace> read_known(const SpacesCommandOptions& options, const MapFrame& frame) {
  constexpr double kSame = 0.5;
  std::vector<parking::ParkingSpace> known;
  for (const std::filesystem::path& file : options.merge) {
    std::set<std::string> ids;
    for (const parking::ParkingSpace& space : known) ids.insert(space.id);
    const std::size_t num_before = known.size();
    for (parking::ParkingSpace& space : parking::read_spaces(file, frame, options.geo)) {
      const parking::UprightBox box = parking::box_of(space);
      const bool is_there = std::any_of(known.begin(), known.begin() + static_cast<std::ptrdiff_t>(num_before),
                                        [&](const auto& other) { return shared_area(box, box_of(other)) >= kSame; });
      if (is_there) continue;
      if (ids.contains(space.id)) {
        spdlog::warn("{}: id '{}' is taken by another space of an earlier file, a new one is given", file.string(),
                     space.id);
        space.id.clear();
      }
      known.push_back(std::move(space));
    }
  }
  return known;
}

void warn_of_doubts(const SpacesCommandOptions& options, const std::vector<std::string>& doubts) {
  if (doubts.empty()) return;
  spdlog::warn("{}: {} boxes are no vehicles and make no spaces; the first: {}", options.map.string(), doubts.size(),
               doubts.front());
}

void report(const SpacesCommandOptions& options, const CommonOptions& common, const parking::FoundSpaces& found) {
  std::size_t num_candidates = 0;
  std::map<std::string, std::size_t> sides;
  for (const parking::ParkingSpace& space : found.spaces) {
    num_candidates += space.is_candidate ? 1 : 0;
    if (!space.is_candidate) ++sides[space.kerb_side.empty() ? "not known" : space.kerb_side];
  }
  const std::size_t num_spaces = found.spaces.size() - num_candidates;
  if (common.json) {
    print_json({{"output", options.output.string()},
                {"vehicles", found.num_vehicles},
                {"doubted", found.doubts.size()},
                {"spaces", num_spaces},
                {"new", found.num_new},
                {"seen_again", found.num_seen_again},
                {"candidates", num_candidates},
                {"kerb_sides", sides}});
    return;
  }
  std::string text = fmt::format("{}: {} spaces, {} of them new; {} candidates on free kerb\n", options.output.string(),
                                 num_spaces, found.num_new, num_candidates);
  for (const auto& [side, count] : sides) text += fmt::format("side {:<10} {:>5}\n", side, count);
  print_result(text);
}

ExitCode run(const SpacesCommandOptions& options, const CommonOptions& common) {
  std::vector<std::filesystem::path> inputs = options.merge;
  inputs.push_back(options.map);
  check_output(options.output, kGeoJsonKind, inputs);
  const VoxelMap map = load_labelled_map(options.map);
  const parking::FoundSpaces found =
      parking::find_spaces(map.finest(), {.date = options.date.empty() ? date_of_map(options.map) : options.date,
                                          .known = read_known(options, map.frame)});
  warn_of_doubts(options, found.doubts);
  if (found.spaces.empty()) {
    spdlog::error("{}: holds no vehicles, so there are no spaces", options.map.string());
    return ExitCode::kNo;
  }
  for (const parking::SpaceOverlap& overlap : parking::find_overlaps(found.spaces)) {
    spdlog::warn("spaces '{}' and '{}' overlap by {:.0f} % of the smaller one", found.spaces[overlap.a].id,
                 found.spaces[overlap.b].id, 100 * overlap.share);
  }
  write_file(options.output, parking::geojson_of(found.spaces, map.frame, options.geo));
  report(options, common, found);
  return ExitCode::kDone;
}

}  // namespace

Command spaces_command() {
  return make_command<SpacesCommandOptions>("spaces", "Make parking spaces of the vehicles in a map",
                                            "vdbmap spaces labelled.vdb -o spaces.geojson --date 2023-03-01\n"
                                            "vdbmap spaces later.vdb -o spaces.geojson --merge earlier.geojson\n"
                                            "vdbmap spaces labelled/ -o spaces.geojson --map-coordinates",
                                            add_options, run);
}

}  // namespace vdbmap::cli

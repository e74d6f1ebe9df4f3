// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/occupancy_outputs.h"

#include <stdexcept>
#include <string>
#include <utility>

#include <CLI/Option.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "parking/report/occupancy_report.h"
#include "tools/cli/geo_output.h"
#include "tools/cli/map_output.h"
#include "tools/cli/output.h"
#include "tools/cli/output_ending.h"
#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/file/text.h"

namespace vdbmap::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string document_text(const Json& json) { return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n"; }

// report.png, report_2.png, ...
std::filesystem::path page_path(const std::filesystem::path& first, std::size_t number) {
  if (number == 1) return first;
  return first.parent_path() / (first.stem().string() + "_" + std::to_string(number) + first.extension().string());
}

std::string percent_text(double share) { return fmt::format("{:.0f} %", 100 * share); }

}  // namespace

void add_occupancy_outputs(CLI::App& app, OccupancyOutputs& outputs) {
  const auto add = [&](const std::string& name, std::optional<std::filesystem::path>& file, const std::string& what) {
    app.add_option(name, file, what)->type_name("FILE");
  };
  app.add_option("-o,--output", outputs.json, "Where to write all that is known, with the evidence (JSON)")
      ->type_name("FILE")
      ->required();
  add("--geojson", outputs.geojson, "Write the spaces with their states and history; the next epoch can start from it");
  add("--csv", outputs.csv, "Write a table");
  add("--cds", outputs.curbs, "Write zones and spaces of the Curb Data Specification; needs an EPSG code and a date");
  add("--fiware", outputs.fiware, "Write FIWARE's ParkingSpot entities; needs an EPSG code");
  add("--report", outputs.report, "Draw pages for people (PNG); the second one is called FILE_2.png, and so on");
  app.add_option("--city", outputs.city.city, "Name of the city or street, from which ids are made, [name of the map]")
      ->type_name("NAME");
  app.add_option("--time-zone", outputs.city.time_zone, "Of the city, for --cds, [Etc/UTC]")->type_name("NAME");
  add_geo_options(app, outputs.geo);
}

void check_outputs(const OccupancyOutputs& outputs, const std::vector<std::filesystem::path>& inputs) {
  std::vector<std::filesystem::path> taken = inputs;
  const auto check = [&](const std::optional<std::filesystem::path>& file, const OutputKind& kind) {
    if (!file) return;
    for (const std::filesystem::path& other : taken) {
      if (other.lexically_normal() == file->lexically_normal()) {
        throw std::invalid_argument(file->string() + ": is an input or another output too, choose another name");
      }
    }
    check_output(*file, kind, inputs);
    taken.push_back(*file);
  };
  check(outputs.json, kJsonKind);
  check(outputs.geojson, kGeoJsonKind);
  check(outputs.csv, kTableKind);
  check(outputs.curbs, kJsonKind);
  check(outputs.fiware, kJsonKind);
  check(outputs.report, kPictureKind);
}

void write_outputs(const OccupancyOutputs& outputs, const parking::OccupancyRecord& record, const VoxelMap& map,
                   const VoxelMap& later, const parking::GroundPlan& ground) {
  parking::CityOptions city = outputs.city;
  city.geoid_offset = outputs.geo.geoid_offset;
  std::vector<std::pair<std::filesystem::path, std::string>> files;
  if (outputs.geojson) files.emplace_back(*outputs.geojson, parking::geojson_of(record, outputs.geo));
  if (outputs.csv) files.emplace_back(*outputs.csv, parking::csv_of(record, outputs.geo));
  if (outputs.curbs) files.emplace_back(*outputs.curbs, document_text(parking::curb_data_of(record, city)));
  if (outputs.fiware) files.emplace_back(*outputs.fiware, document_text(parking::fiware_of(record, city)));
  std::vector<Image> pages;
  if (outputs.report) pages = parking::draw_report(record, map, later, ground);
  write_json(outputs.json, parking::json_of(record));
  for (std::size_t i = 0; i < pages.size(); ++i) write_picture(page_path(*outputs.report, i + 1), pages[i]);
  for (const auto& [file, text] : files) write_file(file, text);
}

void print_summary(const OccupancyOutputs& outputs, const parking::OccupancyRecord& record,
                   const CommonOptions& common) {
  const parking::StreetOccupancy street = parking::street_occupancy(record.spaces, record.states);
  if (common.json) {
    Json json = parking::json_of(record);
    json.erase("spaces");
    json["output"] = outputs.json.string();
    return print_json(json);
  }
  std::string text = fmt::format("{}: {} spaces: {} occupied, {} vacant, {} unknown\n", outputs.json.string(),
                                 street.num_spaces(), street.num_occupied, street.num_vacant, street.num_unknown);
  text += fmt::format("occupancy  {} to {}", percent_text(street.low()), percent_text(street.high()));
  if (street.known()) text += fmt::format(", {} of the spaces that are known", percent_text(*street.known()));
  const parking::StreetTurnover change = parking::turnover(record.spaces, record.states, record.date);
  text += fmt::format("\nchanged    {} of {} spaces known in both epochs: {} became vacant, {} occupied\n",
                      change.num_left + change.num_came, change.num_known, change.num_left, change.num_came);
  if (const std::size_t num_candidates = record.spaces.size() - street.num_spaces()) {
    text += fmt::format("candidates {} on free kerb, not counted\n", num_candidates);
  }
  print_result(text);
}

}  // namespace vdbmap::cli

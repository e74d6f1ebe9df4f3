// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/build_report.h"

#include <set>
#include <string>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "tools/cli/city_summary.h"
#include "tools/cli/map_summary.h"
#include "tools/cli/output.h"
#include "tools/cli/pose_frame.h"

namespace vdbmap::cli {
namespace {

std::size_t count_files(const std::vector<MapInput>& inputs) {
  std::set<std::filesystem::path> files;
  for (const MapInput& input : inputs) files.insert(input.scan.file);
  return files.size();
}

std::string text_of_counts(std::size_t num_scans, std::size_t num_files) {
  const std::string files = fmt::format("{} {}", num_files, num_files == 1 ? "file" : "files");
  return num_scans == num_files ? files : fmt::format("{} scans of {}", num_scans, files);
}

void add_report(nlohmann::ordered_json& json, const BuildReport& report) {
  json["files"] = count_files(report.chosen.inputs);
  json["scans"] = report.chosen.inputs.size();
  if (report.chosen.poses) add_pose_frame(json, *report.chosen.poses);
  json["dropped_points"] = report.notes.num_dropped;
  json["points_out_of_range"] = report.notes.num_out_of_range;
  json["points_of_dropped_classes"] = report.notes.num_of_dropped_classes;
  json["findings"] = report.reading.json();
  json["seconds"] = report.seconds;
}

// "64 files", "1 file", "5 scans of 1 file".
std::string text_of_inputs(const std::vector<MapInput>& inputs) {
  return text_of_counts(inputs.size(), count_files(inputs));
}

std::string text_of_left_out(const BuildReport& report) {
  std::string text;
  if (report.notes.num_dropped > 0) {
    text += fmt::format("dropped    {} points that are not finite\n", report.notes.num_dropped);
  }
  if (report.notes.num_out_of_range > 0) {
    text += fmt::format("left out   {} points out of range\n", report.notes.num_out_of_range);
  }
  if (report.notes.num_of_dropped_classes > 0) {
    text += fmt::format("dropped    {} points of the classes not wanted\n", report.notes.num_of_dropped_classes);
  }
  return text;
}

std::string text_of_changes(const CityBuilt& built, const BuildReport& report) {
  if (!built.removed.empty()) {
    return fmt::format("{} sources removed, {} added", built.removed.size(), built.added.size());
  }
  if (report.chosen.inputs.empty()) return "nothing changed";
  const std::string inputs = text_of_inputs(report.chosen.inputs);
  return built.not_counted.empty() ? "built from " + inputs : fmt::format("{} of {} added", built.added.size(), inputs);
}

}  // namespace

void warn_of(const InputNotes& notes, const std::optional<int>& epsg) {
  for (const ForeignUnit& unit : notes.foreign_units) {
    spdlog::warn("{}: its unit is {} m, but its coordinates are taken as metres", unit.file.string(),
                 unit.metres_per_unit);
  }
  if (notes.epsg_of_files && epsg && notes.epsg_of_files != epsg) {
    spdlog::warn("the files are in EPSG:{}, the map says EPSG:{}", *notes.epsg_of_files, *epsg);
  }
}

void print_built(const MapFromFiles& built, const std::filesystem::path& file, const BuildReport& report,
                 bool as_json) {
  if (as_json) {
    nlohmann::ordered_json json = json_of_map(built.map, file);
    add_report(json, report);
    return print_json(json);
  }
  print_result(fmt::format("{}: built from {} in {:.1f} s\n", file.string(), text_of_inputs(report.chosen.inputs),
                           report.seconds) +
               text_of_left_out(report) + text_of_map(built.map, file));
}

void print_built(const CityBuilt& built, const std::filesystem::path& folder, const BuildReport& report, bool as_json) {
  if (as_json) {
    nlohmann::ordered_json json = json_of_city(built.manifest, folder);
    json["added_sources"] = built.added.size();
    json["not_counted"] = built.not_counted;
    json["removed_sources"] = nlohmann::ordered_json::array();
    for (const MapSource& source : built.removed) json["removed_sources"].push_back(source.name);
    add_report(json, report);
    return print_json(json);
  }
  const std::string what = text_of_changes(built, report);
  print_result(fmt::format("{}: {} in {:.1f} s\n", folder.string(), what, report.seconds) + text_of_left_out(report) +
               text_of_city(built.manifest));
}

}  // namespace vdbmap::cli

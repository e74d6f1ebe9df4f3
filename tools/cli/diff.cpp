// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/Option.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "registration/fine/map_alignment.h"
#include "tools/cli/command.h"
#include "tools/cli/diff_page.h"
#include "tools/cli/diff_report.h"
#include "tools/cli/json_output.h"
#include "tools/cli/map_output.h"
#include "tools/cli/output.h"
#include "tools/cli/progress.h"
#include "tools/cli/short_names.h"
#include "vdbmap/change/change_regions.h"
#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/vdb/diff_file.h"
#include "vdbmap/store/city_diff.h"
#include "vdbmap/store/city_window.h"

namespace vdbmap::cli {
namespace {

struct DiffCommandOptions {
  std::filesystem::path earlier, later;
  std::filesystem::path vdb, csv, geojson, plot;
  JsonOutput json;
  std::vector<std::string> dates;
  bool aligns = false;
  bool has_exit_code = false;
  SaveOptions save;
  StoredDiffOptions stored;
  RegionOptions regions;
};

void add_outputs(CLI::App& app, DiffCommandOptions& options) {
  app.add_option("-o,--output", options.vdb,
                 "Write the changes as a map (.vdb) with the grids appeared, vanished, changed and unobserved")
      ->type_name("FILE");
  add_json_output(app, options.json, "the maps");
  app.add_option("--csv", options.csv, "Write a line a region")->type_name("FILE");
  app.add_option("--geojson", options.geojson, "Write the regions' outlines in WGS 84; the maps must have an EPSG code")
      ->type_name("FILE");
  app.add_option(
         "--plot", options.plot,
         "Draw a page (.png or .jpg): a plan, the largest regions before and after, a table. Loads all of both maps")
      ->type_name("FILE");
  app.add_option("--dates", options.dates, "When the maps were surveyed, for the page; by default what the maps know")
      ->type_name("DAY")
      ->expected(2);
}

void add_limits(CLI::App& app, DiffCommandOptions& options) {
  app.add_flag("--align", options.aligns,
               "Remove what one survey is shifted against the other first. Loads all of both maps");
  app.add_option("--pose-sigma", options.stored.diff.pose_sigma,
                 "[m] standard deviation of one map's place against the other's")
      ->type_name("S")
      ->capture_default_str();
  app.add_option("--range-sigma", options.stored.diff.range_sigma,
                 "[m] of what ranges of a whole surface have in common")
      ->type_name("S")
      ->capture_default_str();
  app.add_option("--significance", options.stored.diff.significance,
                 "How often a difference may be taken for a change by chance")
      ->type_name("P")
      ->capture_default_str();
  app.add_option("--least-volume", options.regions.least_volume, "[m3] of the voxels of a region")
      ->type_name("V")
      ->capture_default_str();
  app.add_flag(
      "--assume-seen", options.stored.diff.takes_unseen_as_empty,
      "Of maps without rays: take what they do not hold as seen empty, so that things may have appeared and vanished");
  app.add_flag("--exit-code", options.has_exit_code, "Exit with 1 where something changed");
}

void add_options(CLI::App& app, DiffCommandOptions& options) {
  app.add_option("EARLIER", options.earlier, "A map (.vdb), or a city or an epoch of it (city@1)")
      ->type_name("FILE")
      ->required();
  app.add_option("LATER", options.later, "The same place later")->type_name("FILE")->required();
  add_outputs(app, options);
  add_limits(app, options);
}

void check_outputs(const DiffCommandOptions& options) {
  const std::vector<std::filesystem::path> inputs = {options.earlier, options.later};
  const OutputKind csv = {"a CSV table", {".csv", ".txt"}}, geojson = {"GeoJSON", {".geojson", ".json"}};
  const auto check = [&](const std::filesystem::path& file, const OutputKind& kind) {
    if (!file.empty()) check_output(file, kind, inputs);
  };
  check(options.vdb, kMapKind);
  check(options.json.file, kJsonKind);
  check(options.csv, csv);
  check(options.geojson, geojson);
  check(options.plot, kPictureKind);
}

void say_alignment(const registration::MapAlignment& alignment) {
  spdlog::info(
      "aligned: the later map is moved by {:.1f} {:.1f} {:.1f} mm in its middle and turned by {:.4f} degrees; {:.0f} % "
      "of it lie on the earlier one",
      1e3 * alignment.shift.x(), 1e3 * alignment.shift.y(), 1e3 * alignment.shift.z(), alignment.turn_deg,
      100 * alignment.inlier_share);
}

void warn_of_blindness(const StoredDiff& stored, const DiffCommandOptions& options) {
  if (options.stored.diff.takes_unseen_as_empty) return;
  const auto warn = [](const std::filesystem::path& map, const char* what) {
    spdlog::warn(
        "{}: knows no rays, so what {} there counts as unobserved (build it with --trajectory, or say "
        "--assume-seen)",
        map.string(), what);
  };
  if (!stored.earlier_has_rays) warn(options.earlier, "appeared");
  if (!stored.later_has_rays) warn(options.later, "vanished");
  if (!stored.do_overlap) spdlog::warn("the maps do not overlap");
}

nlohmann::ordered_json json_of(const registration::MapAlignment& alignment) {
  return {{"shift", {alignment.shift.x(), alignment.shift.y(), alignment.shift.z()}},
          {"turn_deg", alignment.turn_deg},
          {"inlier_share", alignment.inlier_share}};
}

void write_outputs(const DiffCommandOptions& options, const DiffReport& report, const nlohmann::ordered_json& json) {
  if (!options.vdb.empty()) save_diff(options.vdb, report.diff, options.save);
  if (!options.json.file.empty()) write_json(options.json.file, json);
  if (!options.csv.empty()) write_file(options.csv, csv_of(report));
  if (!options.geojson.empty()) write_json(options.geojson, geojson_of(report));
  if (!options.plot.empty()) {
    write_diff_page(options.plot, {options.earlier, options.later, options.dates}, report.diff, report.regions);
  }
}

StoredDiff compare(const DiffCommandOptions& options, const CommonOptions& common) {
  StoredDiffOptions stored = options.stored;
  std::optional<Progress> progress;
  stored.on_block_done = [&](std::size_t num_done, std::size_t num_blocks) {
    if (!progress) progress.emplace("comparing blocks of tiles", num_blocks, common);
    progress->advance(num_done > 0 ? 1 : 0);
  };
  return diff_stored_maps(options.earlier, options.later, stored);
}

ExitCode run(const DiffCommandOptions& given, const CommonOptions& common) {
  DiffCommandOptions options = given;
  check_outputs(options);
  std::optional<registration::MapAlignment> alignment;
  if (options.aligns) {
    alignment = registration::align_maps(load_map_or_city(options.earlier), load_map_or_city(options.later));
    options.stored.diff.earlier_from_later = alignment->earlier_from_later;
    say_alignment(*alignment);
  }
  const StoredDiff stored = compare(options, common);
  warn_of_blindness(stored, options);

  const std::vector<ChangeRegion> regions = find_regions(stored.diff, options.regions);
  const std::vector<std::string> names = short_names({options.earlier, options.later});
  const DiffReport report{names[0], names[1], stored.diff, regions};
  nlohmann::ordered_json json = json_of(report);
  if (alignment) json["alignment"] = json_of(*alignment);
  write_outputs(options, report, json);
  if (options.json.is_on_stdout()) {
    print_json(json);
  } else {
    print_result(text_of(report));
  }
  const ChangeCounts& counts = stored.diff.counts;
  const bool is_changed = counts.appeared + counts.vanished + counts.changed > 0;
  return options.has_exit_code && is_changed ? ExitCode::kNo : ExitCode::kDone;
}

}  // namespace

Command diff_command() {
  return make_command<DiffCommandOptions>(
      "diff", "Tell what appeared, vanished and changed between two maps",
      "vdbmap diff map.vdb map2.vdb\n"
      "vdbmap diff city@1 city@2 -o diff.vdb --json diff.json --geojson regions.geojson\n"
      "vdbmap diff may.vdb june.vdb --align --plot page.png --exit-code",
      add_options, run);
}

}  // namespace vdbmap::cli

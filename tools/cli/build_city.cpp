// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/build_city.h"

#include <optional>
#include <set>
#include <stdexcept>

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "tools/cli/progress.h"
#include "vdbmap/store/source_points.h"

namespace vdbmap::cli {
namespace {

std::size_t count_distinct_files(const std::vector<MapInput>& inputs, const std::vector<SourceReplacement>& replaced) {
  std::set<std::filesystem::path> files;
  for (const MapInput& input : inputs) files.insert(input.scan.file);
  for (const SourceReplacement& replacement : replaced) files.insert(replacement.input.scan.file);
  return files.size();
}

}  // namespace

CityBuilt build_city_of(const std::vector<MapInput>& inputs, const std::vector<SourceReplacement>& replaced,
                        const MapFromFilesOptions& files, const SaveOptions& save, const CitySurvey& survey,
                        const std::filesystem::path& output, const CityOutput& city, const CommonOptions& common) {
  std::optional<Progress> progress;
  progress.emplace("identifying files", count_distinct_files(inputs, replaced), common);
  CityBuildOptions options;
  options.files = files;
  options.save = save;
  options.memory_bytes = city.memory_bytes;
  options.keeps_parts = city.keeps_parts;
  options.removed = city.removed;
  options.replaced = replaced;
  if (city.keep_epochs) options.keep_epochs = *city.keep_epochs;
  options.date = survey.date;
  options.on_file_hashed = [&] { progress->advance(); };
  options.on_reading_begun = [&](std::size_t count) { progress.emplace("building from scans", count, common); };
  options.files.inputs.on_scan_done = [&] { progress->advance(); };
  options.on_tiles_begun = [&](std::size_t count) { progress.emplace("finishing tiles", count, common); };
  options.on_tile_done = [&] { progress->advance(); };
  if (survey.track) {
    options.rays = [&](const std::vector<MapInput>& counted, const std::function<void(const PosedCloud&)>& take) {
      progress.emplace("following rays", counted.size(), common);
      InputOptions in_pieces = options.files.inputs;
      in_pieces.most_points = points_at_once(options.memory_bytes);
      SurveyRays rays(counted, in_pieces, *survey.track);
      rays.for_each(take);
      rays.warn();
    };
  }
  return city.into ? add_to_city(city_folder(*city.into), inputs, options)
                   : build_city(city_folder(output), inputs, options);
}

SourceReplacement parse_replacement(const std::string& text, const ReadOptions& read) {
  const std::size_t middle = text.find('=');
  if (middle == std::string::npos || middle == 0 || middle + 1 == text.size()) {
    throw std::invalid_argument("--replace is " + text + ", expected SOURCE=FILE");
  }
  const std::string file = text.substr(middle + 1);
  const std::vector<ScanPlace> scans = list_scans({file}, read);
  if (scans.size() != 1) {
    throw std::invalid_argument(fmt::format("--replace: {} has {} scans, expected one", file, scans.size()));
  }
  return {text.substr(0, middle), {scans.front()}};
}

void warn_not_counted(const CityBuilt& built) {
  for (const std::string& name : built.not_found) spdlog::warn("{}: is no source of the city, so not removed", name);
  if (built.not_counted.empty()) return;
  const std::size_t num_others = built.not_counted.size() - 1;
  spdlog::warn("{}{}: counted already, left out", built.not_counted.front(),
               num_others == 0 ? "" : fmt::format(" and {} more", num_others));
}

}  // namespace vdbmap::cli

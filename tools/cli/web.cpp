// SPDX-License-Identifier: GPL-3.0-or-later
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/Option.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "tools/cli/command.h"
#include "tools/cli/output.h"
#include "tools/cli/progress.h"
#include "vdbmap/web/site.h"

namespace vdbmap::cli {
namespace {

struct WebCommandOptions {
  std::vector<std::filesystem::path> maps;
  std::filesystem::path output;
  std::string epoch_names;
  SiteOptions site;
};

void add_options(CLI::App& app, WebCommandOptions& options) {
  app.add_option("MAPS", options.maps,
                 "A map (.vdb), or a city with all the epochs it keeps, or one of them (city@1); several are epochs of "
                 "one site, the earliest first")
      ->type_name("FILE|FOLDER...")
      ->required();
  app.add_option("-o,--output", options.output, "Write the site to this folder")->type_name("FOLDER")->required();
  app.add_option("--epoch-names", options.epoch_names, "What the epochs are called: 2023-03,2023-09")
      ->type_name("NAME,...");
  app.add_option("--name", options.site.name, "Of the site; by default that of the last map")->type_name("TEXT");
  app.add_option("--geoid-offset", options.site.geoid_offset,
                 "Height of the geoid above the ellipsoid [m], where the map's heights are above the geoid, [0]")
      ->type_name("M");
}

std::vector<std::string> names_of(const std::string& list) {
  std::vector<std::string> names;
  std::istringstream text(list);
  for (std::string name; std::getline(text, name, ',');) names.push_back(name);
  return names;
}

// "city@2" is epoch 2, "street.vdb" is street.
std::string default_name(const std::filesystem::path& map) {
  const std::string name = (map.has_filename() ? map : map.parent_path()).stem().string();
  const std::size_t at = name.rfind('@');
  return at == std::string::npos ? name : "epoch " + name.substr(at + 1);
}

std::vector<SiteEpoch> site_epochs(const WebCommandOptions& options) {
  std::vector<SiteEpoch> epochs;
  for (const std::filesystem::path& map : options.maps) {
    for (const std::filesystem::path& epoch : epochs_of(map)) epochs.push_back({epoch, default_name(epoch)});
  }
  const std::vector<std::string> names = names_of(options.epoch_names);
  if (!names.empty() && names.size() != epochs.size()) {
    throw std::invalid_argument(fmt::format("--epoch-names has {} names for {} epochs", names.size(), epochs.size()));
  }
  for (std::size_t i = 0; i < names.size(); ++i) epochs[i].name = names[i];
  return epochs;
}

void report(const WebCommandOptions& options, const SiteWritten& site, double seconds, const CommonOptions& common) {
  if (common.json) {
    print_json({{"output", options.output.string()},
                {"voxels", site.num_voxels},
                {"drawn_voxels", site.num_drawn},
                {"tiles", site.num_tiles},
                {"tile_bytes", site.num_tile_bytes},
                {"files_written", site.num_files_written},
                {"files_kept", site.num_files_kept},
                {"on_globe", site.is_on_globe},
                {"seconds", seconds}});
    return;
  }
  print_result(fmt::format("{}: {} voxels in {} tiles, {:.1f} bytes a voxel, {} files written, {} kept, in {:.1f} s\n",
                           options.output.string(), site.num_voxels, site.num_tiles,
                           static_cast<double>(site.num_tile_bytes) / static_cast<double>(site.num_voxels),
                           site.num_files_written, site.num_files_kept, seconds));
}

ExitCode run(const WebCommandOptions& options, const CommonOptions& common) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<SiteEpoch> epochs = site_epochs(options);
  SiteOptions site = options.site;
  if (site.name.empty()) site.name = default_name(options.maps.back());
  std::optional<Progress> progress;
  site.on_tiles_begun = [&](std::size_t num_blocks) {
    progress.emplace("writing blocks of tiles", num_blocks, common);
  };
  site.on_block_done = [&] { progress->advance(); };
  const SiteWritten written = write_site(options.output, epochs, site);
  progress.reset();
  report(options, written, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), common);
  return ExitCode::kDone;
}

}  // namespace

Command web_command() {
  return make_command<WebCommandOptions>("web", "Write a map as a page for the browser",
                                         "vdbmap web map.vdb -o site/\n"
                                         "vdbmap web city/ -o site/ --epoch-names 2023-03,2023-09",
                                         add_options, run);
}

}  // namespace vdbmap::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include <chrono>
#include <filesystem>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tools/cli/command.h"
#include "tools/cli/output.h"
#include "tools/cli/progress.h"
#include "tools/cli/site_server.h"
#include "tools/cli/stop_request.h"
#include "vdbmap/io/file/atomic_folder.h"
#include "vdbmap/web/default_page.h"
#include "vdbmap/web/site.h"
#include "vdbmap/web/site_folder.h"

namespace vdbmap::cli {
namespace {

struct WebCommandOptions {
  std::vector<std::filesystem::path> maps;
  std::filesystem::path output;
  std::string epoch_names;
  SiteOptions site;
  bool is_served = false;
  bool is_opened = false;
  ServerAddress address;
};

void add_options(CLI::App& app, WebCommandOptions& options) {
  app.add_option("MAPS", options.maps,
                 "A map (.vdb), or a city with all the epochs it keeps, or one of them (city@1); several are epochs of "
                 "one site, the earliest first")
      ->type_name("FILE|FOLDER...")
      ->required();
  app.add_option("-o,--output", options.output, "Write the site to this folder")->type_name("FOLDER");
  app.add_option("--epoch-names", options.epoch_names, "What the epochs are called: 2023-03,2023-09")
      ->type_name("NAME,...");
  app.add_option("--diff", options.site.diff,
                 "Mark what changed in the last epoch: a diff of it and the one before (.vdb)")
      ->type_name("FILE");
  app.add_option("--spaces", options.site.spaces,
                 "Parking spaces and their states (GeoJSON of spaces or occupancy), a file an epoch, the latest last")
      ->type_name("FILE...");
  app.add_option("--name", options.site.name, "Of the site; by default that of the last map")->type_name("TEXT");
  app.add_option("--geoid-offset", options.site.geoid_offset,
                 "Height of the geoid above the ellipsoid [m], where the map's heights are above the geoid, [0]")
      ->type_name("M");
  app.add_flag("--serve", options.is_served,
               "Serve the site until Ctrl-C; without --output it is made for that time only. MAPS may also be a site");
  app.add_flag("--open", options.is_opened, "Open the served site in the browser");
  app.add_option("--port", options.address.port, "To serve on, 0: any that is free, [8080]")
      ->check(CLI::Range(0, 65535).description(""))
      ->type_name("N");
  app.add_option("--address", options.address.host,
                 "To serve on, [127.0.0.1]: this computer alone; 0.0.0.0 lets every other one in")
      ->type_name("HOST");
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
  return epochs;
}

void report(const WebCommandOptions& options, const std::filesystem::path& folder, const SiteWritten& site,
            double seconds, const CommonOptions& common) {
  if (common.json && options.is_served) return;  // the address is the result
  if (common.json) {
    print_json({{"output", folder.string()},
                {"voxels", site.num_voxels},
                {"drawn_voxels", site.num_drawn},
                {"tiles", site.num_tiles},
                {"tile_bytes", site.num_tile_bytes},
                {"spaces", site.num_spaces},
                {"files_written", site.num_files_written},
                {"files_kept", site.num_files_kept},
                {"on_globe", site.is_on_globe},
                {"seconds", seconds}});
    return;
  }
  print_result(fmt::format("{}: {} voxels in {} tiles, {:.1f} bytes a voxel, {} files written, {} kept, in {:.1f} s\n",
                           folder.string(), site.num_voxels, site.num_tiles,
                           static_cast<double>(site.num_tile_bytes) / static_cast<double>(site.num_voxels),
                           site.num_files_written, site.num_files_kept, seconds));
}

void check_options(const WebCommandOptions& options) {
  if (options.output.empty() && !options.is_served)
    throw std::invalid_argument("no --output and no --serve: nothing to do");
  if (options.is_opened && !options.is_served) throw std::invalid_argument("--open needs --serve");
}

SiteOptions site_options(const WebCommandOptions& options) {
  SiteOptions site = options.site;
  site.epoch_names = names_of(options.epoch_names);
  if (site.name.empty()) site.name = default_name(options.maps.back());
  const std::optional<std::filesystem::path> page = default_page();
  if (page) site.page = *page;
  return site;
}

void write(const WebCommandOptions& options, const std::filesystem::path& folder, const CommonOptions& common) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<SiteEpoch> epochs = site_epochs(options);
  SiteOptions site = site_options(options);
  std::optional<Progress> progress;
  site.on_tiles_begun = [&](std::size_t num_blocks) {
    progress.emplace("writing blocks of tiles", num_blocks, common);
  };
  site.on_block_done = [&] { progress->advance(); };
  const SiteWritten written = write_site(folder, epochs, site);
  progress.reset();
  if (site.page.empty()) spdlog::warn("vdbmap was built without its page: the site has tiles for other viewers only");
  if (!written.is_on_globe) spdlog::warn("the map has no EPSG code: the site is in local coordinates, on no globe");
  report(options, folder, written, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
         common);
}

// By the desktop's own choice of a program; where there is none, the address was printed.
void open_in_browser(const std::string& url) {
  const pid_t child = ::fork();
  if (child == 0) {
    const int nowhere = ::open("/dev/null", O_RDWR);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, stream);
    ::execlp("xdg-open", "xdg-open", url.c_str(), static_cast<char*>(nullptr));
    ::_exit(1);
  }
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child || status != 0) {
    spdlog::warn("no browser could be opened: open {} yourself", url);
  }
}

void serve(const std::filesystem::path& folder, const WebCommandOptions& options, const CommonOptions& common) {
  constexpr auto kWait = std::chrono::milliseconds(50);
  const StopRequest stop;
  const SiteServer server(folder, options.address);
  if (common.json) {
    print_json({{"url", server.url()}});
  } else {
    print_result(server.url() + " (Ctrl-C ends it)\n");
  }
  if (options.is_opened) open_in_browser(server.url());
  while (!stop.is_made()) std::this_thread::sleep_for(kWait);
}

ExitCode run(const WebCommandOptions& options, const CommonOptions& common) {
  check_options(options);
  if (options.output.empty() && options.maps.size() == 1 && is_site(options.maps.front())) {
    serve(options.maps.front(), options, common);
    return ExitCode::kDone;
  }
  if (!options.output.empty()) {
    write(options, options.output, common);
    if (options.is_served) serve(options.output, options, common);
    return ExitCode::kDone;
  }
  // Never committed, so that it goes however the command ends.
  const AtomicFolder for_now(std::filesystem::temp_directory_path() / "vdbmap-site");
  const std::filesystem::path folder = for_now.temporary_path() / "site";
  write(options, folder, common);
  serve(folder, options, common);
  return ExitCode::kDone;
}

}  // namespace

Command web_command() {
  return make_command<WebCommandOptions>("web", "Write a map as a page for the browser",
                                         "vdbmap web map.vdb -o site/\n"
                                         "vdbmap web city/ -o site/ --epoch-names 2023-03,2023-09\n"
                                         "vdbmap web map.vdb --serve --open\n"
                                         "vdbmap web site/ --serve --port 8000",
                                         add_options, run);
}

}  // namespace vdbmap::cli

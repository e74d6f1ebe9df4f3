// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>

#include <nlohmann/json.hpp>

#include "tools/cli/child_process.h"
#include "tools/cli/command.h"
#include "tools/cli/map_output.h"
#include "tools/cli/map_summary.h"
#include "tools/cli/output.h"
#include "vdbmap/io/vdb/map_channels.h"
#include "vdbmap/io/vdb/map_file.h"

namespace vdbmap::cli {
namespace {

struct ImportOptions {
  std::filesystem::path channels;
  MapOutput output;
};

void add_options(CLI::App& app, ImportOptions& options) {
  app.add_option("CHANNELS", options.channels, "A .vdb file with the grids count, mean, cov_diag, cov_offdiag, ...")
      ->type_name("FILE")
      ->required();
  add_map_output(app, options.output);
}

ExitCode run_here(const ImportOptions& options, const CommonOptions& common) {
  check_output(options.output.file, kMapKind, {options.channels});
  const VoxelMap map = import_channels(options.channels);
  save_map(options.output.file, map, options.output.save);
  if (common.json) {
    print_json(json_of_map(map, options.output.file));
  } else {
    print_result(text_of_map(map, options.output.file));
  }
  return ExitCode::kDone;
}

ExitCode run(const ImportOptions& options, const CommonOptions& common) {
  return run_in_child(
      options.channels, [&] { return run_here(options, common); }, ChildLimits::for_file(options.channels));
}

}  // namespace

Command import_command() {
  return make_command<ImportOptions>("import", "Make a map of exported or hand-made channels",
                                     "vdbmap import channels.vdb -o map.vdb\n"
                                     "vdbmap import from_houdini.vdb -o map.vdb --json",
                                     add_options, run);
}

}  // namespace vdbmap::cli

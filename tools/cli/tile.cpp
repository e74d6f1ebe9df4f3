// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/tile_commands.h"

namespace vdbmap::cli {

Command tile_command() {
  return {"tile",
          "Build a city in stages, on one machine or many",
          "vdbmap tile plan survey/ -o city/\n"
          "vdbmap tile run city.job --jobs 4\n"
          "vdbmap tile submit city.job --slurm\n"
          "vdbmap tile status city.job",
          [](CLI::App&) {},
          [](const CommonOptions&) { return ExitCode::kWrongUsage; },
          {tile_plan_command(), tile_map_command(), tile_reduce_command(), tile_finish_command(), tile_status_command(),
           tile_run_command(), tile_submit_command()}};
}

}  // namespace vdbmap::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/cli/command.h"
#include "vdbmap/stages/finish_stage.h"

/// The stages of a city, each a command: `vdbmap tile STAGE`.
namespace vdbmap::cli {

Command tile_plan_command();
Command tile_map_command();
Command tile_reduce_command();
Command tile_finish_command();
Command tile_status_command();
Command tile_run_command();
Command tile_submit_command();

/// Prints what a job came to: the city, and which sources are not in it.
void print_finished(const Job& job, const JobFinished& finished, const CommonOptions& common);

}  // namespace vdbmap::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/command.h"

namespace vdbmap::cli {

// A new command: its file defines one of these, and its row stands below.
Command build_command();
Command tile_command();
Command info_command();
Command query_command();
Command check_command();
Command export_command();
Command import_command();
Command merge_command();
Command log_command();
Command update_command();
Command diff_command();
Command odometry_command();
Command localize_command();
Command evaluate_command();
Command render_command();
Command segment_command();
Command spaces_command();
Command occupancy_command();
Command web_command();
Command simulate_command();

std::vector<Command> all_commands() {
  return {
      build_command(),   tile_command(),     info_command(),      query_command(),    check_command(),
      export_command(),  import_command(),   merge_command(),     log_command(),      update_command(),
      diff_command(),    odometry_command(), localize_command(),  evaluate_command(), render_command(),
      segment_command(), spaces_command(),   occupancy_command(), web_command(),      simulate_command(),
  };
}

}  // namespace vdbmap::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/command.h"

namespace vdbmap::cli {

// A new command: its file defines one of these, and its row stands below.
Command evaluate_command();

std::vector<Command> all_commands() {
  return {
      evaluate_command(),
  };
}

}  // namespace vdbmap::cli

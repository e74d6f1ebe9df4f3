// SPDX-License-Identifier: GPL-3.0-or-later
// The row of `simulate` in a build without the simulator.
#include <stdexcept>

#include "tools/cli/command.h"

namespace vdbmap::cli {
namespace {

struct NoOptions {};

// Whatever is asked for, the answer is the same.
void allow_anything(CLI::App& app, NoOptions&) { app.allow_extras(); }

ExitCode refuse(const NoOptions&, const CommonOptions&) {
  throw std::invalid_argument("this vdbmap was built without the simulator, which needs Embree 3 (libembree-dev)");
}

}  // namespace

Command simulate_command() {
  return make_command<NoOptions>("simulate", "Not in this build: make a street with exact truth, and scan it",
                                 "vdbmap simulate street", allow_anything, refuse);
}

}  // namespace vdbmap::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/common_options.h"

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>

namespace vdbmap::cli {
namespace {

constexpr int kMaxThreads = 1024;

}  // namespace

void add_common_options(CLI::App& app, CommonOptions& options) {
  const std::string group = "Common options";
  // A command that also writes JSON files has declared an option of its own.
  if (!app.get_option_no_throw("--json")) {
    app.add_flag("--json", options.json, "Print the result as JSON")->group(group);
  }
  app.add_option("--threads", options.num_threads, "Work with at most N threads (0: one a core)")
      ->check(CLI::Range(0, kMaxThreads).description(""))
      ->type_name("N")
      ->capture_default_str()
      ->group(group);
  app.add_flag("--quiet", options.quiet, "No progress and no messages but errors")->group(group);
}

}  // namespace vdbmap::cli

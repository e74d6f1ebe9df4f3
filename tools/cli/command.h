// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/App.hpp>

#include "tools/cli/common_options.h"
#include "tools/cli/exit_code.h"

namespace vdbmap::cli {

/// A row of the command table: `vdbmap NAME ...`.
struct Command {
  std::string name;
  std::string summary;   ///< one line for the list of commands
  std::string examples;  ///< whole command lines, one a line, for the end of the command's help
  std::function<void(CLI::App&)> add_options;
  std::function<ExitCode(const CommonOptions&)> run;  ///< may throw; main reports it
  std::vector<Command> subcommands = {};  ///< `vdbmap NAME SUBCOMMAND ...`; where there are any, one must be given
};

/// A row whose options are one struct: `add_options` binds its fields, `run` gets them filled in.
template <typename Options>
Command make_command(std::string name, std::string summary, std::string examples,
                     void (*add_options)(CLI::App&, Options&), ExitCode (*run)(const Options&, const CommonOptions&)) {
  const auto options = std::make_shared<Options>();
  return {std::move(name),
          std::move(summary),
          std::move(examples),
          [=](CLI::App& app) { add_options(app, *options); },
          [=](const CommonOptions& common) { return run(*options, common); },
          {}};
}

/// All rows, in the order of the help text.
std::vector<Command> all_commands();

}  // namespace vdbmap::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "tools/cli/command.h"
#include "tools/cli/error_report.h"
#include "tools/cli/output.h"
#include "tools/cli/process.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap::cli {
namespace {

constexpr const char* kVersion = "vdbmap " VDBMAP_VERSION;

std::string footer(const std::string& examples) {
  std::string text = "Examples:\n";
  std::istringstream lines(examples);
  for (std::string line; std::getline(lines, line);) text += "  " + line + "\n";
  text.pop_back();
  return text;
}

void add_command(CLI::App& app, const Command& command, CommonOptions& common) {
  CLI::App& subcommand = *app.add_subcommand(command.name, command.summary);
  subcommand.footer(footer(command.examples));
  subcommand.group("Commands");
  if (command.subcommands.empty()) {
    command.add_options(subcommand);
    add_common_options(subcommand, common);
    return;
  }
  subcommand.require_subcommand(1);
  for (const Command& inner : command.subcommands) add_command(subcommand, inner, common);
}

const Command* find_command(const std::vector<Command>& commands, const std::string& name) {
  const auto found = std::find_if(commands.begin(), commands.end(), [&](const Command& c) { return c.name == name; });
  return found == commands.end() ? nullptr : &*found;
}

// CLI11 only says that a subcommand is missing; a user who mistyped one wants to know which.
void check_command_name(const std::vector<Command>& commands, const std::string& before, int argc, char** argv) {
  if (argc < 2) throw std::invalid_argument("no command given, see " + before + " --help");
  const std::string name = argv[1];
  if (name.starts_with("-")) return;
  const Command* command = find_command(commands, name);
  if (!command) throw std::invalid_argument("no command '" + name + "', see " + before + " --help");
  if (!command->subcommands.empty()) {
    check_command_name(command->subcommands, before + " " + name, argc - 1, argv + 1);
  }
}

std::string text_for(const CLI::App& app, const CLI::Success& help_or_version) {
  std::ostringstream text;
  app.exit(help_or_version, text, text);
  return text.str();
}

ExitCode run_chosen(const CLI::App& app, const std::vector<Command>& commands, const CommonOptions& common) {
  if (common.quiet) silence_log();
  const ThreadLimit limit(common.num_threads);
  const CLI::App* chosen = app.get_subcommands().front();
  const Command* command = find_command(commands, chosen->get_name());
  while (!command->subcommands.empty()) {
    chosen = chosen->get_subcommands().front();
    command = find_command(command->subcommands, chosen->get_name());
  }
  return command->run(common);
}

ExitCode run_command_line(int argc, char** argv) {
  CLI::App app("Voxel maps of city streets: build them from point clouds, look into them, find later scans in them.",
               "vdbmap");
  app.set_version_flag("--version", kVersion, "Print the version and stop");
  app.set_help_flag("-h,--help", "Print this help and stop");
  app.get_formatter()->label("SUBCOMMAND", "COMMAND");
  app.require_subcommand(1);
  app.footer("vdbmap COMMAND --help describes a command, with examples.");

  CommonOptions common;
  const std::vector<Command> commands = all_commands();
  for (const Command& command : commands) add_command(app, command, common);
  check_command_name(commands, "vdbmap", argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    print_result(text_for(app, help_or_version));
    return ExitCode::kDone;
  }
  return run_chosen(app, commands, common);
}

}  // namespace
}  // namespace vdbmap::cli

int main(int argc, char** argv) {
  using namespace vdbmap::cli;
  prepare_process();
  return static_cast<int>(report_errors([&] { return run_command_line(argc, argv); }));
}

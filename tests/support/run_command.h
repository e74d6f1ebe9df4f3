// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace vdbmap::test {

/// What a program left behind.
struct CommandResult {
  int exit_code = -1;  ///< -1 where a signal ended it
  int signal = 0;      ///< the signal that ended it, or 0
  std::string out;
  std::string err;
};

struct RunOptions {
  std::chrono::seconds timeout{300};           ///< then the program is killed: a busy machine may be slow
  int out_descriptor = -1;                     ///< stdout goes here instead of into the result
  std::function<void(pid_t)> while_running{};  ///< called once, for example to send a signal
  std::string running_when_err_says{};         ///< what stderr has to say before that; empty: the start is enough
};

/// Runs a program with arguments as they are, without a shell; stdin is empty.
CommandResult run_command(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                          const RunOptions& options = {});

}  // namespace vdbmap::test

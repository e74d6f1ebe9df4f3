// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "tools/cli/exit_code.h"

namespace vdbmap::cli {

/// What a child process may use.
struct ChildLimits {
  std::uint64_t processor_seconds = 60;                 ///< of all its threads
  std::uint64_t memory_bytes = std::uint64_t{8} << 30;  ///< addresses, not all of them in use; 0: no limit

  /// More for larger files: they may take 10 s more for every 100 MB, and 32 times their size more.
  static ChildLimits for_file(const std::filesystem::path& file);
};

/// Runs a whole command in a child process: OpenVDB reads what another program wrote, and on a damaged file it may run
/// for hours, take all memory or crash, in code that is not ours. Errors are reported there, and its exit code is
/// returned. Throws IoError, malformed, naming the file, where the child reached a limit or was ended by a signal; a
/// child outlives this process in no case. To be called before any thread is started.
ExitCode run_in_child(const std::filesystem::path& file, const std::function<ExitCode()>& body,
                      const ChildLimits& limits);

}  // namespace vdbmap::cli

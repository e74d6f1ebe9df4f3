// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace vdbmap::cli {

/// Sets up the process before anything opens a file: Ctrl-C and SIGTERM leave no unfinished file, writing to a closed
/// pipe is an error like any other, no file of ours takes the place of a closed standard stream, memory that runs out
/// where nothing can be thrown ends with one line and exit code 4, and log goes to stderr.
void prepare_process();

/// Ends the process with 128 plus the signal's number and leaves no unfinished file; safe inside a signal handler.
[[noreturn]] void stop_at_once(int signal);

/// Log below errors is dropped from here on.
void silence_log();

}  // namespace vdbmap::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace vdbmap::cli {

/// Sets up the process before anything opens a file: signals that end it (Ctrl-C, SIGTERM, a terminal that is closed,
/// no more processor time) leave no unfinished file, writing to a closed pipe or beyond the limit of file sizes is an
/// error like any other, no file of ours takes the place of a closed standard stream, memory that runs out where
/// nothing can be thrown ends with one line and exit code 4, and log goes to stderr, without control characters in it.
void prepare_process();

/// Has all signals that end the process go to `handler`, but a hang-up that is ignored (nohup) stays so.
void handle_ending_signals(void (*handler)(int));

/// Ends the process with 128 plus the signal's number and leaves no unfinished file; safe inside a signal handler.
[[noreturn]] void stop_at_once(int signal);

/// From here on only our log goes to stderr: what libraries print there, warnings of theirs, failed assertions and what
/// the allocator finds broken, goes nowhere.
void keep_stderr_for_log();

/// Log below errors is dropped from here on.
void silence_log();

}  // namespace vdbmap::cli

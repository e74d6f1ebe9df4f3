// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace vdbmap::cli {

/// Sets up the process before anything opens a file: Ctrl-C and SIGTERM leave no unfinished file, writing to a closed
/// pipe is an error like any other, no file of ours takes the place of a closed standard stream, and log goes to
/// stderr.
void prepare_process();

/// Log below errors is dropped from here on.
void silence_log();

}  // namespace vdbmap::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "tools/cli/exit_code.h"

namespace vdbmap::cli {

/// Runs the body; what it throws becomes one line in the log and an exit code. The one place where that is done.
ExitCode report_errors(const std::function<ExitCode()>& body);

}  // namespace vdbmap::cli

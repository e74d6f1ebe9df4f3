// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/cli/exit_code.h"

namespace vdbmap::cli {

/// While it lives, the first signal that would end the process (Ctrl-C, SIGTERM, a closed terminal) ends nothing by
/// itself but is noted here, for work that has something to save. A second one ends the process at once, as ever. One
/// at a time may live.
class StopRequest {
 public:
  StopRequest();
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  /// Whether a signal came.
  bool is_made() const;

  /// What the command returns then: 128 plus the signal's number, as shells do.
  ExitCode exit_code() const;
};

}  // namespace vdbmap::cli

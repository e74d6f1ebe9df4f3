// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>

#include "tools/cli/common_options.h"

namespace vdbmap::cli {

/// "reading scans: 12 of 64, 3.4/s, 15 s left".
std::string progress_text(const std::string& activity, std::size_t done, std::size_t total,
                          std::chrono::duration<double> elapsed);

/// A line on stderr that shows how far a long piece of work is; only on a terminal and without --quiet. Gone at the
/// end.
class Progress {
 public:
  /// `total` steps are expected; `activity` says what happens: "reading scans".
  Progress(std::string activity, std::size_t total, const CommonOptions& options);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// So many steps more are done. Any thread may call it.
  void advance(std::size_t steps = 1);

 private:
  using Clock = std::chrono::steady_clock;

  std::string activity_;
  std::size_t total_;
  bool shown_;
  std::mutex mutex_;
  std::size_t done_ = 0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_print_ = start_;
};

}  // namespace vdbmap::cli

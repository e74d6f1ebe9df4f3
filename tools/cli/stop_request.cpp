// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/stop_request.h"

#include <atomic>

#include "tools/cli/process.h"

namespace vdbmap::cli {
namespace {

std::atomic<int> noted_signal{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler writes it");

void note_signal(int signal) {
  if (noted_signal.exchange(signal) != 0) stop_at_once(signal);
}

}  // namespace

StopRequest::StopRequest() {
  noted_signal = 0;
  handle_ending_signals(note_signal);
}

StopRequest::~StopRequest() { handle_ending_signals(stop_at_once); }

bool StopRequest::is_made() const { return noted_signal != 0; }

ExitCode StopRequest::exit_code() const { return static_cast<ExitCode>(128 + noted_signal); }

}  // namespace vdbmap::cli

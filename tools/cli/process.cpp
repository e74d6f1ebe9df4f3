// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/process.h"

#include <csignal>

#include <fcntl.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "vdbmap/io/atomic_file.h"
#include "vdbmap/io/atomic_folder.h"

namespace vdbmap::cli {
namespace {

void handle_signals() {
  std::signal(SIGINT, stop_at_once);
  std::signal(SIGTERM, stop_at_once);
  std::signal(SIGPIPE, SIG_IGN);
}

// Opened for reading only, so that writing to a stream that was closed still fails.
void occupy_closed_streams() {
  int descriptor = ::open("/dev/null", O_RDONLY);
  while (descriptor >= 0 && descriptor <= STDERR_FILENO) descriptor = ::open("/dev/null", O_RDONLY);
  if (descriptor > STDERR_FILENO) ::close(descriptor);
}

void log_to_stderr() {
  spdlog::set_default_logger(spdlog::stderr_logger_mt("vdbmap"));
  // On a terminal a progress line may stand where the message goes.
  spdlog::set_pattern(::isatty(STDERR_FILENO) == 1 ? "\r\033[Kvdbmap: %v" : "vdbmap: %v");
  spdlog::set_error_handler([](const std::string&) {});  // stderr is closed or full: there is nobody left to tell
}

}  // namespace

void stop_at_once(int signal) {
  remove_unfinished_files();
  remove_unfinished_folders();
  ::_exit(128 + signal);
}

void prepare_process() {
  occupy_closed_streams();
  handle_signals();
  log_to_stderr();
}

void silence_log() { spdlog::set_level(spdlog::level::err); }

}  // namespace vdbmap::cli

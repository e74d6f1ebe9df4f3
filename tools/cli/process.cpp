// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/process.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "tools/cli/exit_code.h"
#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/file/atomic_folder.h"
#include "vdbmap/io/file/text.h"

namespace vdbmap::cli {
namespace {

void handle_signals() {
  handle_ending_signals(stop_at_once);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

// Opened for reading only, so that writing to a stream that was closed still fails.
void occupy_closed_streams() {
  int descriptor = ::open("/dev/null", O_RDONLY);
  while (descriptor >= 0 && descriptor <= STDERR_FILENO) descriptor = ::open("/dev/null", O_RDONLY);
  if (descriptor > STDERR_FILENO) ::close(descriptor);
}

int message_descriptor = STDERR_FILENO;  // where our messages go

// Memory may run out where nothing can be thrown: in a thread of a library, or in a destructor of OpenVDB's trees while
// an earlier std::bad_alloc is on its way. What is written here needs none.
[[noreturn]] void end_without_memory() {
  remove_unfinished_files();
  remove_unfinished_folders();
  constexpr std::string_view kClearLine = "\r\033[K";  // as the log does
  constexpr std::string_view kMessage = "vdbmap: out of memory\n";
  const auto write_text = [](std::string_view text) {
    [[maybe_unused]] const ssize_t written = ::write(message_descriptor, text.data(), text.size());
  };
  if (::isatty(message_descriptor) == 1) write_text(kClearLine);
  write_text(kMessage);
  ::_exit(static_cast<int>(ExitCode::kInputOutputFailed));
}

std::terminate_handler default_terminate_handler = nullptr;

[[noreturn]] void handle_terminate() {
  try {
    if (std::current_exception()) std::rethrow_exception(std::current_exception());
  } catch (const std::bad_alloc&) {
    end_without_memory();
  } catch (const std::system_error& error) {  // of a thread that cannot be started
    if (error.code() == std::errc::resource_unavailable_try_again) end_without_memory();
  } catch (...) {
  }
  default_terminate_handler();
  std::abort();
}

// A message quotes names and contents of files, which may hold anything: it stays one line of text.
class PrintableMessage : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm& /*time*/, spdlog::memory_buf_t& line) override {
    const std::string text = printable({message.payload.data(), message.payload.size()});
    line.append(text.data(), text.data() + text.size());
  }
  std::unique_ptr<custom_flag_formatter> clone() const override { return std::make_unique<PrintableMessage>(); }
};

std::unique_ptr<spdlog::formatter> message_formatter() {
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  // On a terminal a progress line may stand where the message goes.
  const bool is_terminal = ::isatty(message_descriptor) == 1;
  formatter->add_flag<PrintableMessage>('*').set_pattern(is_terminal ? "\r\033[Kvdbmap: %*" : "vdbmap: %*");
  return formatter;
}

void log_to_stderr() {
  spdlog::set_default_logger(spdlog::stderr_logger_mt("vdbmap"));
  spdlog::set_formatter(message_formatter());
  spdlog::set_error_handler([](const std::string&) {});  // stderr is closed or full: there is nobody left to tell
}

}  // namespace

void stop_at_once(int signal) {
  remove_unfinished_files();
  remove_unfinished_folders();
  ::_exit(128 + signal);
}

void handle_ending_signals(void (*handler)(int)) {
  for (const int signal : {SIGINT, SIGTERM, SIGQUIT, SIGXCPU}) std::signal(signal, handler);
  if (std::signal(SIGHUP, handler) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

void prepare_process() {
  occupy_closed_streams();
  handle_signals();
  default_terminate_handler = std::set_terminate(handle_terminate);
  log_to_stderr();
}

void keep_stderr_for_log() {
  using StreamSink = spdlog::sinks::stdout_sink_base<spdlog::details::console_mutex>;
  const int kept = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  std::FILE* const stream = kept < 0 ? nullptr : ::fdopen(kept, "w");
  if (stream == nullptr || nowhere < 0) return;
  ::dup2(nowhere, STDERR_FILENO);
  ::close(nowhere);
  message_descriptor = kept;
  spdlog::default_logger()->sinks() = {std::make_shared<StreamSink>(stream)};
  spdlog::default_logger()->set_formatter(message_formatter());
}

void silence_log() { spdlog::set_level(spdlog::level::err); }

}  // namespace vdbmap::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/child_process.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>
#include <system_error>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tools/cli/error_report.h"
#include "tools/cli/process.h"
#include "vdbmap/core/error.h"

namespace vdbmap::cli {
namespace {

constexpr int kOutOfMemory = 100;                // no exit code of a command
constexpr std::uint64_t kSecondsOfWaiting = 60;  // for disks and other programs

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kHasAddressSanitizer = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
constexpr bool kHasAddressSanitizer = true;
#else
constexpr bool kHasAddressSanitizer = false;
#endif
#else
constexpr bool kHasAddressSanitizer = false;
#endif

void limit(__rlimit_resource resource, std::uint64_t value) {
  const rlimit soft_and_hard{value, value + 1};  // beyond the hard one, a signal would not tell why
  ::setrlimit(resource, &soft_and_hard);
}

// Whether the limit is ours: a lower one that this process has already stays, and is not the file's fault.
bool limit_memory(std::uint64_t bytes) {
  if (kHasAddressSanitizer) return false;  // which takes terabytes of addresses
  rlimit now{};
  if (bytes == 0 || ::getrlimit(RLIMIT_AS, &now) != 0 || now.rlim_cur <= bytes) return false;
  limit(RLIMIT_AS, bytes);
  return true;
}

[[noreturn]] void end_for_lack_of_memory() { std::_Exit(kOutOfMemory); }

[[noreturn]] void be_the_child(const std::function<ExitCode()>& body, const ChildLimits& limits, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) std::_Exit(EXIT_FAILURE);  // it had ended before
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, limits.processor_seconds);
  ::alarm(static_cast<unsigned>(kSecondsOfWaiting + 4 * limits.processor_seconds));  // one that waits uses no processor
  if (limit_memory(limits.memory_bytes)) std::set_new_handler(end_for_lack_of_memory);
  keep_stderr_for_log();  // OpenVDB warns there and asserts; the answer is one line of ours
  const ExitCode code = report_errors(body);
  std::fflush(nullptr);
  std::_Exit(static_cast<int>(code));
}

int wait_for(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw std::system_error(errno, std::generic_category(), "cannot wait for a child process");
  }
  return status;
}

std::string text_of_signal(int signal, const ChildLimits& limits) {
  if (signal == SIGXCPU || signal == SIGALRM) {
    return "took more than " + std::to_string(limits.processor_seconds) + " s to be read";
  }
  if (signal == SIGKILL) return "took too long to be read, or was ended from outside";
  return "ended the reader by signal " + std::to_string(signal) + " (" + ::strsignal(signal) + ")";
}

}  // namespace

ChildLimits ChildLimits::for_file(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  ChildLimits limits;
  if (error) return limits;
  limits.processor_seconds += size / 10'000'000;
  limits.memory_bytes += 32 * size;
  return limits;
}

ExitCode run_in_child(const std::filesystem::path& file, const std::function<ExitCode()>& body,
                      const ChildLimits& limits) {
  std::fflush(nullptr);  // what is not written yet would be written by both
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), "cannot start a child process");
  if (child == 0) be_the_child(body, limits, parent);

  const int status = wait_for(child);
  if (WIFSIGNALED(status)) {
    throw IoError::malformed(file, "OpenVDB cannot read it: it " + text_of_signal(WTERMSIG(status), limits));
  }
  if (WEXITSTATUS(status) == kOutOfMemory) {
    throw IoError::malformed(file, "OpenVDB cannot read it: it needs more than " +
                                       std::to_string(limits.memory_bytes >> 20) + " MB of memory");
  }
  return static_cast<ExitCode>(WEXITSTATUS(status));
}

}  // namespace vdbmap::cli

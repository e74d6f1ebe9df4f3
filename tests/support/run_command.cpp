// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/run_command.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace vdbmap::test {
namespace {

using Clock = std::chrono::steady_clock;

struct Pipe {
  int read_end = -1;
  int write_end = -1;
};

Pipe open_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe2");
  return {ends[0], ends[1]};
}

// Only calls that are safe between fork and exec.
[[noreturn]] void become(char* const* words, int out, int err) {
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(err, STDERR_FILENO);
  ::execv(words[0], words);
  ::_exit(127);
}

pid_t start(const std::filesystem::path& program, const std::vector<std::string>& arguments, int out, int err) {
  std::vector<char*> words = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);

  const pid_t child = ::fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (child == 0) become(words.data(), out, err);
  return child;
}

// Appends what can be read now; false at the end of the stream.
bool drain(int descriptor, std::string& text) {
  std::array<char, 4096> buffer;
  const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
  if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
  return count > 0 || (count < 0 && errno == EINTR);
}

// Reads both streams to their ends, which come when the child has ended, by itself or at the deadline.
void collect(pid_t child, int out, int err, const RunOptions& options, Clock::time_point deadline,
             CommandResult& result) {
  std::array<pollfd, 2> streams = {{{out, POLLIN, 0}, {err, POLLIN, 0}}};
  std::function<void(pid_t)> while_running = options.while_running;
  while (streams[0].fd >= 0 || streams[1].fd >= 0) {
    if (while_running && result.err.find(options.running_when_err_says) != std::string::npos) {
      std::exchange(while_running, {})(child);
    }
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) ::kill(child, SIGKILL);
    ::poll(streams.data(), streams.size(), left <= 0 ? 1000 : static_cast<int>(left));
    if (streams[0].revents != 0 && !drain(out, result.out)) streams[0].fd = -1;
    if (streams[1].revents != 0 && !drain(err, result.err)) streams[1].fd = -1;
  }
}

void wait_for(pid_t child, CommandResult& result) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
}

}  // namespace

CommandResult run_command(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                          const RunOptions& options) {
  const Clock::time_point deadline = Clock::now() + options.timeout;
  const Pipe out = open_pipe();
  const Pipe err = open_pipe();
  const int out_target = options.out_descriptor >= 0 ? options.out_descriptor : out.write_end;
  const pid_t child = start(program, arguments, out_target, err.write_end);
  ::close(out.write_end);
  ::close(err.write_end);

  CommandResult result;
  collect(child, out.read_end, err.read_end, options, deadline, result);
  ::close(out.read_end);
  ::close(err.read_end);
  wait_for(child, result);
  return result;
}

}  // namespace vdbmap::test

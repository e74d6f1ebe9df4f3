// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/external_program.h"

#include <array>
#include <cerrno>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "vdbmap/core/error.h"

namespace vdbmap::cli {
namespace {

std::string read_to_end(int descriptor) {
  std::string text;
  std::array<char, 4096> chunk;
  ssize_t size = 0;
  while ((size = ::read(descriptor, chunk.data(), chunk.size())) > 0 || (size < 0 && errno == EINTR)) {
    if (size > 0) text.append(chunk.data(), static_cast<std::size_t>(size));
  }
  return text;
}

// stdout and stderr of the program, which end in one pipe; returns 0 or an error.
int start(const std::vector<std::string>& command, int out, pid_t& child) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, out, STDERR_FILENO);
  const int error = ::posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  return error;
}

}  // namespace

std::string output_of_program(const std::vector<std::string>& command) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw IoError::system(command[0], "cannot be run", errno);
  pid_t child = 0;
  const int error = start(command, ends[1], child);
  ::close(ends[1]);
  const std::string text = error == 0 ? read_to_end(ends[0]) : "";
  ::close(ends[0]);
  if (error != 0) throw IoError::system(command[0], "cannot be run", error);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return text;
  throw IoError::system(command[0], "failed, saying '" + text.substr(0, text.find('\n')) + "'", ECANCELED);
}

}  // namespace vdbmap::cli

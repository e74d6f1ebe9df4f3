// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fuzz/openvdb_child.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <string>

#include <fcntl.h>
#include <openvdb/openvdb.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace vdbmap::fuzz {
namespace {

// How a child ends, as its exit code; any other is of a sanitizer.
enum class End : char {
  kRead = 100,
  kRefused,  // by an IoError
  kOther,    // by another exception: ours to turn into an IoError
  kBroken,   // by a signal, a limit or a sanitizer
};

constexpr rlim_t kProcessorSeconds = 1;
constexpr unsigned kSecondsOfWaiting = 5;
constexpr rlim_t kMoreMemory = rlim_t{1} << 30;  // [bytes]
constexpr int kMaxKept = 400;                    // of one run

bool is_child = false;

// Memory that may be written to. The sanitizer maps terabytes of it, so that only what comes on top can be limited.
rlim_t bytes_of_data() {
  std::ifstream sizes("/proc/self/statm");
  rlim_t pages = 0;
  for (int i = 0; i < 6; ++i) sizes >> pages;
  return pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

void limit(__rlimit_resource resource, rlim_t value) {
  const rlimit soft_and_hard{value, value};
  ::setrlimit(resource, &soft_and_hard);
}

[[noreturn]] void exit_with(End end) { std::_Exit(static_cast<int>(end)); }

End end_of_reading(const std::filesystem::path& path, const GridFilter& is_wanted) {
  try {
    read_vdb(path, is_wanted);
  } catch (const IoError&) {
    return End::kRefused;
  } catch (...) {
    return End::kOther;
  }
  return End::kRead;
}

[[noreturn]] void read_and_exit(const std::filesystem::path& path, const GridFilter& is_wanted) {
  is_child = true;
  ::dup2(::open("/dev/null", O_WRONLY), STDERR_FILENO);
  for (const int signal : {SIGABRT, SIGALRM, SIGBUS, SIGFPE, SIGILL, SIGSEGV, SIGXCPU}) std::signal(signal, SIG_DFL);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, kProcessorSeconds);
  limit(RLIMIT_DATA, bytes_of_data() + kMoreMemory);
  ::alarm(kSecondsOfWaiting);
  exit_with(end_of_reading(path, is_wanted));
}

End end_of(pid_t child) {
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child) std::_Exit(EXIT_FAILURE);
  for (const End end : {End::kRead, End::kRefused, End::kOther}) {
    if (WIFEXITED(status) && WEXITSTATUS(status) == static_cast<int>(end)) return end;
  }
  return End::kBroken;
}

// What would else be loaded and set up in each child anew. No thread is started: children would miss it.
void warm_up() {
  static const ThreadLimit one_thread(1);
  openvdb::initialize();
  openvdb::FloatGrid::create()->fill({openvdb::Coord(0), openvdb::Coord(8)}, 1.0F);
  parallel_for(2, [](std::size_t) {});
}

// A process that starts the children, forked before this one grew: a fork copies the tables of all memory in use. The
// file is the same for all of them, its content changes.
class Helper {
 public:
  Helper(const std::filesystem::path& path, const GridFilter& is_wanted) {
    std::array<int, 2> requests, answers;
    if (::pipe(requests.data()) != 0 || ::pipe(answers.data()) != 0) std::abort();
    const pid_t helper = ::fork();
    if (helper < 0) std::abort();
    ::close(requests[helper == 0 ? 1 : 0]);
    ::close(answers[helper == 0 ? 0 : 1]);
    request_ = requests[1];
    answer_ = answers[0];
    if (helper == 0) serve(requests[0], answers[1], path, is_wanted);
  }

  End read() const {
    char byte = 0;
    if (::write(request_, &byte, 1) != 1) std::abort();
    ssize_t size = 0;
    while ((size = ::read(answer_, &byte, 1)) < 0 && errno == EINTR) {  // libFuzzer's clock
    }
    if (size != 1) std::abort();
    return static_cast<End>(byte);
  }

 private:
  [[noreturn]] static void serve(int requests, int answers, const std::filesystem::path& path,
                                 const GridFilter& is_wanted) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    warm_up();
    for (char byte = 0; ::read(requests, &byte, 1) == 1;) {
      const pid_t child = ::fork();
      if (child == 0) read_and_exit(path, is_wanted);
      byte = static_cast<char>(end_of(child));
      if (::write(answers, &byte, 1) != 1) break;
    }
    std::_Exit(0);
  }

  int request_;
  int answer_;
};

void keep(const std::uint8_t* data, std::size_t size) {
  static int num_kept = 0;
  const char* folder = std::getenv("VDBMAP_KEEP_BROKEN");
  if (folder == nullptr || num_kept == kMaxKept) return;
  const std::string name = std::to_string(::getpid()) + "_" + std::to_string(num_kept++) + ".vdb";
  std::ofstream(std::filesystem::path(folder) / name, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
}

}  // namespace

bool openvdb_reads(const std::uint8_t* data, std::size_t size, const GridFilter& is_wanted) {
  static const Helper helper(file_of(data, size), is_wanted);
  file_of(data, size);
  const End end = helper.read();
  if (end == End::kOther) std::abort();
  if (end == End::kBroken) keep(data, size);
  return end == End::kRead;
}

}  // namespace vdbmap::fuzz

// Sanitizers call these before they report; a child ends there, for what it would say takes a second and is not read.
extern "C" void __asan_on_error() {
  if (vdbmap::fuzz::is_child) vdbmap::fuzz::exit_with(vdbmap::fuzz::End::kBroken);
}
extern "C" void __ubsan_on_report() {
  if (vdbmap::fuzz::is_child) vdbmap::fuzz::exit_with(vdbmap::fuzz::End::kBroken);
}

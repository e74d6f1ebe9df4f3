// SPDX-License-Identifier: GPL-3.0-or-later
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include <dlfcn.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

/// Stands before the C library (LD_PRELOAD) and counts the calls that change files. VDBMAP_KILL_AT=n ends the process
/// before the n-th takes effect, as a power cut would; VDBMAP_FULL_AT=n lets the n-th call that writes, and all after
/// it, find no space on the disk.
namespace {

long number_of(const char* variable) {
  const char* text = std::getenv(variable);
  return text ? std::atol(text) : 0;
}

void count_call() {
  static std::atomic<long> num_calls{0};
  static const long kill_at = number_of("VDBMAP_KILL_AT");
  if (++num_calls == kill_at) ::kill(::getpid(), SIGKILL);
}

// Whether a write to the descriptor fails; what goes to the terminal does not count.
bool is_full(int descriptor) {
  static std::atomic<long> num_writes{0};
  static const long full_at = number_of("VDBMAP_FULL_AT");
  if (full_at == 0 || descriptor <= STDERR_FILENO || ++num_writes < full_at) return false;
  errno = ENOSPC;
  return true;
}

template <typename Function>
Function next(const char* name, Function /*like*/) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

ssize_t write(int descriptor, const void* bytes, size_t size) {
  static const auto real = next("write", &write);
  count_call();
  return is_full(descriptor) ? -1 : real(descriptor, bytes, size);
}

ssize_t writev(int descriptor, const iovec* parts, int count) {
  static const auto real = next("writev", &writev);
  count_call();
  return is_full(descriptor) ? -1 : real(descriptor, parts, count);
}

int fsync(int descriptor) {
  static const auto real = next("fsync", &fsync);
  count_call();
  return real(descriptor);
}

int rename(const char* from, const char* to) noexcept {
  static const auto real = next("rename", &rename);
  count_call();
  return real(from, to);
}

int unlink(const char* path) noexcept {
  static const auto real = next("unlink", &unlink);
  count_call();
  return real(path);
}

int unlinkat(int folder, const char* path, int flags) noexcept {
  static const auto real = next("unlinkat", &unlinkat);
  count_call();
  return real(folder, path, flags);
}

int mkdir(const char* path, mode_t mode) noexcept {
  static const auto real = next("mkdir", &mkdir);
  count_call();
  return real(path, mode);
}

int rmdir(const char* path) noexcept {
  static const auto real = next("rmdir", &rmdir);
  count_call();
  return real(path);
}
}

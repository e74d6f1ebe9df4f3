// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/file/module.h"

#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <vector>

#include <dlfcn.h>

namespace vdbmap {
namespace {

// Beside the program, in the build tree as where it is installed; where the linker looks; where it was to be installed.
std::vector<std::filesystem::path> candidates(const std::string& file) {
  std::error_code unknown;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", unknown);
  const std::filesystem::path folder = VDBMAP_MODULE_FOLDER;
  return {program.parent_path() / ".." / folder / file, file,
          std::filesystem::path(VDBMAP_INSTALL_PREFIX) / folder / file};
}

}  // namespace

void* find_in_module(const std::string& file, const char* entry, const char* what) {
  std::string reason;
  for (const std::filesystem::path& path : candidates(file)) {
    void* module = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (module == nullptr) {
      reason = ::dlerror();
      continue;
    }
    void* function = ::dlsym(module, entry);
    if (function != nullptr) return function;
    reason = path.string() + " is of another version";
  }
  throw std::runtime_error(std::string("cannot load ") + what + ": " + reason);
}

}  // namespace vdbmap

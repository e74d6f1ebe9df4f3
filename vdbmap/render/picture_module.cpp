// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/picture_module.h"

#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <vector>

#include <dlfcn.h>

namespace vdbmap {
namespace {

constexpr const char* kFile = "vdbmap_pictures.so";

// Beside the program, in the build tree as where it is installed; where the linker looks; where it was to be installed.
std::vector<std::filesystem::path> candidates() {
  std::error_code unknown;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", unknown);
  const std::filesystem::path folder = VDBMAP_MODULE_FOLDER;
  return {program.parent_path() / ".." / folder / kFile, kFile,
          std::filesystem::path(VDBMAP_INSTALL_PREFIX) / folder / kFile};
}

const PictureModule& load() {
  std::string reason;
  for (const std::filesystem::path& path : candidates()) {
    void* module = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (module == nullptr) {
      reason = ::dlerror();
      continue;
    }
    using Entry = const PictureModule* (*)();
    const auto entry = reinterpret_cast<Entry>(::dlsym(module, "vdbmap_picture_module"));
    if (entry != nullptr) return *entry();
    reason = path.string() + " is of another version";
  }
  throw std::runtime_error("cannot load what draws pictures: " + reason);
}

}  // namespace

const PictureModule& picture_module() {
  static const PictureModule& module = load();
  return module;
}

}  // namespace vdbmap

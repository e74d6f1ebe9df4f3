// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/default_page.h"

#include <system_error>

namespace vdbmap {

std::optional<std::filesystem::path> default_page() {
  const std::filesystem::path folder = VDBMAP_PAGE_FOLDER;
  std::error_code unknown;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", unknown);
  for (const std::filesystem::path& page :
       {program.parent_path().parent_path() / folder, std::filesystem::path(VDBMAP_INSTALL_PREFIX) / folder}) {
    if (std::filesystem::exists(page / "index.html", unknown)) return page;
  }
  return std::nullopt;
}

}  // namespace vdbmap

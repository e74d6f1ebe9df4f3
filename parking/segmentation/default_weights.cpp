// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/segmentation/default_weights.h"

#include <cerrno>
#include <system_error>

#include "vdbmap/core/error.h"

namespace vdbmap::parking {

std::filesystem::path default_weights() {
  const std::filesystem::path file = std::filesystem::path(VDBMAP_DATA_FOLDER) / "street.kpconv";
  std::error_code unknown;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", unknown);
  const std::filesystem::path beside = program.parent_path().parent_path() / file;
  if (!program.empty() && std::filesystem::exists(beside, unknown)) return beside;
  const std::filesystem::path installed = std::filesystem::path(VDBMAP_INSTALL_PREFIX) / file;
  if (std::filesystem::exists(installed, unknown)) return installed;
  throw IoError::system(installed, "cannot find the weights of the network", ENOENT);
}

}  // namespace vdbmap::parking

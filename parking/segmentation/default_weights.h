// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace vdbmap::parking {

/// The weights that come with the program: street.kpconv, in share/vdbmap beside the folder of the program, in the
/// build tree as where it is installed; else where it was to be installed. Throws IoError (system) where they are in
/// neither.
std::filesystem::path default_weights();

}  // namespace vdbmap::parking

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace vdbmap {

/// What the function `entry` of a module returns. Modules are shared libraries of ours, for what few commands need and
/// what would cost all of them time to load: loaded at the call, never unloaded. They lie beside the program, in the
/// build tree as where it is installed, where the linker looks, or where they were to be installed. Throws
/// std::runtime_error that says that `what` cannot be loaded.
const void* load_module(const std::string& file, const char* entry, const char* what);

/// The same, where `entry` returns a pointer to Table.
template <typename Table>
const Table* load_module(const std::string& file, const char* entry, const char* what) {
  return static_cast<const Table*>(load_module(file, entry, what));
}

}  // namespace vdbmap

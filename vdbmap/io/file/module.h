// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace vdbmap {

/// Address of the function `entry` of a module. Modules are shared libraries of ours, for what few commands need and
/// what would cost all of them time to load: loaded at the call, never unloaded. They lie beside the program, in the
/// build tree as where it is installed, where the linker looks, or where they were to be installed. Throws
/// std::runtime_error that says that `what` cannot be loaded.
void* find_in_module(const std::string& file, const char* entry, const char* what);

/// What the function `entry` of a module returns: a pointer to Table.
template <typename Table>
const Table* load_module(const std::string& file, const char* entry, const char* what) {
  return reinterpret_cast<const Table* (*)()>(find_in_module(file, entry, what))();
}

}  // namespace vdbmap

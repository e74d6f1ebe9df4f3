// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace vdbmap {

/// The right to write a city, for one process at a time. The kernel holds it (flock) and takes it back when the process
/// ends, however it ends: no lock is left behind by a crash. The file `lock` in the folder only says who holds it; it
/// is never removed, since a second writer could then lock another file of that name. Readers need no lock.
class CityLock {
 public:
  /// Takes the lock of the folder, or throws IoError (system): another writer has it, whose process and host are named,
  /// or the folder cannot be written.
  explicit CityLock(const std::filesystem::path& city);
  ~CityLock();
  CityLock(const CityLock&) = delete;
  CityLock& operator=(const CityLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace vdbmap

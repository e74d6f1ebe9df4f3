// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace vdbmap {

/// Where a file written at `target` ends up: symbolic links are followed, also to what does not exist yet, so that the
/// link stays and what it points to is replaced. Throws IoError (system) for links that go round in circles, and for
/// those of /proc, which lead to what a process has open (/dev/stdout) and not to a name.
std::filesystem::path follow_links(const std::filesystem::path& target);

/// What is at `target` now, maybe nothing. Throws IoError (system) where that cannot be known: the name is too long,
/// the folder may not be searched.
std::filesystem::file_status status_of_target(const std::filesystem::path& target);

/// A name for what is to become `target`, in the same folder: the target's, shortened where the file system's limits
/// ask for it, a dot and eight random letters. Nothing is created.
std::filesystem::path temporary_name_beside(const std::filesystem::path& target);

}  // namespace vdbmap

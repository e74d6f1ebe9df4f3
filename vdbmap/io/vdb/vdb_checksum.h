// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

/// OpenVDB gives every file a random id. In files of ours a checksum of the rest stands there: so equal content is
/// equal bytes, and damage is seen.
namespace vdbmap {

/// The checksum that a file of ours carries, 20 hexadecimal digits; nothing where it is of another program. Read from
/// its front, and not compared with its content. Throws IoError (system) where it cannot be opened.
std::optional<std::string> stated_checksum(const std::filesystem::path& path);

/// Compares a file of ours with its checksum; returns whether it is one. Throws IoError: malformed where they differ.
bool check_checksum(const std::filesystem::path& path);

/// Replaces the id of a .vdb file by the checksum. Throws std::ios_base::failure.
void write_checksum(const std::filesystem::path& path);

}  // namespace vdbmap

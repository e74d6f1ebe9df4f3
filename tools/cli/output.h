// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace vdbmap::cli {

/// Writes a result of one or several lines to stdout, '?' for each control character in it. Throws IoError (system)
/// where it cannot: a full disk, a pipe that nobody reads.
void print_result(std::string_view text);

/// Writes a result to stdout as indented JSON and a newline; numbers that are not finite become null.
void print_json(const nlohmann::ordered_json& result);

/// Writes the same into a file, atomically. Throws IoError.
void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& result);

}  // namespace vdbmap::cli

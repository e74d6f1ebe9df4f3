// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/output.h"

#include <cerrno>
#include <cstdio>
#include <string>

#include <nlohmann/json.hpp>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/file/text.h"

namespace vdbmap::cli {
namespace {

// A path need not be UTF-8; JSON must be. And it may end up on a terminal.
std::string json_lines(const nlohmann::ordered_json& result) {
  return with_escaped_controls(result.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)) + "\n";
}

void write_to_stdout(std::string_view text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0) throw IoError::system("standard output", "cannot write", errno);
}

}  // namespace

void print_result(std::string_view text) { write_to_stdout(printable_lines(text)); }

void print_json(const nlohmann::ordered_json& result) { write_to_stdout(json_lines(result)); }

void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& result) {
  write_file(path, json_lines(result));
}

}  // namespace vdbmap::cli

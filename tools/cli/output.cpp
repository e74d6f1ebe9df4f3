// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/output.h"

#include <cerrno>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "vdbmap/core/error.h"

namespace vdbmap::cli {

void print_result(std::string_view text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0) throw IoError::system("standard output", "cannot write", errno);
}

void print_json(const nlohmann::ordered_json& result) {
  // A path need not be UTF-8; JSON must be.
  print_result(result.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace vdbmap::cli

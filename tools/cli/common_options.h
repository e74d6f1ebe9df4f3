// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include <CLI/App.hpp>

namespace vdbmap::cli {

/// Options that every command has.
struct CommonOptions {
  bool json = false;            ///< the result as JSON on stdout
  std::size_t num_threads = 0;  ///< at most; 0: all cores
  bool quiet = false;           ///< no progress, no log below errors
};

/// Declares --threads, --quiet and, unless the command has one, --json.
void add_common_options(CLI::App& app, CommonOptions& options);

}  // namespace vdbmap::cli

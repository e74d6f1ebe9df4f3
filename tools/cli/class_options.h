// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "vdbmap/core/label_scheme.h"

namespace vdbmap::cli {

/// Where the classes of points come from, and which of them are not wanted.
struct ClassOptions {
  std::optional<std::filesystem::path> labels;
  std::string scheme_name;
  std::vector<std::string> dropped;  ///< names

  std::optional<LabelScheme> scheme() const { return label_scheme_of(scheme_name); }
};

void add_class_options(CLI::App& app, ClassOptions& options);

}  // namespace vdbmap::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace vdbmap::cli {

/// Whether an output is a city: "city/", or a folder that is there. Anything else is a map in one file.
bool is_city_output(const std::filesystem::path& output);

/// The folder of such an output, without the slash at its end.
std::filesystem::path city_folder(const std::filesystem::path& output);

/// What `build` may be told of a city.
struct CityOutput {
  std::optional<std::filesystem::path> into;
  std::uint64_t memory_bytes = std::uint64_t{2} << 30;
  std::optional<std::size_t> keep_epochs;
  bool keeps_parts = false;
  std::vector<std::string> removed;   ///< names or hashes of sources of `into`
  std::vector<std::string> replaced;  ///< "OLD=FILE"
};

/// Declares --into and --keep-epochs.
void add_city_addition(CLI::App& app, CityOutput& city, CLI::Option* output);

/// Declares --keep-parts.
void add_keep_parts(CLI::App& app, CityOutput& city);

/// Declares these, --remove, --replace and --memory. Of --into and the option `output` one must be given.
void add_city_output(CLI::App& app, CityOutput& city, CLI::Option* output);

/// Declares --memory, [bytes].
void add_memory(CLI::App& app, std::uint64_t& memory_bytes, const std::string& description);

}  // namespace vdbmap::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/map_output.h"

#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>

#include <CLI/Option.hpp>

#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/file/text.h"

namespace vdbmap::cli {
namespace {

constexpr double kMaxDensity = 65504;  // the largest half-precision number, in which it is stored

// CLI::Range lets nan pass.
std::string check_density(const std::string& text) {
  const std::optional<double> density = parse_number(text);
  if (density && *density > 0 && *density <= kMaxDensity) return "";
  return "is '" + text + "', expected a number above 0, at most 65504";
}

}  // namespace

void add_density(CLI::App& app, SaveOptions& save) {
  app.add_option("--density", save.density, "Density of the fog that renderers see [1/m]")
      ->check(check_density)
      ->type_name("D")
      ->capture_default_str();
}

void add_map_output(CLI::App& app, MapOutput& output, bool may_be_city) {
  const std::string file = "Write the map to this .vdb file";
  app.add_option("-o,--output", output.file,
                 may_be_city ? file + " or, with a slash at its end, as a city into this folder" : file)
      ->type_name("FILE")
      ->required();
  add_density(app, output.save);
}

void check_output(const std::filesystem::path& output, const OutputKind& kind,
                  const std::vector<std::filesystem::path>& inputs) {
  for (const std::filesystem::path& input : inputs) {
    std::error_code missing;
    if (std::filesystem::equivalent(output, input, missing)) {
      throw std::invalid_argument(output.string() + ": is an input too, choose another output");
    }
  }
  check_ending(output, kind);
  check_writable(output);
}

}  // namespace vdbmap::cli

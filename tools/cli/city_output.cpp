// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/city_output.h"

#include <limits>
#include <string>
#include <system_error>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>

namespace vdbmap::cli {
namespace {

constexpr std::uint64_t kLeastMemory = std::uint64_t{1} << 20;  // [bytes]

std::string check_memory(const std::string& bytes) {
  return std::stoull(bytes) >= kLeastMemory ? "" : "is " + bytes + " bytes, expected 1M or more";
}

}  // namespace

bool is_city_output(const std::filesystem::path& output) {
  std::error_code missing;
  return output.native().ends_with('/') || std::filesystem::is_directory(output, missing);
}

std::filesystem::path city_folder(const std::filesystem::path& output) {
  return output.has_filename() ? output : output.parent_path();
}

void add_memory(CLI::App& app, std::uint64_t& memory_bytes, const std::string& description) {
  app.add_option("--memory", memory_bytes, description)
      ->transform(CLI::AsSizeValue(false).description(""))
      ->check(CLI::Validator(check_memory, ""))
      ->type_name("BYTES");
}

void add_city_addition(CLI::App& app, CityOutput& city, CLI::Option* output) {
  CLI::Option* into =
      app.add_option("--into", city.into, "Add to this city; a source that is counted in it already is left out")
          ->type_name("FOLDER")
          ->excludes(output);
  app.add_option("--keep-epochs", city.keep_epochs, "Keep only the latest N epochs of the city (default: all)")
      ->check(CLI::Range(std::size_t{1}, std::numeric_limits<std::size_t>::max() / 2).description(""))
      ->type_name("N")
      ->needs(into);
}

void add_keep_parts(CLI::App& app, CityOutput& city) {
  app.add_flag(
      "--keep-parts", city.keeps_parts,
      "Keep the sums of each source in the city: what is added, removed or replaced later gives the same bytes "
      "as building it anew");
}

void add_city_output(CLI::App& app, CityOutput& city, CLI::Option* output) {
  add_city_addition(app, city, output);
  add_keep_parts(app, city);
  CLI::Option* into = app.get_option("--into");
  app.add_option("--remove", city.removed,
                 "Take this source, by its name or hash, out of a city that keeps parts; may be given several times")
      ->type_name("SOURCE")
      ->allow_extra_args(false)
      ->needs(into);
  app.add_option("--replace", city.replaced,
                 "Put the points of a file in place of those of a source of such a city, whose epoch they get; may be "
                 "given several times")
      ->type_name("SOURCE=FILE")
      ->allow_extra_args(false)
      ->needs(into);
  add_memory(app, city.memory_bytes,
             "What building a city may take, as 500M or 2G: beyond, sums of points go through the disk, [2G]");
}

}  // namespace vdbmap::cli

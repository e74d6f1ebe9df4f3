// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/reading.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <CLI/Error.hpp>
#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "vdbmap/io/points/point_fields.h"

namespace vdbmap::cli {
namespace {

std::vector<std::string> parse_names(std::string_view text) {
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    names.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return names;
}

void add_columns(CLI::App& app, const std::string& option, std::vector<std::string>& columns,
                 const std::string& description) {
  const auto parse = [&columns, option](const std::string& text) {
    try {
      check_columns(columns = parse_names(text));
    } catch (const std::invalid_argument& error) {
      throw CLI::ValidationError(option, error.what());
    }
  };
  app.add_option_function<std::string>(option, parse, description)->type_name("NAME,NAME,...");
}

}  // namespace

void add_read_options(CLI::App& app, ReadOptions& options) {
  app.add_flag("--strict", options.strict, "Refuse files that are damaged, instead of using what is left of them");
  const auto choose_sensor = [&options](const std::string& text) {
    options.sensor = parse_sensor_choice(text);
    if (!options.sensor)
      throw CLI::ValidationError("--sensor", "is '" + text + "', expected an address as 192.168.1.201:2368");
  };
  app.add_option_function<std::string>(
         "--sensor", choose_sensor,
         "Which sensor of a .pcap: address of the sender, with or without the port to which it sends (default: the "
         "first on port 2368, else the first)")
      ->type_name("A[:PORT]");
  add_columns(
      app, "--columns", options.columns,
      "What the columns of text files are, - for one that is passed over: x y z r g b intensity time ring label "
      "(default: what a header says, else what their numbers can be)");
  add_columns(app, "--bin-columns", options.bin_columns,
              "What the numbers of a point in .bin files are, as for --columns (default: what they can be; KITTI's are "
              "x,y,z,intensity)");
  const auto parse = [&options](const std::string& name) {
    options.bin_type = name == "float64" ? ScalarType::kFloat64 : ScalarType::kFloat32;
  };
  app.add_option_function<std::string>("--bin-type", parse,
                                       "Type of the numbers in .bin files: float32 or float64 (default: what they can "
                                       "be, with --bin-columns float32)")
      ->check(CLI::IsMember({"float32", "float64"}).description(""))
      ->type_name("NAME");
}

void ReadingReport::add(const std::filesystem::path& file, const ReadFinding& finding) {
  auto row = std::ranges::find_if(rows_, [&](const Row& known) {
    return known.finding.what == finding.what && known.finding.is_damage == finding.is_damage;
  });
  if (row == rows_.end()) row = rows_.insert(row, {file, {}, 0, {finding.what, 0, finding.first, finding.is_damage}});
  row->finding.count += finding.count;
  if (row->last_file != file) ++row->num_files;
  row->last_file = file;
}

void ReadingReport::add(const std::filesystem::path& file, const std::vector<ReadFinding>& findings) {
  for (const ReadFinding& finding : findings) add(file, finding);
}

void ReadingReport::add(const std::vector<FileFinding>& findings) {
  for (const FileFinding& found : findings) add(found.file, found.finding);
}

void ReadingReport::warn() const {
  for (const Row& row : rows_) {
    const std::size_t num_others = row.num_files - 1;
    const std::string others =
        num_others == 0 ? "" : fmt::format(" and {} more file{}", num_others, num_others == 1 ? "" : "s");
    spdlog::warn("{}{}: {}", row.first_file.string(), others, row.finding.text());
  }
}

nlohmann::ordered_json ReadingReport::json() const {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Row& row : rows_) {
    json.push_back({{"what", row.finding.what},
                    {"count", row.finding.count},
                    {"first", row.finding.first},
                    {"files", row.num_files},
                    {"first_file", row.first_file.string()},
                    {"is_damage", row.finding.is_damage}});
  }
  return json;
}

std::vector<std::filesystem::path> list_inputs(const std::vector<std::filesystem::path>& inputs,
                                               ReadingReport& report) {
  PointFiles found = find_point_files(inputs);
  report.add(found.findings);
  return std::move(found.files);
}

}  // namespace vdbmap::cli

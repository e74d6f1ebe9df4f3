// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/reading.h"

#include <algorithm>
#include <string>
#include <utility>

#include <CLI/Error.hpp>
#include <CLI/Option.hpp>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

namespace vdbmap::cli {

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

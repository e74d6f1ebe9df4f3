// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/reading.h"

#include <algorithm>

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

namespace vdbmap::cli {

void add_read_options(CLI::App& app, ReadOptions& options) {
  app.add_flag("--strict", options.strict, "Refuse files that are damaged, instead of using what is left of them");
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

}  // namespace vdbmap::cli

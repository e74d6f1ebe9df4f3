// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/output_folder.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

#include "tools/simulator/street_json.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/file/text.h"

namespace vdbmap::simulator {
namespace {

// Whether a simulation writes something of this name.
bool is_ours(const std::string& name) {
  if (name == "street.json" || name == "spaces.geojson" || name == "changes.csv") return true;
  const std::string epoch = "epoch";
  return name.starts_with(epoch) && name.size() > epoch.size() &&
         std::all_of(name.begin() + 5, name.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

bool is_simulation(const std::filesystem::path& folder) {
  std::ifstream file(folder / "street.json");
  const nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
  return json.is_object() && json.contains("generator") && json["generator"] == kGenerator;
}

}  // namespace

void check_output_folder(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder) || std::filesystem::is_empty(folder)) return;
  if (std::filesystem::equivalent(folder, std::filesystem::current_path())) {
    throw std::invalid_argument("the output folder is the one in which the command runs, name another");
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (is_ours(name)) continue;
    throw IoError::malformed(folder, "holds " + vdbmap::quoted(name) + ", which no simulation wrote; not replaced");
  }
  if (!is_simulation(folder)) throw IoError::malformed(folder, "is not an earlier simulation; not replaced");
}

}  // namespace vdbmap::simulator

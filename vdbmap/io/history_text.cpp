// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/history_text.h"

#include <nlohmann/json.hpp>

#include "vdbmap/core/error.h"

namespace vdbmap {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const MapChanges& changes) {
  return {{"added", changes.added}, {"confirmed", changes.confirmed}, {"replaced", changes.replaced},
          {"gone", changes.gone},   {"unseen", changes.unseen},       {"moved", changes.moved}};
}

MapChanges changes_of(const Json& json) {
  const auto count = [&](const char* name) { return json.at(name).get<std::uint64_t>(); };
  return {count("added"), count("confirmed"), count("replaced"), count("gone"), count("unseen"), count("moved")};
}

}  // namespace

std::string text_of(const MapHistory& history) {
  Json epochs = Json::array();
  for (const MapEpoch& epoch : history.epochs) {
    epochs.push_back({{"epoch", epoch.number}, {"date", epoch.date}, {"changes", json_of(epoch.changes)}});
  }
  Json sources = Json::array();
  for (const MapSource& source : history.sources) {
    sources.push_back(
        {{"name", source.name}, {"hash", source.hash}, {"points", source.num_points}, {"epoch", source.epoch}});
  }
  // Names of files may hold bytes that are no UTF-8.
  return Json{{"epochs", epochs}, {"sources", sources}}.dump(-1, ' ', false, Json::error_handler_t::replace);
}

MapHistory parse_map_history(std::string_view text, const std::filesystem::path& path) {
  try {
    const Json json = Json::parse(text);
    MapHistory history;
    for (const Json& epoch : json.at("epochs")) {
      history.epochs.push_back({epoch.at("epoch").get<std::int32_t>(), epoch.at("date").get<std::string>(),
                                changes_of(epoch.at("changes"))});
    }
    for (const Json& source : json.at("sources")) {
      history.sources.push_back({source.at("name").get<std::string>(), source.at("hash").get<std::string>(),
                                 source.at("points").get<std::uint64_t>(), source.at("epoch").get<std::int32_t>()});
    }
    return history;
  } catch (const Json::exception& error) {
    throw IoError::malformed(path, std::string("metadata 'history' cannot be read: ") + error.what());
  }
}

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/city_check.h"

#include <algorithm>
#include <map>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/store/city_window.h"
#include "vdbmap/store/kept_parts.h"

namespace vdbmap {
namespace {

// A message without the path before it.
std::string without_path(const std::string& message, const std::filesystem::path& path) {
  const std::string front = path.string() + ": ";
  return message.starts_with(front) ? message.substr(front.size()) : message;
}

// A tile as one manifest has it.
struct NamedTile {
  const City* city;
  const CityTile* tile;
};

std::vector<std::string> broken_rules(const std::filesystem::path& path) {
  std::vector<std::string> problems;
  for (const RuleResult& rule : check_map_file(path)) {
    if (!rule.passed) problems.push_back(rule.name + ": " + rule.detail);
  }
  return problems;
}

// OpenVDB reads nothing but files of ours that are whole: load_tile() has compared name, checksum and content.
std::vector<std::string> problems_of(const NamedTile& named) {
  const std::filesystem::path path = tile_path(named.city->folder, *named.tile);
  try {
    if (!load_tile(*named.city, *named.tile)) return {"is missing"};
    if (std::filesystem::file_size(path) != named.tile->num_bytes) return {"has another size than the manifest says"};
    return broken_rules(path);
  } catch (const std::exception& error) {
    return {without_path(error.what(), path)};
  }
}

// A part as one manifest has it.
struct NamedPart {
  MapSource source;
  CityPart part;
};

std::vector<std::string> problems_of(const std::filesystem::path& folder, const NamedPart& named) {
  try {
    check_sums(open_kept_source(folder, named.source, named.part).part);
    return {};
  } catch (const std::exception& error) {
    return {without_path(error.what(), kept_part_path(folder, named.part))};
  }
}

// The parts of all epochs, each once.
std::vector<NamedPart> parts_of(const std::vector<City>& cities) {
  std::map<std::string, NamedPart> parts;
  for (const City& city : cities) {
    for (const MapSource& source : city.manifest.sources) {
      const CityPart* part = find_part(city.manifest, source.hash);
      if (part) parts.try_emplace(part->hash, NamedPart{source, *part});
    }
  }
  std::vector<NamedPart> list;
  for (auto& [hash, part] : parts) list.push_back(std::move(part));
  return list;
}

// The epochs whose manifests can be read.
std::vector<City> open_epochs(const std::filesystem::path& folder, CityCheckResult& result) {
  std::vector<City> cities = {open_city(folder)};
  for (const std::int32_t epoch : list_epochs(folder)) {
    try {
      cities.push_back(open_city(folder.string() + "@" + std::to_string(epoch)));
      if (cities.back().manifest.epoch != epoch) {
        result.problems.push_back(
            {epoch_path(folder, epoch), "is of epoch " + std::to_string(cities.back().manifest.epoch)});
      }
    } catch (const IoError& error) {
      const std::filesystem::path file = epoch_path(folder, epoch);
      result.problems.push_back({file, without_path(error.what(), file)});
    }
  }
  return cities;
}

}  // namespace

CityCheckResult check_city(const std::filesystem::path& folder, const std::function<void()>& on_tile_done) {
  CityCheckResult result;
  const std::vector<City> cities = open_epochs(folder, result);
  std::map<std::filesystem::path, NamedTile> tiles;
  for (const City& city : cities) {
    for (const CityTile& tile : city.manifest.tiles)
      tiles.try_emplace(tile_path(folder, tile), NamedTile{&city, &tile});
  }
  const std::vector<std::pair<std::filesystem::path, NamedTile>> list(tiles.begin(), tiles.end());
  const std::vector<NamedPart> parts = parts_of(cities);
  std::vector<std::vector<std::string>> problems(list.size() + parts.size());
  parallel_for(problems.size(), [&](std::size_t i) {
    problems[i] = i < list.size() ? problems_of(list[i].second) : problems_of(folder, parts[i - list.size()]);
    on_tile_done();
  });
  for (std::size_t i = 0; i < problems.size(); ++i) {
    const std::filesystem::path file =
        i < list.size() ? list[i].first : kept_part_path(folder, parts[i - list.size()].part);
    for (const std::string& what : problems[i]) result.problems.push_back({file, what});
  }
  result.num_epochs = cities.size();
  result.num_tiles = list.size();
  result.num_parts = parts.size();
  return result;
}

}  // namespace vdbmap

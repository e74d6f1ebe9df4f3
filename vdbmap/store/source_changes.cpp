// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/source_changes.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <span>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "vdbmap/store/source_hash.h"

namespace vdbmap {
namespace {

// The source of that hash, or else name; nothing where there is none.
const MapSource* find_source(const City& city, const std::string& name_or_hash) {
  const MapSource* found = nullptr;
  for (const MapSource& source : city.manifest.sources) {
    if (source.hash == name_or_hash) return &source;
    if (source.name != name_or_hash) continue;
    if (found) {
      throw std::invalid_argument(city.folder.string() + ": has several sources " + name_or_hash +
                                  ", name one by its hash (vdbmap log --json)");
    }
    found = &source;
  }
  return found;
}

// An input and what tells it from others, with its epoch.
struct Candidate {
  MapInput input;
  MapSource source;
};

std::vector<Candidate> candidates_of(const std::optional<City>& base, const std::vector<MapInput>& inputs,
                                     const CityBuildOptions& options) {
  std::vector<MapInput> all = inputs;
  for (const SourceReplacement& replacement : options.replaced) all.push_back(replacement.input);
  const std::vector<MapSource> sources = identify_sources(all, options.on_file_hashed);
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < all.size(); ++i) {
    candidates.push_back({all[i], sources[i]});
    candidates.back().source.epoch = options.files.build.epoch.value_or(base ? base->manifest.epoch : 0);
  }
  return candidates;
}

// Takes replaced sources out. Their successors, the last candidates, are of the same epoch.
void replace(const City& base, const CityBuildOptions& options, std::span<Candidate> successors,
             std::set<std::string>& removed) {
  for (std::size_t i = 0; i < options.replaced.size(); ++i) {
    MapSource& successor = successors[i].source;
    const std::string& name = options.replaced[i].source;
    if (const MapSource* found = find_source(base, name)) {
      successor.epoch = found->epoch;
      if (found->hash != successor.hash) removed.insert(found->hash);
    } else if (std::ranges::count(base.manifest.sources, successor.hash, &MapSource::hash) == 0) {
      throw std::invalid_argument(base.folder.string() + ": has no source " + name + " that could be replaced");
    }
  }
}

void remove(const City& base, const CityBuildOptions& options, std::set<std::string>& removed,
            std::vector<std::string>& not_found) {
  for (const std::string& name : options.removed) {
    if (const MapSource* found = find_source(base, name)) {
      removed.insert(found->hash);
    } else {
      not_found.push_back(name);
    }
  }
}

void count(std::vector<Candidate> candidates, std::set<std::string> known, SourceChanges& changes) {
  std::ranges::stable_sort(candidates, {}, [](const Candidate& c) { return std::tie(c.source.name, c.source.hash); });
  for (Candidate& candidate : candidates) {
    if (!known.insert(candidate.source.hash).second) {
      changes.not_counted.push_back(candidate.source.name);
      continue;
    }
    changes.inputs.push_back(std::move(candidate.input));
    changes.sources.push_back(std::move(candidate.source));
  }
}

}  // namespace

SourceChanges find_changes(const std::optional<City>& base, const std::vector<MapInput>& inputs,
                           const CityBuildOptions& options) {
  SourceChanges changes;
  std::vector<Candidate> candidates = candidates_of(base, inputs, options);
  std::set<std::string> known;
  if (base) {
    std::set<std::string> removed;
    replace(*base, options, std::span(candidates).subspan(inputs.size()), removed);
    remove(*base, options, removed, changes.not_found);
    for (const MapSource& source : base->manifest.sources) {
      if (removed.contains(source.hash)) {
        changes.removed.push_back(source);
      } else {
        known.insert(source.hash);
      }
    }
  }
  const bool is_left = !known.empty();
  count(std::move(candidates), std::move(known), changes);
  if (base && !changes.removed.empty() && changes.inputs.empty() && !is_left) {
    throw std::invalid_argument(base->folder.string() + ": would be left without a source");
  }
  return changes;
}

}  // namespace vdbmap

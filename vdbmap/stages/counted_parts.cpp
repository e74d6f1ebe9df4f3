// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/stages/counted_parts.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <system_error>
#include <tuple>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/core/parallel_tasks.h"
#include "vdbmap/store/tile_finish.h"

namespace vdbmap {
namespace {

Part part_of_source(const Job& job, std::size_t source) {
  std::error_code error;
  if (std::filesystem::exists(part_path(job.folder, source), error)) return open_part(job, source);
  throw IoError::malformed(part_path(job.folder, source),
                           "is missing: source " + std::to_string(source) + " is not mapped yet");
}

// All parts that there should be, in the order in which sources are counted.
std::vector<Part> all_parts(const Job& job, std::vector<LeftOutSource>& left_out) {
  const std::size_t count = job.plan.sources.size();
  std::vector<std::optional<Part>> opened(count);
  std::vector<std::optional<LeftOutSource>> reasons(count);
  parallel_tasks(count, [&](std::size_t i) {
    std::error_code error;
    if (!std::filesystem::exists(part_path(job.folder, i), error)) reasons[i] = left_out_source(job, i);
    if (!reasons[i]) opened[i] = part_of_source(job, i);
  });
  std::vector<Part> parts;
  for (std::size_t i = 0; i < count; ++i) {
    if (opened[i]) parts.push_back(std::move(*opened[i]));
    if (reasons[i]) left_out.push_back(std::move(*reasons[i]));
  }
  std::ranges::stable_sort(parts, {},
                           [](const Part& part) { return std::tie(part.found.source.name, part.found.source.hash); });
  return parts;
}

// What the parts have in common.
void agree(CountedParts& counted, const JobPlan& plan) {
  std::vector<const PartNotes*> found;
  for (const Part& part : counted.parts) found.push_back(&part.found);
  CommonNotes common = common_notes(found);
  counted.notes = std::move(common.notes);
  check_any_point(counted.notes);
  counted.added =
      layout_of_points(*plan.files.build.anchor, common.kinds, counted.notes, plan.files.build, plan.save.density);
}

CityLayout layout_with(const std::optional<City>& base, const CityLayout& added) {
  if (!base) return added;
  try {
    return merged_layout(base->manifest.layout, added);
  } catch (const std::invalid_argument& error) {
    throw IoError::malformed(base->folder, error.what());
  }
}

}  // namespace

CountedParts open_parts(const Job& job) {
  CountedParts counted;
  if (job.plan.adds) counted.base = open_city(job.plan.city);
  counted.left_out = job.plan.left_out;
  std::set<std::string> known;
  if (counted.base) {
    for (const MapSource& source : counted.base->manifest.sources) known.insert(source.hash);
  }
  counted.epoch = job.plan.files.build.epoch.value_or(counted.base ? counted.base->manifest.epoch : 0);
  for (Part& part : all_parts(job, counted.left_out)) {
    const MapSource& source = part.found.source;
    if (!known.insert(source.hash).second) {
      counted.not_counted.push_back(source.name);
      continue;
    }
    counted.sources.push_back(source);
    counted.sources.back().epoch = counted.epoch;
    counted.parts.push_back(std::move(part));
  }
  if (counted.parts.empty() && counted.not_counted.empty()) {
    throw IoError::malformed(job.folder, "has no source that is not left out");
  }
  if (counted.parts.empty()) {
    counted.layout = counted.base->manifest.layout;
    return counted;
  }
  agree(counted, job.plan);
  counted.layout = layout_with(counted.base, counted.added);
  return counted;
}

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/stages/plan_stage.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/store/city_base.h"
#include "vdbmap/store/city_writer.h"
#include "vdbmap/store/source_hash.h"
#include "vdbmap/store/source_points.h"

namespace vdbmap {
namespace {

constexpr std::uint64_t kBytesOfBucket = std::uint64_t{1} << 30;  // of inputs
constexpr std::uint64_t kLeastBuckets = 4;
constexpr std::uint64_t kMostBuckets = 1000;  // what a job array of Slurm takes as it comes

std::uint64_t size_of_input(const MapInput& input) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(input.scan.file, error);
  if (error) throw IoError::system(input.scan.file, "cannot open", error.value());
  return size;
}

std::vector<PlannedSource> planned_sources(const std::vector<MapInput>& inputs) {
  std::vector<PlannedSource> sources;
  for (MapInput input : inputs) {
    input.scan.file = std::filesystem::absolute(input.scan.file).lexically_normal();
    if (input.labels) input.labels = std::filesystem::absolute(*input.labels).lexically_normal();
    const std::uint64_t size = size_of_input(input);
    sources.push_back({std::move(input), size});
  }
  std::ranges::stable_sort(sources, {}, [](const PlannedSource& source) {
    return std::tuple(source_name(source.input), source.input.scan.file, source.input.scan.turn);
  });
  return sources;
}

// Sources of one name are counted in the order of their hashes.
void sort_namesakes(std::vector<PlannedSource>& sources, std::size_t first) {
  const std::string name = source_name(sources[first].input);
  std::vector<std::pair<std::string, PlannedSource>> namesakes;
  for (std::size_t i = first; i < sources.size() && source_name(sources[i].input) == name; ++i) {
    namesakes.emplace_back("", sources[i]);
  }
  if (namesakes.size() < 2) return;
  for (auto& [hash, source] : namesakes) hash = identify_source(source.input).hash;
  std::ranges::stable_sort(namesakes, {}, [](const auto& namesake) { return namesake.first; });
  for (std::size_t i = 0; i < namesakes.size(); ++i) sources[first + i] = std::move(namesakes[i].second);
}

// The anchor that the first source with points decides; sources before it that cannot be read are left out.
void choose_anchor_of(JobPlan& plan, const JobOptions& options) {
  std::size_t i = 0;
  while (!plan.files.build.anchor) {
    if (i == plan.sources.size()) throw std::invalid_argument("no point of the scans is within the range");
    sort_namesakes(plan.sources, i);
    const MapInput& input = plan.sources[i].input;
    try {
      plan.files.build.anchor = anchor_of_source(input, plan.files, options.memory_bytes);
      ++i;
    } catch (const IoError& error) {
      if (!options.skips_bad || error.kind() != IoError::Kind::kMalformed) throw;
      plan.left_out.push_back({source_name(input), error.what()});
      plan.sources.erase(plan.sources.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
}

// Before hours of work: whether the city can be written, and may become that of the job. Its writer leaves a new folder
// as it was.
void check_target(const std::filesystem::path& folder, const JobPlan& plan) {
  const std::filesystem::path job = std::filesystem::absolute(folder).lexically_normal();
  if (job == plan.city) throw std::invalid_argument(folder.string() + ": cannot be both the job and the city");
  const CityWriter writer(plan.city);
  if (!plan.adds && writer.num_epochs() > 1) {
    throw std::invalid_argument(plan.city.string() +
                                ": is a city of several epochs, choose another output or add to it");
  }
}

// A job merges what it made with the city's tiles, which is not what the sums of all sources would give.
void check_without_parts(const City& city, bool keeps_parts_too) {
  const std::string folder = city.folder.string();
  if (keeps_parts(city.manifest)) {
    throw std::invalid_argument(folder + ": keeps the sums of its sources: add to it by build --into");
  }
  if (keeps_parts_too) {
    throw std::invalid_argument(folder + ": does not keep the sums of its sources, so those of new ones are of no use");
  }
}

std::size_t number_of_buckets(const std::vector<PlannedSource>& sources) {
  std::uint64_t num_bytes = 0;
  for (const PlannedSource& source : sources) num_bytes += source.num_bytes;
  return std::clamp(num_bytes / kBytesOfBucket, kLeastBuckets, kMostBuckets);
}

}  // namespace

Job plan_job(const std::filesystem::path& folder, const std::vector<MapInput>& inputs, const JobOptions& options) {
  options.files.build.check();
  if (inputs.empty()) throw std::invalid_argument("no scans to build a map from");
  JobPlan plan;
  plan.city = std::filesystem::absolute(options.city).lexically_normal();
  plan.adds = options.adds;
  plan.files = options.files;
  plan.save = options.save;
  plan.keep_epochs = options.keep_epochs;
  plan.keeps_parts = options.keeps_parts;
  if (plan.adds) open_city(plan.city);  // is no new folder
  check_target(folder, plan);
  if (plan.adds) {
    const City city = open_city(plan.city);
    check_without_parts(city, plan.keeps_parts);
    fit_to_city(city, plan.files, plan.save);
  }
  plan.city_state = city_state(plan.city);
  plan.sources = planned_sources(inputs);
  plan.num_buckets = options.num_buckets > 0 ? options.num_buckets : number_of_buckets(plan.sources);
  choose_anchor_of(plan, options);
  return create_job(folder, plan);
}

}  // namespace vdbmap

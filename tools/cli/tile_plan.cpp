// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "tools/cli/build_options.h"
#include "tools/cli/city_output.h"
#include "tools/cli/map_output.h"
#include "tools/cli/output.h"
#include "tools/cli/tile_commands.h"
#include "vdbmap/stages/plan_stage.h"

namespace vdbmap::cli {
namespace {

constexpr std::size_t kMostBuckets = 100'000;

struct TilePlanOptions {
  MapBuildOptions points;
  std::filesystem::path output;
  SaveOptions save;
  CityOutput city;
  std::filesystem::path job;
  std::size_t num_buckets = 0;
  bool skips_bad = false;
};

void add_plan_options(CLI::App& app, TilePlanOptions& options) {
  add_map_build_options(app, options.points);
  CLI::Option* output =
      app.add_option("-o,--output", options.output, "Folder of the city to be made")->type_name("FOLDER");
  add_density(app, options.save);
  add_city_addition(app, options.city, output);
  add_keep_parts(app, options.city);
  app.add_option("--job", options.job, "Folder of the job (default: that of the city, with .job at its end)")
      ->type_name("FOLDER");
  app.add_option("--buckets", options.num_buckets,
                 "Finish tiles in so many tasks (default: one a GB of inputs, 4 to 1000)")
      ->check(CLI::Range(std::size_t{1}, kMostBuckets).description(""))
      ->type_name("N");
  app.add_flag("--skip-bad", options.skips_bad,
               "Leave the first source out, by name, where its content cannot be read for the anchor, and go on");
}

std::filesystem::path city_of(const TilePlanOptions& options) {
  if (options.output.empty() && !options.city.into) throw std::invalid_argument("--output or --into is required");
  return city_folder(options.city.into ? *options.city.into : options.output);
}

std::filesystem::path job_folder_of(const TilePlanOptions& options) {
  if (!options.job.empty()) return city_folder(options.job);
  return city_of(options) += ".job";
}

JobOptions job_options(const TilePlanOptions& options, const CommonOptions& common) {
  JobOptions job;
  job.city = city_of(options);
  job.adds = options.city.into.has_value();
  const BuildOptions build =
      job.adds ? build_options_into(job.city, options.points, options.save.density) : build_options(options.points);
  job.files = files_options(build, options.points, common);
  job.save = options.save;
  if (options.city.keep_epochs) job.keep_epochs = *options.city.keep_epochs;
  job.keeps_parts = options.city.keeps_parts;
  job.num_buckets = options.num_buckets;
  job.skips_bad = options.skips_bad;
  return job;
}

void print_plan(const Job& job, const CommonOptions& common) {
  std::uint64_t num_bytes = 0;
  for (const PlannedSource& source : job.plan.sources) num_bytes += source.num_bytes;
  const Eigen::Vector3d& anchor = *job.plan.files.build.anchor;
  if (!common.json) {
    return print_result(fmt::format("{}: {} sources, {:.2f} GB, to be finished in {} buckets\n", job.folder.string(),
                                    job.plan.sources.size(), static_cast<double>(num_bytes) / 1e9,
                                    job.plan.num_buckets));
  }
  nlohmann::ordered_json json = {{"job", job.folder.string()}, {"city", job.plan.city.string()}};
  json["sources"] = job.plan.sources.size();
  json["bytes"] = num_bytes;
  json["buckets"] = job.plan.num_buckets;
  json["anchor"] = {anchor.x(), anchor.y(), anchor.z()};
  json["left_out"] = nlohmann::ordered_json::array();
  for (const LeftOutSource& source : job.plan.left_out) {
    json["left_out"].push_back({{"name", source.name}, {"reason", source.reason}});
  }
  print_json(json);
}

ExitCode plan(const TilePlanOptions& options, const CommonOptions& common) {
  const JobOptions job = job_options(options, common);
  ReadingReport listed;
  const std::vector<std::filesystem::path> files = list_inputs(options.points.inputs, listed);
  const ChosenInputs chosen = chosen_inputs(list_scans(files, options.points.read), options.points);
  listed.warn();
  const Job planned = plan_job(job_folder_of(options), chosen.inputs, job);
  for (const LeftOutSource& source : planned.plan.left_out) spdlog::warn("left out: {}", source.reason);
  print_plan(planned, common);
  return ExitCode::kDone;
}

}  // namespace

Command tile_plan_command() {
  return make_command<TilePlanOptions>("plan", "Plan a job: which sources become which city",
                                       "vdbmap tile plan survey/ -o city/\n"
                                       "vdbmap tile plan survey/*.laz -o city/ --job /scratch/job --buckets 100\n"
                                       "vdbmap tile plan more/ --into city/ --epoch 2",
                                       add_plan_options, plan);
}

}  // namespace vdbmap::cli

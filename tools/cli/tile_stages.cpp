// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "tools/cli/build_city.h"
#include "tools/cli/build_report.h"
#include "tools/cli/city_summary.h"
#include "tools/cli/number_ranges.h"
#include "tools/cli/output.h"
#include "tools/cli/progress.h"
#include "tools/cli/reading.h"
#include "tools/cli/tile_commands.h"
#include "vdbmap/stages/job_run.h"
#include "vdbmap/stages/job_status.h"
#include "vdbmap/stages/reduce_stage.h"
#include "vdbmap/store/source_hash.h"

namespace vdbmap::cli {
namespace {

constexpr std::size_t kMostJobs = 1024;

struct TileOptions {
  std::filesystem::path job;
  std::string numbers;
  std::uint64_t memory_bytes = std::uint64_t{2} << 30;
  bool skips_bad = false;
  std::size_t num_jobs = 1;
  std::string missing;
};

void add_job(CLI::App& app, TileOptions& options) {
  app.add_option("JOB", options.job, "Folder of the job that tile plan made")->type_name("FOLDER")->required();
}

void add_numbers(CLI::App& app, TileOptions& options, const std::string& description) {
  app.add_option("NUMBERS", options.numbers, description)->type_name("LIST")->required();
}

void add_mapping(CLI::App& app, TileOptions& options) {
  add_memory(app, options.memory_bytes,
             "What mapping may take, as 500M or 2G: beyond, sums of points go through the disk, [2G]");
  app.add_flag("--skip-bad", options.skips_bad,
               "Leave a source out, by name, whose content cannot be read, instead of stopping there");
}

void add_map_stage(CLI::App& app, TileOptions& options) {
  add_job(app, options);
  add_numbers(app, options, "Which sources, from 0 on in the order of the plan: 3, or 0-15,20");
  add_mapping(app, options);
}

void add_reduce_stage(CLI::App& app, TileOptions& options) {
  add_job(app, options);
  add_numbers(app, options, "Which buckets, from 0 on: 3, or 0-15,20");
}

void add_run(CLI::App& app, TileOptions& options) {
  add_job(app, options);
  app.add_option("--jobs", options.num_jobs, "So many sources, or buckets, at a time")
      ->check(CLI::Range(std::size_t{1}, kMostJobs).description(""))
      ->type_name("N")
      ->capture_default_str();
  add_mapping(app, options);
}

void add_status(CLI::App& app, TileOptions& options) {
  add_job(app, options);
  app.add_option("--missing", options.missing,
                 "Print only the numbers of what is left to do of a stage, map or reduce, as 0-3,7")
      ->check(CLI::IsMember({"map", "reduce"}).description(""))
      ->type_name("STAGE");
}

MapStageOptions map_options(const TileOptions& options, const CommonOptions& common) {
  return {options.memory_bytes, options.skips_bad, common.num_threads != 1};
}

const char* text_of_outcome(MapOutcome outcome) {
  switch (outcome) {
    case MapOutcome::kDone:
      return "mapped";
    case MapOutcome::kWasThere:
      return "was mapped before";
    case MapOutcome::kLeftOut:
      break;
  }
  return "left out";
}

const char* text_of_outcome(ReduceOutcome outcome) {
  return outcome == ReduceOutcome::kDone ? "finished" : "was finished before";
}

// Tasks and what became of them, in the order in which they were done.
class OutcomeList {
 public:
  explicit OutcomeList(std::string kind) : kind_(std::move(kind)) {}

  void add(std::size_t number, const std::string& name, const std::string& outcome) {
    json_.push_back({{kind_, number}, {"outcome", outcome}});
    if (!name.empty()) json_.back()["name"] = name;
    text_ += fmt::format("{} {}{}: {}\n", kind_, number, name.empty() ? "" : ", " + name, outcome);
  }

  void print(bool as_json) const {
    if (as_json) return print_json(json_);
    print_result(text_);
  }

 private:
  std::string kind_;
  std::string text_;
  nlohmann::ordered_json json_ = nlohmann::ordered_json::array();
};

// All of them exist: a wrong one is told before any work.
std::vector<std::size_t> checked_numbers(const Job& job, const TileOptions& options,
                                         void (*check)(const Job&, std::size_t)) {
  std::vector<std::size_t> numbers = parse_ranges(options.numbers);
  for (const std::size_t number : numbers) check(job, number);
  return numbers;
}

ExitCode map(const TileOptions& options, const CommonOptions& common) {
  const Job job = open_job(options.job);
  const std::vector<std::size_t> numbers = checked_numbers(job, options, check_source);
  OutcomeList outcomes("source");
  Progress progress("mapping sources", numbers.size(), common);
  for (const std::size_t number : numbers) {
    const MapOutcome outcome = map_source(job, number, map_options(options, common));
    if (outcome == MapOutcome::kLeftOut) spdlog::warn("left out: {}", left_out_source(job, number)->reason);
    outcomes.add(number, source_name(job.plan.sources[number].input), text_of_outcome(outcome));
    progress.advance();
  }
  outcomes.print(common.json);
  return ExitCode::kDone;
}

ExitCode reduce(const TileOptions& options, const CommonOptions& common) {
  const Job job = open_job(options.job);
  const std::vector<std::size_t> numbers = checked_numbers(job, options, check_bucket);
  OutcomeList outcomes("bucket");
  Progress progress("finishing tiles", numbers.size(), common);
  for (const std::size_t number : numbers) {
    outcomes.add(number, "", text_of_outcome(reduce_bucket(job, number)));
    progress.advance();
  }
  outcomes.print(common.json);
  return ExitCode::kDone;
}

ExitCode finish(const TileOptions& options, const CommonOptions& common) {
  const Job job = open_job(options.job);
  print_finished(job, finish_job(job), common);
  return ExitCode::kDone;
}

ExitCode run(const TileOptions& options, const CommonOptions& common) {
  const Job job = open_job(options.job);
  std::optional<Progress> progress;
  JobRunOptions running;
  running.num_jobs = options.num_jobs;
  running.map = map_options(options, common);
  running.on_map_begun = [&](std::size_t count) { progress.emplace("mapping sources", count, common); };
  running.on_reduce_begun = [&](std::size_t count) { progress.emplace("finishing tiles", count, common); };
  running.on_task_done = [&] { progress->advance(); };
  const JobFinished finished = run_job(job, running);
  progress.reset();
  print_finished(job, finished, common);
  return ExitCode::kDone;
}

std::string line_of_stage(const std::string& stage, std::size_t count, const std::vector<std::size_t>& missing) {
  const std::string left = missing.empty() ? "" : ", missing " + ranges_text(missing);
  return fmt::format("{:<10} {} of {}{}\n", stage, count - missing.size(), count, left);
}

std::string text_of_status(const Job& job, const JobStatus& status) {
  std::string text = fmt::format("{}: to become {}\n", job.folder.string(), job.plan.city.string());
  text += line_of_stage("map", job.plan.sources.size(), status.missing_sources);
  text += line_of_stage("reduce", job.plan.num_buckets, status.missing_buckets);
  text += fmt::format("finish     {}\n", status.is_published ? "done, the job's folder may be removed" : "not yet");
  for (const LeftOutSource& source : status.left_out) text += "left out   " + source.reason + "\n";
  if (!status.problem.empty()) text += "problem    " + status.problem + "\n";
  return text;
}

nlohmann::ordered_json json_of_left_out(const std::vector<LeftOutSource>& sources) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const LeftOutSource& source : sources) json.push_back({{"name", source.name}, {"reason", source.reason}});
  return json;
}

nlohmann::ordered_json json_of_status(const Job& job, const JobStatus& status) {
  return {
      {"job", job.folder.string()},
      {"city", job.plan.city.string()},
      {"sources", job.plan.sources.size()},
      {"missing_sources", status.missing_sources},
      {"buckets", job.plan.num_buckets},
      {"missing_buckets", status.missing_buckets},
      {"is_published", status.is_published},
      {"left_out", json_of_left_out(status.left_out)},
      {"problem", status.problem.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(status.problem)}};
}

ExitCode status(const TileOptions& options, const CommonOptions& common) {
  const Job job = open_job(options.job);
  const JobStatus found = find_status(job);
  if (!options.missing.empty()) {
    const std::vector<std::size_t>& missing = options.missing == "map" ? found.missing_sources : found.missing_buckets;
    if (common.json) {
      print_json(missing);
    } else {
      print_result(ranges_text(missing) + "\n");
    }
  } else if (common.json) {
    print_json(json_of_status(job, found));
  } else {
    print_result(text_of_status(job, found));
  }
  return ExitCode::kDone;
}

}  // namespace

void print_finished(const Job& job, const JobFinished& finished, const CommonOptions& common) {
  const CityBuilt& built = finished.built;
  warn_of(built.notes, built.manifest.layout.frame.epsg);
  ReadingReport reading;
  reading.add(built.notes.findings);
  reading.warn();
  warn_not_counted(built);
  for (const LeftOutSource& source : finished.left_out) spdlog::warn("left out: {}", source.reason);
  if (common.json) {
    nlohmann::ordered_json json = json_of_city(built.manifest, job.plan.city);
    json["was_published"] = finished.was_published;
    json["added_sources"] = built.added.size();
    json["not_counted"] = built.not_counted;
    json["left_out"] = json_of_left_out(finished.left_out);
    json["dropped_points"] = built.notes.num_dropped;
    json["points_out_of_range"] = built.notes.num_out_of_range;
    json["points_of_dropped_classes"] = built.notes.num_of_dropped_classes;
    json["findings"] = reading.json();
    return print_json(json);
  }
  const std::string what =
      finished.was_published ? "was published before" : fmt::format("published, {} sources added", built.added.size());
  print_result(fmt::format("{}: {}\n", job.plan.city.string(), what) + text_of_city(built.manifest));
}

Command tile_map_command() {
  return make_command<TileOptions>("map", "Add up the points of sources, a file of sums each",
                                   "vdbmap tile map city.job 3\n"
                                   "vdbmap tile map city.job $(vdbmap tile status city.job --missing map) --skip-bad",
                                   add_map_stage, map);
}

Command tile_reduce_command() {
  return make_command<TileOptions>("reduce", "Finish the tiles of buckets, of the sums of all sources",
                                   "vdbmap tile reduce city.job 0-3", add_reduce_stage, reduce);
}

Command tile_finish_command() {
  return make_command<TileOptions>("finish", "Publish the tiles of all buckets as the city",
                                   "vdbmap tile finish city.job", add_job, finish);
}

Command tile_status_command() {
  return make_command<TileOptions>("status", "Tell what of a job is left to do",
                                   "vdbmap tile status city.job\n"
                                   "vdbmap tile status city.job --missing map",
                                   add_status, status);
}

Command tile_run_command() {
  return make_command<TileOptions>("run", "Run what is left to do of a job on this machine",
                                   "vdbmap tile run city.job --jobs 4 --memory 8G", add_run, run);
}

}  // namespace vdbmap::cli

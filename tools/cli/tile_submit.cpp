// SPDX-License-Identifier: GPL-3.0-or-later
#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "tools/cli/city_output.h"
#include "tools/cli/external_program.h"
#include "tools/cli/output.h"
#include "tools/cli/slurm_scripts.h"
#include "tools/cli/tile_commands.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/file/atomic_file.h"

namespace vdbmap::cli {
namespace {

constexpr const char* kNothingLeft = "nothing is left to do\n";

struct TileSubmitOptions {
  std::filesystem::path job;
  bool is_for_slurm = false;
  bool prints = false;
  std::filesystem::path program;
  SlurmOptions slurm;
};

void add_submit_options(CLI::App& app, TileSubmitOptions& options) {
  app.add_option("JOB", options.job, "Folder of the job that tile plan made, seen by all nodes")
      ->type_name("FOLDER")
      ->required();
  app.add_flag("--slurm", options.is_for_slurm, "To Slurm, by sbatch: an array a stage, each after the one before")
      ->required();
  app.add_flag("--print", options.prints, "Only print the scripts and commands");
  add_memory(app, options.slurm.memory_bytes,
             "What a task that maps may take, as 500M or 2G; it asks the cluster for half as much again, [2G]");
  app.add_option("--task-size", options.slurm.bytes_of_task,
                 "Sources are put together until a task has so much to read, as 100M or 1G [256M]")
      ->transform(CLI::AsSizeValue(false).description(""))
      ->type_name("BYTES");
  app.add_flag("--skip-bad", options.slurm.skips_bad,
               "Leave a source out, by name, whose content cannot be read, instead of stopping there");
  app.add_option("--program", options.program,
                 "The command vdbmap, or a script in its place, on all nodes (default: this one)")
      ->type_name("FILE");
  app.add_option("--sbatch", options.slurm.sbatch,
                 "A further option for sbatch, as --sbatch=--partition=long; again for more")
      ->type_name("OPTION");
}

std::filesystem::path this_program() {
  std::error_code error;
  std::filesystem::path path = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) throw IoError::system("/proc/self/exe", "cannot read", error.value());
  return path;
}

std::filesystem::path script_path(const Job& job, const SlurmStage& stage) {
  return job.folder / "slurm" / (stage.name + ".sh");
}

std::vector<std::string> sbatch_command(const Job& job, const SlurmStage& stage, const std::string& job_before) {
  std::vector<std::string> command = {"sbatch"};
  command.insert(command.end(), stage.options.begin(), stage.options.end());
  if (!job_before.empty()) {
    command.insert(command.end(), {"--dependency=afterok:" + job_before, "--kill-on-invalid-dep=yes"});
  }
  command.push_back(script_path(job, stage).string());
  return command;
}

std::string line_of_command(const std::vector<std::string>& command) {
  std::string line;
  for (const std::string& word : command) {
    if (!line.empty()) line += ' ';
    line += shell_word(word);
  }
  return line + "\n";
}

std::string text_of_stages(const Job& job, const std::vector<SlurmStage>& stages) {
  std::string text = stages.empty() ? kNothingLeft : "";
  std::string before;
  for (const SlurmStage& stage : stages) {
    text += fmt::format("# {}\n{}\n", script_path(job, stage).string(), stage.script);
    text += "# " + line_of_command(sbatch_command(job, stage, before)) + "\n";
    before = "JOB_OF_" + stage.name;
  }
  return text;
}

// "17" of "17;cluster" and a line's end.
std::string job_number(const std::string& said) { return said.substr(0, said.find_first_of(";\n")); }

nlohmann::ordered_json submit_stages(const Job& job, const std::vector<SlurmStage>& stages) {
  std::error_code error;
  std::filesystem::create_directories(job.folder / "slurm", error);
  if (error) throw IoError::system(job.folder / "slurm", "cannot create", error.value());
  nlohmann::ordered_json numbers = nlohmann::ordered_json::object();
  std::string before;
  for (const SlurmStage& stage : stages) {
    write_file(script_path(job, stage), stage.script);
    before = job_number(output_of_program(sbatch_command(job, stage, before)));
    numbers[stage.name] = before;
  }
  return numbers;
}

ExitCode submit(const TileSubmitOptions& options, const CommonOptions& common) {
  const Job job = open_job(options.job);
  const JobStatus status = find_status(job);
  if (!status.problem.empty()) throw IoError::malformed(job.folder, "cannot go on: " + status.problem);
  SlurmOptions slurm = options.slurm;
  slurm.program = options.program.empty() ? this_program() : std::filesystem::absolute(options.program);
  slurm.num_threads = common.num_threads == 0 ? 1 : common.num_threads;
  const std::vector<SlurmStage> stages = slurm_stages(job, status, slurm);
  if (options.prints) {
    print_result(text_of_stages(job, stages));
    return ExitCode::kDone;
  }
  const nlohmann::ordered_json numbers = submit_stages(job, stages);
  if (common.json) {
    print_json(numbers);
    return ExitCode::kDone;
  }
  std::string text = stages.empty() ? kNothingLeft : "";
  for (const SlurmStage& stage : stages)
    text += fmt::format("{:<10} job {}\n", stage.name, std::string(numbers[stage.name]));
  print_result(text);
  return ExitCode::kDone;
}

}  // namespace

Command tile_submit_command() {
  return make_command<TileSubmitOptions>(
      "submit", "Give what is left to do of a job to a cluster",
      "vdbmap tile submit city.job --slurm\n"
      "vdbmap tile submit city.job --slurm --threads 4 --memory 8G --sbatch=--partition=long\n"
      "vdbmap tile submit city.job --slurm --print",
      add_submit_options, submit);
}

}  // namespace vdbmap::cli

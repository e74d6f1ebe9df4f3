// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/slurm_scripts.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include <spdlog/fmt/fmt.h>

#include "tools/cli/number_ranges.h"

namespace vdbmap::cli {
namespace {

constexpr std::size_t kMostTasks = 1000;  // MaxArraySize is 1001 by default

// Numbers of sources or buckets, those of a task in one text: "0-3,7".
using Tasks = std::vector<std::string>;

Tasks tasks_of_sources(const Job& job, const std::vector<std::size_t>& sources, std::uint64_t bytes_of_task) {
  const std::size_t least = (sources.size() + kMostTasks - 1) / kMostTasks;
  Tasks tasks;
  std::vector<std::size_t> together;
  std::uint64_t num_bytes = 0;
  for (const std::size_t source : sources) {
    together.push_back(source);
    num_bytes += job.plan.sources[source].num_bytes;
    if (together.size() < least || (num_bytes < bytes_of_task && source != sources.back())) continue;
    tasks.push_back(ranges_text(together));
    together.clear();
    num_bytes = 0;
  }
  if (!together.empty()) tasks.push_back(ranges_text(together));
  return tasks;
}

Tasks tasks_of_buckets(const std::vector<std::size_t>& buckets) {
  const std::size_t together = (buckets.size() + kMostTasks - 1) / kMostTasks;
  Tasks tasks;
  for (std::size_t begin = 0; begin < buckets.size(); begin += together) {
    const auto first = buckets.begin() + static_cast<std::ptrdiff_t>(begin);
    const std::size_t count = std::min(together, buckets.size() - begin);
    tasks.push_back(ranges_text({first, first + static_cast<std::ptrdiff_t>(count)}));
  }
  return tasks;
}

// Bad input (3) and wrong usage (2) are the same on every node: only other failures are worth another try.
constexpr const char* kRetry = R"(code=$?
if ((code != 0 && code != 2 && code != 3 && ${SLURM_RESTART_COUNT:-0} < 3)); then
  scontrol requeue "${SLURM_ARRAY_JOB_ID:-$SLURM_JOB_ID}${SLURM_ARRAY_TASK_ID:+_$SLURM_ARRAY_TASK_ID}"
fi
exit $code
)";

std::string command_line(const Job& job, const std::string& stage, const SlurmOptions& options) {
  return fmt::format("{} tile {} {}", shell_word(options.program.string()), stage,
                     shell_word(std::filesystem::absolute(job.folder).lexically_normal().string()));
}

std::vector<std::string> sbatch_options(const Job& job, const std::string& stage, std::size_t num_tasks,
                                        const SlurmOptions& options) {
  const std::filesystem::path log = std::filesystem::absolute(job.folder).lexically_normal() / "slurm";
  std::vector<std::string> words = {"--parsable", "--requeue", "--job-name=vdbmap-" + stage, "--open-mode=append"};
  words.push_back("--output=" + (log / (stage + (num_tasks > 0 ? "-%a.log" : ".log"))).string());
  words.push_back(fmt::format("--cpus-per-task={}", options.num_threads));
  // Points of files that are read whole, and tiles while they are written, come on top.
  words.push_back(fmt::format("--mem={}M", options.memory_bytes / 1000 * 3 / 2 / 1000));
  if (num_tasks > 0) words.push_back(fmt::format("--array=0-{}", num_tasks - 1));
  words.insert(words.end(), options.sbatch.begin(), options.sbatch.end());
  return words;
}

SlurmStage array_stage(const Job& job, const std::string& stage, const Tasks& tasks, const std::string& further,
                       const SlurmOptions& options) {
  std::string script = "#!/bin/bash\nnumbers=(";
  for (const std::string& task : tasks) script += (&task == &tasks.front() ? "" : " ") + task;
  script += ")\n" + command_line(job, stage, options) + " \"${numbers[$SLURM_ARRAY_TASK_ID]}\"" + further +
            fmt::format(" --threads {}\n", options.num_threads) + kRetry;
  return {stage, sbatch_options(job, stage, tasks.size(), options), script};
}

}  // namespace

std::string shell_word(const std::string& text) {
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) || std::string_view("_./:=,%@+-").find(c) != std::string_view::npos;
  };
  if (!text.empty() && std::ranges::all_of(text, is_plain)) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

std::vector<SlurmStage> slurm_stages(const Job& job, const JobStatus& status, const SlurmOptions& options) {
  std::vector<SlurmStage> stages;
  if (status.is_published) return stages;
  const Tasks map = tasks_of_sources(job, status.missing_sources, options.bytes_of_task);
  const Tasks reduce = tasks_of_buckets(status.missing_buckets);
  const std::string memory =
      fmt::format(" --memory {}{}", options.memory_bytes, options.skips_bad ? " --skip-bad" : "");
  if (!map.empty()) stages.push_back(array_stage(job, "map", map, memory, options));
  if (!reduce.empty()) stages.push_back(array_stage(job, "reduce", reduce, "", options));
  const std::string finish = "#!/bin/bash\n" + command_line(job, "finish", options) + "\n" + kRetry;
  stages.push_back({"finish", sbatch_options(job, "finish", 0, options), finish});
  return stages;
}

}  // namespace vdbmap::cli

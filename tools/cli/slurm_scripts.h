// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "vdbmap/stages/job_status.h"

namespace vdbmap::cli {

/// A word for the shell, whatever is in it; in quotes where it needs them.
std::string shell_word(const std::string& text);

/// How the tasks of a job run on a cluster.
struct SlurmOptions {
  std::filesystem::path program;  ///< the command vdbmap, at the same place on all nodes
  std::size_t num_threads = 1;    ///< of a task
  std::uint64_t memory_bytes = std::uint64_t{2} << 30;
  std::uint64_t bytes_of_task = std::uint64_t{256} << 20;  ///< to be read, where sources are smaller
  bool skips_bad = false;
  std::vector<std::string> sbatch;  ///< further options of sbatch: --partition=long
};

/// A stage as an array of Slurm jobs.
struct SlurmStage {
  std::string name;
  std::vector<std::string> options;  ///< of sbatch, without what it depends on
  std::string script;                ///< for bash
};

/// The stages that are left to do, each to be submitted once the one before is done. Sources are put together, since
/// starting a task costs a cluster a fifth of a second; 1000 tasks an array at most. A task that could not read or
/// write, or was killed, is tried up to three times more.
std::vector<SlurmStage> slurm_stages(const Job& job, const JobStatus& status, const SlurmOptions& options);

}  // namespace vdbmap::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/stages/map_stage.h"

#include <future>
#include <string>
#include <system_error>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/atomic_folder.h"
#include "vdbmap/store/source_hash.h"

namespace vdbmap {
namespace {

// What tells whether a file is still the one that it was.
struct FileState {
  std::uintmax_t size = 0;
  std::filesystem::file_time_type changed;

  bool operator==(const FileState&) const = default;
};

FileState state_of(const std::filesystem::path& file) {
  std::error_code error;
  FileState state{std::filesystem::file_size(file, error), {}};
  if (!error) state.changed = std::filesystem::last_write_time(file, error);
  if (error) throw IoError::system(file, "cannot open", error.value());
  return state;
}

void write_part_of(const Job& job, std::size_t source, const MapStageOptions& options) {
  const PlannedSource& planned = job.plan.sources[source];
  const FileState state = state_of(planned.input.scan.file);
  if (state.size != planned.num_bytes) {
    throw IoError::malformed(planned.input.scan.file, "has " + std::to_string(state.size) + " bytes, but " +
                                                          std::to_string(planned.num_bytes) +
                                                          " when the job was planned: plan it anew");
  }
  // Beside the reading: what one has fetched from the disk or another machine, the other finds in memory.
  std::future<MapSource> identity = std::async(std::launch::async, [&] { return identify_source(planned.input); });
  MapFromFilesOptions files = job.plan.files;
  files.inputs.reads_ahead = options.reads_ahead;
  const AtomicFolder spilled(job.folder / "sums");
  TileSums sums(files.build.voxel_sizes, spilled.temporary_path(), bytes_of_sums(options.memory_bytes));
  CountedPoints points = count_points(sums, {planned.input}, files, options.memory_bytes);
  PartNotes found{identity.get(), points.kinds, std::move(points.notes)};
  found.source.num_points = points.num_points.front();
  if (state_of(planned.input.scan.file) != state) {
    throw IoError::malformed(planned.input.scan.file, "changed while it was read");
  }
  write_part(job, source, found, sums);
}

}  // namespace

bool has_part(const Job& job, std::size_t source) {
  std::error_code missing;
  if (!std::filesystem::exists(part_path(job.folder, source), missing)) return false;
  try {
    open_part(job, source);
    return true;
  } catch (const IoError& error) {
    if (error.kind() != IoError::Kind::kMalformed) throw;
    return false;
  }
}

MapOutcome map_source(const Job& job, std::size_t source, const MapStageOptions& options) {
  check_source(job, source);
  if (has_part(job, source)) return MapOutcome::kWasThere;
  if (options.skips_bad && left_out_source(job, source)) return MapOutcome::kLeftOut;
  try {
    write_part_of(job, source, options);
  } catch (const IoError& error) {
    if (!options.skips_bad || error.kind() != IoError::Kind::kMalformed) throw;
    leave_out(job, source, error.what());
    return MapOutcome::kLeftOut;
  }
  return MapOutcome::kDone;
}

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/stages/job_folder.h"

#include <stdexcept>
#include <system_error>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/store/content_hash.h"
#include "vdbmap/store/source_hash.h"

namespace vdbmap {
namespace {

bool is_there(const std::filesystem::path& path) {
  std::error_code missing;
  return std::filesystem::exists(path, missing);
}

std::string read_all(const std::filesystem::path& path) {
  ByteReader file(path);
  return std::string(file.bytes(file.size()));
}

void create_folders(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw IoError::system(folder, "cannot create", error.value());
}

// A folder of something else gets no job.
void check_new(const std::filesystem::path& folder) {
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name == "parts" || name == "tiles" || name.starts_with("job.json.")) continue;
    throw IoError::malformed(folder, "is no job: it holds '" + name + "'");
  }
}

void check_number(const Job& job, const std::string& what, std::size_t number, std::size_t count) {
  if (number < count) return;
  throw std::invalid_argument(job.folder.string() + ": has no " + what + " " + std::to_string(number) + ", but " +
                              std::to_string(count) + " from 0 on");
}

}  // namespace

std::filesystem::path plan_path(const std::filesystem::path& folder) { return folder / "job.json"; }
std::filesystem::path parts_path(const std::filesystem::path& folder) { return folder / "parts"; }
std::filesystem::path part_path(const std::filesystem::path& folder, std::size_t source) {
  return parts_path(folder) / (std::to_string(source) + ".part");
}
std::filesystem::path left_out_path(const std::filesystem::path& folder, std::size_t source) {
  return parts_path(folder) / (std::to_string(source) + ".left_out");
}
std::filesystem::path buckets_path(const std::filesystem::path& folder) { return folder / "tiles"; }
std::filesystem::path bucket_path(const std::filesystem::path& folder, std::size_t bucket) {
  return buckets_path(folder) / std::to_string(bucket);
}

Job open_job(const std::filesystem::path& folder) {
  if (!is_there(plan_path(folder))) {
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error)) throw IoError::system(folder, "cannot open", ENOENT);
    throw IoError::malformed(folder, "is no job: it has no job.json");
  }
  const std::string text = read_all(plan_path(folder));
  return {folder, parse_job_plan(text, plan_path(folder)), hash_of_bytes(text)};
}

Job create_job(const std::filesystem::path& folder, const JobPlan& plan) {
  const std::string text = text_of(plan);
  if (is_there(plan_path(folder))) {
    if (read_all(plan_path(folder)) == text) return {folder, plan, hash_of_bytes(text)};
    throw std::invalid_argument(folder.string() + ": holds another plan, remove it or choose another folder");
  }
  create_folders(folder);
  check_new(folder);
  create_folders(parts_path(folder));
  create_folders(buckets_path(folder));
  write_file(plan_path(folder), text);
  sync_folder(folder);
  return {folder, plan, hash_of_bytes(text)};
}

void check_source(const Job& job, std::size_t source) { check_number(job, "source", source, job.plan.sources.size()); }

void check_bucket(const Job& job, std::size_t bucket) { check_number(job, "bucket", bucket, job.plan.num_buckets); }

void leave_out(const Job& job, std::size_t source, const std::string& reason) {
  write_file(left_out_path(job.folder, source), job.key + "\n" + reason + "\n");
  sync_folder(parts_path(job.folder));
}

std::optional<LeftOutSource> left_out_source(const Job& job, std::size_t source) {
  const std::filesystem::path path = left_out_path(job.folder, source);
  if (!is_there(path)) return std::nullopt;
  const std::string text = read_all(path);
  const std::size_t end = text.find('\n');
  if (end == std::string::npos || !text.ends_with('\n')) throw IoError::malformed(path, "is damaged");
  if (text.substr(0, end) != job.key) throw IoError::malformed(path, "is of another plan");
  return LeftOutSource{source_name(job.plan.sources[source].input), text.substr(end + 1, text.size() - end - 2)};
}

}  // namespace vdbmap

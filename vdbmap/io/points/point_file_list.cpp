// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cctype>
#include <string>
#include <system_error>

#include "vdbmap/core/error.h"
#include "vdbmap/io/points/point_format.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/io/scans/scan_order.h"
#include "vdbmap/io/table/table_kind.h"

namespace vdbmap {
namespace {

using Path = std::filesystem::path;

std::string extension_of(const Path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

bool is_text_format(const Path& path) { return format_of_extension(path) == PointFormat::kXyz; }
bool is_txt(const Path& path) { return extension_of(path) == ".txt"; }

// A dot hides what is not meant.
bool may_be_listed(const std::filesystem::directory_entry& entry) {
  std::error_code ignored;
  return entry.is_regular_file(ignored) && !entry.path().filename().string().starts_with('.') &&
         format_of_extension(entry.path()).has_value();
}

std::vector<Path> files_in(const Path& folder) {
  std::error_code error;
  std::filesystem::directory_iterator entries(folder, error);
  std::vector<Path> files;
  for (; !error && entries != std::filesystem::directory_iterator(); entries.increment(error)) {
    if (may_be_listed(*entries)) files.push_back(entries->path());
  }
  if (error) throw IoError::system(folder, "cannot list", error.value());
  std::ranges::sort(files, comes_before);
  return files;
}

// The files of a folder by what they may be, each in their order.
struct Candidates {
  std::vector<Path> scans;   // of formats for points
  std::vector<Path> tables;  // .csv, .xyz and the like
  std::vector<Path> texts;   // .txt, which may be anything
};

Candidates sort_out(const std::vector<Path>& files) {
  Candidates candidates;
  for (const Path& file : files) {
    (is_txt(file) ? candidates.texts : is_text_format(file) ? candidates.tables : candidates.scans).push_back(file);
  }
  return candidates;
}

// A name without its extension, its numbers left open: "scan_#" for scan_17.bin.
std::string pattern_of(const Path& path) {
  std::string pattern;
  for (const char c : path.stem().string()) {
    const bool is_digit = c >= '0' && c <= '9';
    if (!is_digit || !pattern.ends_with('#')) pattern += is_digit ? '#' : c;
  }
  return pattern;
}

// Whether a table may be one more of these scans: named like them, and not like one of them.
bool continues(const Path& table, const std::vector<Path>& scans) {
  const auto has_its_name = [&](const Path& scan) { return scan.stem() == table.stem(); };
  const auto has_its_pattern = [&](const Path& scan) { return pattern_of(scan) == pattern_of(table); };
  return std::ranges::none_of(scans, has_its_name) && std::ranges::any_of(scans, has_its_pattern);
}

// Why a table is no scan beside those of other formats, where there are any; .csv may be tables of anything.
std::string reason_left_out(const Path& table, const std::vector<Path>& scans) {
  std::string reason = reason_no_scan(table);
  if (!reason.empty() || scans.empty() || extension_of(table) != ".csv" || continues(table, scans)) return reason;
  return "is a table beside scans of other formats and names";
}

struct Folder {
  std::vector<Path> files;
  std::vector<ReadFinding> left_out;
};

void add_tables(const std::vector<Path>& tables, const std::vector<Path>& scans, Folder& folder) {
  for (const Path& table : tables) {
    const std::string reason = reason_left_out(table, scans);
    if (reason.empty()) {
      folder.files.push_back(table);
    } else {
      add_finding(folder.left_out,
                  {"text files that are no scans left out", 1, table.filename().string() + " " + reason});
    }
  }
}

Folder list_folder(const Path& path) {
  const Candidates candidates = sort_out(files_in(path));
  Folder folder{candidates.scans, {}};
  add_tables(candidates.tables, candidates.scans, folder);
  if (folder.files.empty()) add_tables(candidates.texts, {}, folder);
  std::ranges::sort(folder.files, comes_before);
  if (!folder.files.empty()) return folder;

  const std::string tables = folder.left_out.empty() ? "" : "; " + folder.left_out.front().text();
  throw IoError::malformed(path,
                           "the folder holds no point files (.ply .pcd .las .bin .xyz .csv .asc .txt .pcap)" + tables);
}

}  // namespace

PointFiles find_point_files(const std::vector<Path>& inputs) {
  PointFiles found;
  for (const Path& input : inputs) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(input, error);
    if (!std::filesystem::exists(status)) throw IoError::system(input, "cannot open", error.value());
    if (!std::filesystem::is_directory(status)) {
      found.files.push_back(input);
      continue;
    }
    const Folder folder = list_folder(input);
    found.files.insert(found.files.end(), folder.files.begin(), folder.files.end());
    for (const ReadFinding& finding : folder.left_out) found.findings.push_back({input, finding});
  }
  return found;
}

std::vector<Path> list_point_files(const std::vector<Path>& inputs) { return find_point_files(inputs).files; }

}  // namespace vdbmap

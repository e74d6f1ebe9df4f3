// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/file/read_finding.h"

#include <algorithm>

namespace vdbmap {

std::string ReadFinding::text() const {
  std::string text = count == 0 ? what : std::to_string(count) + " " + what;
  if (!first.empty()) text += count == 1 || count == 0 ? " (" + first + ")" : " (first: " + first + ")";
  return text;
}

ReadFinding missing_points(std::size_t num_promised, std::size_t num_found) {
  return {"points that the header promises are missing", num_promised - num_found,
          "it promises " + std::to_string(num_promised) + ", the file holds " + std::to_string(num_found), true};
}

void add_finding(std::vector<ReadFinding>& findings, const ReadFinding& finding) {
  const auto same = std::ranges::find_if(findings, [&](const ReadFinding& other) {
    return other.what == finding.what && other.is_damage == finding.is_damage;
  });
  if (same == findings.end()) {
    findings.push_back(finding);
  } else {
    same->count += finding.count;
  }
}

}  // namespace vdbmap

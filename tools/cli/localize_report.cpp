// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/localize_report.h"

#include <algorithm>
#include <optional>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "tools/cli/json_text.h"
#include "tools/cli/pose_frame.h"

namespace vdbmap::cli {
namespace {

using registration::BatchCandidate;
using registration::SequenceBatch;

std::vector<std::string> descriptions(const std::vector<registration::UnobservableDirection>& directions) {
  std::vector<std::string> texts;
  for (const auto& direction : directions) texts.push_back(direction.description);
  return texts;
}

nlohmann::ordered_json json_of_pose(const Eigen::Isometry3d& pose) {
  return json_of_matrix(pose.matrix().topRows<3>().eval());
}

nlohmann::ordered_json json_of(const LocalizedRow& row) {
  nlohmann::ordered_json json = json_of_place(row.scan);
  json["found"] = row.found();
  if (!row.found()) json["reason"] = row.reason;
  if (!row.time_problem.empty()) json["not_deskewed"] = row.time_problem;
  json["map_from_scan"] = json_of_pose(row.map_from_scan);
  json["covariance"] = json_of_matrix(row.covariance);
  json["inlier_share"] = row.inlier_share;
  json["unobservable"] = row.unobservable;
  return json;
}

nlohmann::ordered_json json_of(const BatchCandidate& candidate) {
  return {{"map_from_batch", json_of_pose(candidate.map_from_batch)},
          {"surface_agreement", candidate.agreement},
          {"overlap", candidate.evidence.overlap},
          {"explained_share", candidate.evidence.explained_share()},
          {"blocked_share", candidate.evidence.blocked_share},
          {"feature_inliers", candidate.num_feature_inliers}};
}

nlohmann::ordered_json json_of(const SequenceBatch& batch) {
  nlohmann::ordered_json json = {
      {"first", batch.first}, {"scans", batch.count}, {"found", batch.search.found()}, {"placed", batch.is_placed}};
  if (!batch.search.found()) json["reason"] = batch.search.reason;
  json["candidates"] = nlohmann::ordered_json::array();
  for (const BatchCandidate& candidate : batch.search.candidates) json["candidates"].push_back(json_of(candidate));
  return json;
}

std::string range_of(const LocalizeReport& report, const SequenceBatch& batch) {
  const std::string first = report.scans[batch.first].scan.name();
  const std::string last = report.scans[batch.first + batch.count - 1].scan.name();
  return batch.count > 1 ? first + " to " + last : first;
}

}  // namespace

std::size_t LocalizeReport::num_found() const {
  return static_cast<std::size_t>(std::ranges::count_if(scans, [](const LocalizedRow& row) { return row.found(); }));
}

Trajectory LocalizeReport::trajectory() const {
  Trajectory trajectory;
  for (const LocalizedRow& row : scans) {
    trajectory.map_from_scan.push_back(row.found() ? std::optional(row.map_from_scan) : std::nullopt);
  }
  if (given && given->poses.times.size() == scans.size()) trajectory.times = given->poses.times;
  return trajectory;
}

LocalizedRow row_of(const ScanPlace& scan, const registration::LocalizedScan& localized) {
  const registration::FineResult& fine = localized.fine;
  return {scan,
          fine.map_from_scan,
          fine.covariance,
          fine.inlier_share,
          descriptions(fine.unobservable),
          localized.reason,
          localized.time_problem};
}

LocalizedRow row_of(const ScanPlace& scan, const registration::SequenceScan& localized) {
  return {scan,
          localized.map_from_scan,
          localized.covariance,
          localized.evidence.explained_share(),
          descriptions(localized.unobservable),
          localized.reason,
          localized.time_problem};
}

void warn(const LocalizeReport& report) {
  report.reading.warn();
  for (const SequenceBatch& batch : report.batches) {
    if (!batch.search.found()) {
      spdlog::warn("{}: {}: {}", range_of(report, batch),
                   batch.is_placed ? "found through its neighbours only" : "not found", batch.search.reason);
    }
  }
  for (const LocalizedRow& row : report.scans) {
    const std::string name = row.scan.name();
    if (!row.time_problem.empty()) spdlog::warn("{}: not deskewed: {}", name, row.time_problem);
    if (!row.found()) spdlog::warn("{}: not found: {}", name, row.reason);
    for (const std::string& direction : row.unobservable) {
      spdlog::warn("{}: the map does not determine {}", name, direction);
    }
  }
}

nlohmann::ordered_json json_of(const LocalizeReport& report, const std::filesystem::path& output) {
  nlohmann::ordered_json json = {
      {"file", output.string()}, {"scans", report.scans.size()}, {"found", report.num_found()}};
  if (report.given) add_pose_frame(json, *report.given);
  json["results"] = nlohmann::ordered_json::array();
  for (const LocalizedRow& row : report.scans) json["results"].push_back(json_of(row));
  if (report.batches.empty()) return json;
  json["batches"] = nlohmann::ordered_json::array();
  for (const SequenceBatch& batch : report.batches) json["batches"].push_back(json_of(batch));
  return json;
}

}  // namespace vdbmap::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/localizer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "registration/batch_agreement.h"
#include "registration/batch_builder.h"
#include "registration/carrying.h"
#include "registration/joining.h"
#include "registration/map_window.h"
#include "registration/odometry_path.h"
#include "registration/percent.h"
#include "vdbmap/core/parallel_tasks.h"

namespace vdbmap::registration {
namespace {

constexpr double kUprightTilt_deg = 10;

std::vector<MeasuredRay> rays_of(const SampledScan& sample) {
  constexpr std::size_t kRaysPerScan = 500;
  const std::size_t step = std::max<std::size_t>(1, sample.fine.size() / kRaysPerScan);
  std::vector<MeasuredRay> rays;
  for (std::size_t i = 0; i < sample.fine.size(); i += step) rays.push_back({Eigen::Vector3d::Zero(), sample.fine[i]});
  return rays;
}

std::string reason_not_found(const Evidence& evidence, const FoundCriteria& criteria) {
  if (evidence.num_points == 0) return "no point lies within the range limits";
  const double share = evidence.explained_share();
  if (share >= criteria.min_inlier_share) return "";
  return "only " + percent(share) + " of the points lie on the map, expected " + percent(criteria.min_inlier_share);
}

}  // namespace

struct Localizer::State {
  State(MapWindows map_to_search, LocalizerOptions how, CoarseMap features)
      : map(std::move(map_to_search)), options(std::move(how)), coarse_map(std::move(features)) {}

  /// What is kept of a scan until the sequence ends, beside its pose on the path.
  struct KeptScan {
    SampledScan sample;
    ScanMotion motion;
  };

  MapWindows map;
  LocalizerOptions options;
  CoarseMap coarse_map;
  std::vector<KeptScan> scans;
  std::vector<PathPose> path;
  std::vector<SequenceBatch> batches;
  std::optional<BatchBuilder> open_batch;

  void begin_batch();
  void close_batch();

  SequenceResult locate_all();
  void reject_contradictions();
  std::vector<ScanPlace> places_of_batches() const;
  std::vector<ScanPlace> places_of_scans() const;
  std::vector<double> drift_in_batches() const;
  FineResult align(std::size_t number, const Eigen::Isometry3d& map_from_scan_guess) const;
  std::vector<AlignedScan> align_each(std::span<const ScanPlace> places) const;
  SequenceScan judge(std::size_t number, const PoseEstimate& first, const PoseEstimate& middle,
                     const FineResult& fine) const;
  void close_report(SequenceResult& result, std::span<const AlignedScan> aligned);
};

void Localizer::State::begin_batch() {
  batches.push_back({.first = scans.size(), .count = 0, .search = {}, .is_placed = false});
  open_batch.emplace(map.voxel_sizes().back(), options.fine.range);
}

void Localizer::State::close_batch() {
  if (!open_batch) return;
  SequenceBatch& batch = batches.back();
  batch.search = find_batch(open_batch->combine(), map, coarse_map, options.coarse, options.verdict, options.fine);
  open_batch.reset();
}

void Localizer::State::reject_contradictions() {
  std::vector<SequenceBatch*> found;
  std::vector<BatchPlace> places;
  for (SequenceBatch& batch : batches) {
    if (!batch.search.found()) continue;
    found.push_back(&batch);
    places.push_back({batch.first, batch.search.candidates.front().map_from_batch});
  }
  const std::vector<bool> believed = believed_batches(places, path);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!believed[i]) found[i]->search.reason = "odometry contradicts it: other batches lie elsewhere";
  }
}

std::vector<ScanPlace> Localizer::State::places_of_batches() const {
  std::vector<ScanPlace> places(scans.size());
  for (const SequenceBatch& batch : batches) {
    if (!batch.search.found()) continue;
    for (std::size_t i = batch.first; i < batch.first + batch.count; ++i) {
      places[i].source = PlaceSource::kBatch;
      places[i].map_from_scan =
          batch.search.candidates.front().map_from_batch * step_between(path[batch.first], path[i]);
    }
  }
  return places;
}

// [m] of each scan, by its way from the middle of its batch: all of a batch is moved as one.
std::vector<double> Localizer::State::drift_in_batches() const {
  std::vector<double> drift(scans.size());
  for (const SequenceBatch& batch : batches) {
    const std::size_t last = batch.first + batch.count - 1;
    const std::size_t middle = batch.first + batch.count / 2;
    const auto step = [&](std::size_t i) {
      return DriftModel().translation_per_metre * step_between(path[i - 1], path[i]).translation().norm();
    };
    for (std::size_t i = middle + 1; i <= last; ++i) drift[i] = drift[i - 1] + step(i);
    for (std::size_t i = middle; i > batch.first; --i) drift[i - 1] = drift[i] + step(i);
  }
  return drift;
}

// By itself, from a guess that is right to a metre and a few degrees.
FineResult Localizer::State::align(std::size_t number, const Eigen::Isometry3d& map_from_scan_guess) const {
  FineOptions fine = options.fine;
  fine.search_headings = false;
  const SampledScan& sample = scans[number].sample;
  return align_sample(sample, *window_of(map, sample.fine, map_from_scan_guess), map_from_scan_guess, fine);
}

std::vector<ScanPlace> Localizer::State::places_of_scans() const {
  const auto track = [this](std::size_t number, const Eigen::Isometry3d& guess) -> TrackedPose {
    const FineResult fine = align(number, guess);
    return {fine.map_from_scan, fine.inlier_share};
  };
  return carry_places(places_of_batches(), path, track, {options.found.min_inlier_share, options.batch_size});
}

std::vector<AlignedScan> Localizer::State::align_each(std::span<const ScanPlace> places) const {
  const std::vector<double> drift = drift_in_batches();
  std::vector<AlignedScan> aligned(scans.size());
  parallel_tasks(scans.size(), [&](std::size_t i) {
    aligned[i] = {places[i], scans[i].motion, {}, drift[i]};
    if (places[i].is_known()) aligned[i].fine = align(i, places[i].map_from_scan);
  });
  return aligned;
}

// The evidence is that of the deskewed points, which lie where the middle says.
SequenceScan Localizer::State::judge(std::size_t number, const PoseEstimate& first, const PoseEstimate& middle,
                                     const FineResult& fine) const {
  constexpr double kMaxDeviation = 0.5;  // [m] a pose less certain is no answer
  SequenceScan scan;
  scan.map_from_scan = first.map_from_scan;
  scan.covariance = first.covariance;
  scan.unobservable = fine.unobservable;
  const SampledScan& sample = scans[number].sample;
  const Eigen::Isometry3d map_from_points = middle.map_from_scan * scans[number].motion.first_from_middle().inverse();
  const std::shared_ptr<const VoxelMap> window = window_of(map, sample.fine, map_from_points);
  scan.evidence = weigh(sample.fine, rays_of(sample), *window, map_from_points);
  scan.reason = reason_not_found(scan.evidence, options.found);
  const double deviation = std::sqrt(first.covariance.bottomRightCorner<3, 3>().trace());
  if (scan.found() && deviation > kMaxDeviation) scan.reason = "neither the map nor odometry determine its place";
  return scan;
}

// Scans without a place are lost for the reason of their batch.
void Localizer::State::close_report(SequenceResult& result, std::span<const AlignedScan> aligned) {
  for (SequenceBatch& batch : batches) {
    for (std::size_t i = batch.first; i < batch.first + batch.count; ++i) {
      const bool is_known = aligned[i].place.is_known();
      batch.is_placed = batch.is_placed || is_known;
      if (!is_known) result.scans[i].reason = batch.search.reason;
    }
  }
  result.batches = std::move(batches);
}

SequenceResult Localizer::State::locate_all() {
  reject_contradictions();
  const std::vector<AlignedScan> aligned = align_each(places_of_scans());
  const std::vector<PoseEstimate> middles = join_scans(aligned, path, options.found.min_inlier_share, options.joint);

  SequenceResult result;
  result.scans.resize(scans.size());
  parallel_tasks(scans.size(), [&](std::size_t i) {
    if (!aligned[i].place.is_known()) return;
    result.scans[i] = judge(i, first_point_of(i, aligned, path, middles), middles[i], aligned[i].fine);
  });
  close_report(result, aligned);
  return result;
}

std::string reason_not_searchable(const MapWindows& map) {
  constexpr double kMinVoxelSize = 0.5;  // [m] features of finer levels see no more than a door
  const std::vector<double> sizes = map.voxel_sizes();
  if (sizes.size() >= 2 && sizes.back() >= kMinVoxelSize) return "";
  return "the map has no level of 1 m, which a search without a first guess needs";
}

void LocalizerOptions::check() const {
  if (batch_size == 0) throw std::invalid_argument("batch_size is 0, expected 1 or more");
  coarse.check();
  fine.check();
  verdict.check();
  found.check();
  joint.check();
}

Localizer::Localizer(MapWindows map, LocalizerOptions options) {
  options.check();
  const std::string reason = reason_not_searchable(map);
  if (!reason.empty()) throw std::invalid_argument(reason);
  if (options.upright) options.coarse.consensus.max_tilt_deg = kUprightTilt_deg;
  CoarseMap coarse_map = prepare_coarse_map(map, options.coarse);
  state_ = std::make_unique<State>(std::move(map), std::move(options), std::move(coarse_map));
}

Localizer::~Localizer() = default;
Localizer::Localizer(Localizer&&) noexcept = default;

void Localizer::add(const OdometryScan& scan) {
  State& state = *state_;
  const bool is_full = state.open_batch && state.batches.back().count == state.options.batch_size;
  if (is_full || !scan.follows) state.close_batch();
  if (!state.open_batch) state.begin_batch();

  const FineOptions& fine = state.options.fine;
  state.path.push_back({scan.odometry_from_scan, scan.follows && !state.scans.empty()});
  state.scans.push_back(
      {sample_scan(scan.points_in_scan, fine.fine_spacing, fine.coarse_spacing, fine.range), scan.motion});
  SequenceBatch& batch = state.batches.back();
  ++batch.count;
  state.open_batch->add(scan.points_in_scan, state.scans.back().sample,
                        step_between(state.path[batch.first], state.path.back()));
}

SequenceResult Localizer::finish() {
  state_->close_batch();
  SequenceResult result = state_->locate_all();
  state_->scans.clear();
  state_->path.clear();
  state_->batches.clear();
  return result;
}

}  // namespace vdbmap::registration

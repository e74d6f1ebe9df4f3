// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/localizer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "registration/batch_builder.h"
#include "registration/percent.h"
#include "registration/pose_at_time.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap::registration {
namespace {

constexpr double kUprightTilt_deg = 10;
constexpr double kDrift = 0.03;  // [m/m] of odometry

std::vector<Ray> rays_of(const SampledScan& sample) {
  constexpr std::size_t kRaysPerScan = 500;
  const std::size_t step = std::max<std::size_t>(1, sample.fine.size() / kRaysPerScan);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < sample.fine.size(); i += step) rays.push_back({Eigen::Vector3d::Zero(), sample.fine[i]});
  return rays;
}

double angle_of(const Eigen::Isometry3d& motion) { return Eigen::AngleAxisd(motion.linear()).angle(); }

// The pose of what moves rigidly with the scan.
PoseEstimate carried(const PoseEstimate& scan, const Eigen::Isometry3d& scan_from_other) {
  Matrix6d motion_of_other = Matrix6d::Identity();  // as in moved_by()
  motion_of_other.bottomLeftCorner<3, 3>() = -cross_matrix(scan.map_from_scan.linear() * scan_from_other.translation());
  return {scan.map_from_scan * scan_from_other, motion_of_other * scan.covariance * motion_of_other.transpose()};
}

std::string reason_not_found(const Evidence& evidence, const FoundCriteria& criteria) {
  if (evidence.num_points == 0) return "no point lies within the range limits";
  const double share = evidence.explained_share();
  if (share >= criteria.min_inlier_share) return "";
  return "only " + percent(share) + " of the points lie on the map, expected " + percent(criteria.min_inlier_share);
}

}  // namespace

// Where scans are thought to lie; nothing where that is not known.
using Poses = std::vector<std::optional<Eigen::Isometry3d>>;

struct Localizer::State {
  /// What is kept of a scan until the sequence ends.
  struct KeptScan {
    SampledScan sample;
    Eigen::Isometry3d odometry_from_scan;
    bool follows = true;
    ScanMotion motion;
  };

  const VoxelMap* map;
  LocalizerOptions options;
  CoarseMap coarse_map;
  std::vector<KeptScan> scans;
  std::vector<SequenceBatch> batches;
  std::optional<BatchBuilder> open_batch;

  void begin_batch();
  void close_batch();

  SequenceResult locate_all();
  void reject_contradictions();
  bool do_agree(const SequenceBatch& a, const SequenceBatch& b) const;
  Poses poses_of_batches() const;
  std::vector<double> drift_in_batches() const;
  void carry(Poses& poses, bool forward) const;
  std::vector<FineResult> align_each(const Poses& poses) const;
  std::vector<PoseEstimate> join(const Poses& poses, std::span<const FineResult> fine) const;
  PoseEstimate at_first_point(std::size_t number, const Poses& poses, std::span<const PoseEstimate> middles) const;
  SequenceScan judge(std::size_t number, const PoseEstimate& first, const PoseEstimate& middle,
                     const FineResult& fine) const;
  std::optional<std::size_t> linked(std::size_t number, bool forward) const;

  static Eigen::Isometry3d step_between(const KeptScan& previous, const KeptScan& scan) {
    return previous.odometry_from_scan.inverse() * scan.odometry_from_scan;
  }
};

void Localizer::State::begin_batch() {
  batches.push_back({.first = scans.size(), .count = 0, .search = {}, .is_placed = false});
  open_batch.emplace(map->coarsest().voxel_size(), options.fine.range);
}

void Localizer::State::close_batch() {
  if (!open_batch) return;
  SequenceBatch& batch = batches.back();
  batch.search = find_batch(open_batch->combine(), *map, coarse_map, options.coarse, options.verdict);
  open_batch.reset();
}

// Whether odometry leads from one batch's place to the other's, as far as it can be trusted; true across gaps, where
// nothing is known.
bool Localizer::State::do_agree(const SequenceBatch& a, const SequenceBatch& b) const {
  constexpr double kTranslation = 2.0;  // [m]
  constexpr double kRotation = 0.175;   // [rad] 10 degrees
  double path = 0;
  for (std::size_t i = a.first + 1; i <= b.first; ++i) {
    if (!scans[i].follows) return true;
    path += step_between(scans[i - 1], scans[i]).translation().norm();
  }
  const Eigen::Isometry3d& map_from_a = a.search.candidates.front().map_from_batch;
  const Eigen::Isometry3d& map_from_b = b.search.candidates.front().map_from_batch;
  const Eigen::Isometry3d predicted = map_from_a * step_between(scans[a.first], scans[b.first]);
  const Eigen::Isometry3d difference = predicted.inverse() * map_from_b;
  return difference.translation().norm() < kTranslation + kDrift * path && angle_of(difference) < kRotation;
}

// A batch that as many of the others contradict as agree with it, itself among these, is not believed.
void Localizer::State::reject_contradictions() {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < batches.size(); ++i) {
    if (batches[i].search.found()) found.push_back(i);
  }
  std::vector<std::size_t> rejected;
  for (const std::size_t i : found) {
    std::size_t num_agreeing = 1;
    std::size_t num_contradicting = 0;
    for (const std::size_t j : found) {
      if (j == i) continue;
      (do_agree(batches[std::min(i, j)], batches[std::max(i, j)]) ? num_agreeing : num_contradicting) += 1;
    }
    if (num_contradicting >= num_agreeing) rejected.push_back(i);
  }
  for (const std::size_t i : rejected)
    batches[i].search.reason = "odometry contradicts it: other batches lie elsewhere";
}

Poses Localizer::State::poses_of_batches() const {
  Poses poses(scans.size());
  for (const SequenceBatch& batch : batches) {
    if (!batch.search.found()) continue;
    for (std::size_t i = batch.first; i < batch.first + batch.count; ++i) {
      poses[i] = batch.search.candidates.front().map_from_batch * step_between(scans[batch.first], scans[i]);
    }
  }
  return poses;
}

// [m] of each scan, by its way from the middle of its batch: all of a batch is moved as one.
std::vector<double> Localizer::State::drift_in_batches() const {
  std::vector<double> drift(scans.size());
  for (const SequenceBatch& batch : batches) {
    const std::size_t last = batch.first + batch.count - 1;
    const std::size_t middle = batch.first + batch.count / 2;
    const auto step = [&](std::size_t i) { return kDrift * step_between(scans[i - 1], scans[i]).translation().norm(); };
    for (std::size_t i = middle + 1; i <= last; ++i) drift[i] = drift[i - 1] + step(i);
    for (std::size_t i = middle; i > batch.first; --i) drift[i - 1] = drift[i] + step(i);
  }
  return drift;
}

// The scan from which odometry leads to this one, going forward or backward through the sequence.
std::optional<std::size_t> Localizer::State::linked(std::size_t number, bool forward) const {
  if (forward) return number > 0 && scans[number].follows ? std::optional(number - 1) : std::nullopt;
  const bool has_next = number + 1 < scans.size() && scans[number + 1].follows;
  return has_next ? std::optional(number + 1) : std::nullopt;
}

// Tracks scans of batches that were not found from their neighbours that were, until they are lost for a whole batch.
void Localizer::State::carry(Poses& poses, bool forward) const {
  FineOptions fine = options.fine;
  fine.search_headings = false;
  std::size_t num_lost = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const std::size_t number = forward ? i : scans.size() - 1 - i;
    if (poses[number]) {
      num_lost = 0;
      continue;
    }
    const std::optional<std::size_t> from = linked(number, forward);
    if (!from || !poses[*from] || num_lost >= options.batch_size) continue;
    const Eigen::Isometry3d guess = *poses[*from] * step_between(scans[*from], scans[number]);
    const FineResult result = align_sample(scans[number].sample, *map, guess, fine);
    const bool is_tracked = result.inlier_share >= options.found.min_inlier_share;
    poses[number] = is_tracked ? result.map_from_scan : guess;
    num_lost = is_tracked ? 0 : num_lost + 1;
  }
}

std::vector<FineResult> Localizer::State::align_each(const Poses& poses) const {
  FineOptions fine = options.fine;
  fine.search_headings = false;
  std::vector<FineResult> results(scans.size());
  parallel_for(scans.size(), [&](std::size_t i) {
    if (poses[i]) results[i] = align_sample(scans[i].sample, *map, *poses[i], fine);
  });
  return results;
}

// Of the middles of the scans' times: their first points lie where the twist of the deskewing puts them.
std::vector<PoseEstimate> Localizer::State::join(const Poses& poses, std::span<const FineResult> fine) const {
  constexpr double kMaxShift = 1.0;  // [m] and drift, of a scan from where its batch puts it: farther ones went astray
  constexpr double kMaxTurn = 0.0873;  // [rad] 5 degrees
  const std::vector<double> drift = drift_in_batches();
  std::vector<SequencePose> sequence(scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (!poses[i]) continue;
    const Eigen::Isometry3d first_from_middle = scans[i].motion.first_from_middle();
    sequence[i].map_from_scan_guess = *poses[i] * first_from_middle;
    const Eigen::Isometry3d shift = poses[i]->inverse() * fine[i].map_from_scan;
    if (fine[i].inlier_share >= options.found.min_inlier_share && shift.translation().norm() < kMaxShift + drift[i] &&
        angle_of(shift) < kMaxTurn) {
      sequence[i].in_map = carried({fine[i].map_from_scan, fine[i].covariance}, first_from_middle);
    }
    if (i > 0 && scans[i].follows && poses[i - 1])
      sequence[i].previous_from_scan =
          scans[i - 1].motion.first_from_middle().inverse() * step_between(scans[i - 1], scans[i]) * first_from_middle;
  }
  return refine_jointly(sequence, options.joint);
}

// From where the scans before, at and after were in the middle of their times: the twist of the deskewing, from
// odometry, knows less.
PoseEstimate Localizer::State::at_first_point(std::size_t number, const Poses& poses,
                                              std::span<const PoseEstimate> middles) const {
  const auto is_deskewed = [&](std::size_t i) { return !scans[i].motion.twist.isZero(0); };
  const auto timed = [&](std::size_t i) {
    return TimedPose{scans[i].motion.elapsed + scans[i].motion.lead, middles[i].map_from_scan};
  };
  const TimedPose at = timed(number);
  const auto neighbour = [&](bool is_before) -> std::optional<TimedPose> {
    const std::optional<std::size_t> from = linked(number, is_before);
    if (!from || !poses[*from] || !is_deskewed(*from)) return std::nullopt;
    const TimedPose pose = timed(*from);
    const bool is_in_order = is_before ? pose.time < at.time : pose.time > at.time;  // turns may overlap
    return is_in_order ? std::optional(pose) : std::nullopt;
  };
  const std::optional<TimedPose> before = neighbour(true);
  const std::optional<TimedPose> after = neighbour(false);
  const ScanMotion& motion = scans[number].motion;
  if (!is_deskewed(number) || (!before && !after)) {
    return carried(middles[number], motion.first_from_middle().inverse());
  }
  const Eigen::Isometry3d map_from_first = pose_at_time(motion.elapsed, before, at, after);
  return carried(middles[number], at.map_from_sensor.inverse() * map_from_first);
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
  scan.evidence = weigh(sample.fine, rays_of(sample), *map, map_from_points);
  scan.reason = reason_not_found(scan.evidence, options.found);
  const double deviation = std::sqrt(first.covariance.bottomRightCorner<3, 3>().trace());
  if (scan.found() && deviation > kMaxDeviation) scan.reason = "neither the map nor odometry determine its place";
  return scan;
}

SequenceResult Localizer::State::locate_all() {
  reject_contradictions();
  Poses poses = poses_of_batches();
  for (const bool forward : {true, false}) carry(poses, forward);

  std::vector<FineResult> fine = align_each(poses);
  std::vector<PoseEstimate> joined = join(poses, fine);

  SequenceResult result;
  result.scans.resize(scans.size());
  parallel_for(scans.size(), [&](std::size_t i) {
    if (poses[i]) {
      result.scans[i] = judge(i, at_first_point(i, poses, joined), joined[i], fine[i]);
    } else {
      result.scans[i].reason = "its batch was not found";
    }
  });
  for (SequenceBatch& batch : batches) {
    for (std::size_t i = batch.first; i < batch.first + batch.count; ++i) {
      batch.is_placed = batch.is_placed || poses[i].has_value();
      if (!poses[i]) result.scans[i].reason = batch.search.reason;
    }
  }
  result.batches = std::move(batches);
  return result;
}

std::string reason_not_searchable(const VoxelMap& map) {
  constexpr double kMinVoxelSize = 0.5;  // [m] features of finer levels see no more than a door
  if (map.levels.size() >= 2 && map.coarsest().voxel_size() >= kMinVoxelSize) return "";
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

Localizer::Localizer(const VoxelMap& map, LocalizerOptions options) : state_(std::make_unique<State>()) {
  options.check();
  const std::string reason = reason_not_searchable(map);
  if (!reason.empty()) throw std::invalid_argument(reason);
  if (options.upright) options.coarse.consensus.max_tilt_deg = kUprightTilt_deg;
  state_->map = &map;
  state_->coarse_map = prepare_coarse_map(map.coarsest(), options.coarse);
  state_->options = std::move(options);
}

Localizer::~Localizer() = default;
Localizer::Localizer(Localizer&&) noexcept = default;

void Localizer::add(const OdometryScan& scan) {
  State& state = *state_;
  const bool is_full = state.open_batch && state.batches.back().count == state.options.batch_size;
  if (is_full || !scan.follows) state.close_batch();
  if (!state.open_batch) state.begin_batch();

  const FineOptions& fine = state.options.fine;
  state.scans.push_back({sample_scan(scan.points_in_scan, fine.fine_spacing, fine.coarse_spacing, fine.range),
                         scan.odometry_from_scan, scan.follows && !state.scans.empty(), scan.motion});
  SequenceBatch& batch = state.batches.back();
  ++batch.count;
  state.open_batch->add(scan.points_in_scan, state.scans.back().sample,
                        State::step_between(state.scans[batch.first], state.scans.back()));
}

SequenceResult Localizer::finish() {
  state_->close_batch();
  SequenceResult result = state_->locate_all();
  state_->scans.clear();
  state_->batches.clear();
  return result;
}

}  // namespace vdbmap::registration

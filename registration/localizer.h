// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "registration/batch_search.h"
#include "registration/fine/joint_refinement.h"
#include "registration/localize.h"
#include "registration/odometry/deskew.h"
#include "vdbmap/store/map_windows.h"

namespace vdbmap::registration {

/// How a sequence of scans is localized.
struct LocalizerOptions {
  std::size_t batch_size = 20;  ///< scans combined for a search in the whole map
  bool upright = false;         ///< roll and pitch of the scans are known to be within 10 degrees of the map's
  CoarseOptions coarse;
  FineOptions fine;
  VerdictOptions verdict;
  FoundCriteria found;  ///< when a single scan is believed, once its batch is
  JointOptions joint;

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
};

/// A scan as odometry left it.
struct OdometryScan {
  std::span<const Eigen::Vector3d> points_in_scan;  ///< [m] deskewed
  Eigen::Isometry3d odometry_from_scan = Eigen::Isometry3d::Identity();
  bool follows = true;     ///< odometry leads here from the scan before; false after a gap
  ScanMotion motion = {};  ///< that the points were deskewed with; zero where they have no times
};

/// One scan of the sequence, localized.
struct SequenceScan {
  Eigen::Isometry3d map_from_scan = Eigen::Isometry3d::Identity();  ///< original system; the best known, also if lost
  Matrix6d covariance = Matrix6d::Zero();  ///< rotation [rad^2] about the sensor, translation [m^2]; axes of the map
  Evidence evidence;
  std::vector<UnobservableDirection> unobservable;  ///< by this scan alone
  std::string reason;                               ///< empty when found
  std::string time_problem;  ///< why it was not deskewed although it has time stamps; empty where nothing is wrong

  bool found() const { return reason.empty(); }
};

/// A batch of consecutive scans.
struct SequenceBatch {
  std::size_t first = 0;
  std::size_t count = 0;
  BatchResult search;      ///< in the whole map
  bool is_placed = false;  ///< by the search, or by odometry from a neighbour that was found
};

struct SequenceResult {
  std::vector<SequenceScan> scans;
  std::vector<SequenceBatch> batches;
};

/// Why a map cannot be searched without a first guess: it has no level of 0.5 m or more above a finer one. Empty where
/// it can.
std::string reason_not_searchable(const MapWindows& map);

/// Localizes a sequence of scans with no first guess (Mortazavi 2023, section 2): scans are combined by odometry,
/// batches are looked for in the whole map, then every scan is aligned by itself and all of them jointly. Memory: some
/// thousand points a scan; of a city its coarser levels and the tiles around a few scans.
class Localizer {
 public:
  /// Makes the features of the map; keeps a reference to one in memory. Throws std::invalid_argument for bad options
  /// and for a map that is not searchable.
  explicit Localizer(MapWindows map, LocalizerOptions options = {});
  ~Localizer();
  Localizer(Localizer&&) noexcept;

  /// Takes the next scan; searches when a batch is full.
  void add(const OdometryScan& scan);

  /// The result for all scans added; the localizer is as new afterwards.
  SequenceResult finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vdbmap::registration

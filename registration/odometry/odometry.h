// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "registration/fine/scan_sample.h"
#include "registration/odometry/adaptive_threshold.h"
#include "registration/odometry/deskew.h"
#include "registration/odometry/local_map.h"
#include "registration/odometry/point_to_point.h"
#include "registration/odometry/scan_clock.h"
#include "registration/odometry/sensor_motion.h"
#include "vdbmap/core/point_cloud.h"

namespace vdbmap::registration {

/// The parameters of KISS-ICP with the values of the paper (Vizzo 2023, table I), which are meant for every sensor.
struct OdometryOptions {
  RangeLimits range;                  ///< [m] of points used; the least is free in the paper
  double voxel_size = 1.0;            ///< [m] of the local map; 0.01 of the greatest range
  int points_per_voxel = 20;          ///< of the local map, at most
  double map_spacing = 0.5;           ///< alpha: of the points added to the map, in voxels
  double registration_spacing = 1.5;  ///< beta: of the points aligned, in voxels
  double initial_threshold = 2.0;     ///< [m] sigma_0
  double min_deviation = 0.1;         ///< [m] a smaller deviation from the prediction is none
  int max_iterations = 500;
  double convergence = 1e-4;  ///< norm of an iteration's motion, rotation [rad] and translation [m]
  bool deskews = true;        ///< where the points have times

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
};

/// What became of one scan.
struct OdometryStep {
  Eigen::Isometry3d first_from_scan = Eigen::Isometry3d::Identity();  ///< frame of the first registered scan; where the
                                                                      ///< motion leads to if not registered
  std::string reason;  ///< why the scan was not registered; empty where it was

  /// Since the last registered scan, and how well that is known: rotation [rad^2] about the sensor, then translation
  /// [m^2], axes of that scan. Nothing for the first scan, and where the scan was not registered.
  Eigen::Isometry3d previous_from_scan = Eigen::Isometry3d::Identity();
  std::optional<Matrix6d> covariance;

  ScanMotion motion;           ///< to deskew this scan with; zero where that is not possible
  bool has_time = false;       ///< whether the time stamps could be used, `motion.reference_time` among them
  std::string time_problem;    ///< why the scan was not deskewed although it has time stamps
  double sigma = 0;            ///< [m] the adaptive threshold used
  double overlap_share = 0;    ///< of the points aligned: within half a voxel of the map
  std::size_t num_points = 0;  ///< aligned
  int num_iterations = 0;
  bool was_refound = false;  ///< the scan lay far from where its motion led to; a wider search found it
  double jump = 0;           ///< [m] between where the motion led to and where the scan was found

  bool registered() const { return reason.empty(); }
};

/// LiDAR odometry after KISS-ICP: scan after scan is moved to a map of the scans before. Memory is bounded by that map,
/// which reaches as far as the range. The steps are the same for any number of threads.
class Odometry {
 public:
  /// Throws std::invalid_argument for bad options.
  explicit Odometry(const OdometryOptions& options = {});

  /// Finds the next scan [m, frame of the sensor]. A scan that cannot be registered leaves the map as it is, and its
  /// step says why.
  OdometryStep register_scan(const PointCloud& scan);

  /// So many scans of the sequence are left out before the next.
  void pass_over(std::size_t num_scans) { clock_.pass_over(num_scans); }

  /// The points around the sensor, frame of the first registered scan.
  const LocalMap& map() const { return map_; }

 private:
  // The thinned points of a scan as measured, with their times where these can be used.
  struct Sample {
    std::vector<Eigen::Vector3d> positions;
    std::vector<double> times;
    double first_time = 0;  // [s] of the scan
    double lead = 0;        // [s] from the first time to the mean one; without usable times that of a scan before

    std::vector<Eigen::Vector3d> deskewed(const Vector6d& twist, double reference_time) const;
  };

  // The pose of a scan at its mean time, and its points, deskewed to it and thinned as for the map.
  struct Alignment {
    PointToPointResult result;
    std::vector<Eigen::Vector3d> points;
    std::vector<Eigen::Vector3d> aligned_points;

    double overlap_share() const;
  };

  // The map that begins anew with its first scan deskewed, and the scan in it that told the motion.
  struct Straightened {
    LocalMap map;
    SensorMotion motion;
    Alignment alignment;
  };

  Sample sample_of(const PointCloud& scan, const ScanTiming& timing) const;
  PointToPointOptions alignment_options(double sigma) const;
  Alignment align(const Sample& sample, const Vector6d& twist, const LocalMap& map,
                  const Eigen::Isometry3d& guess) const;
  void start(const Sample& sample);
  Straightened straightened_by(const Sample& second, const Alignment& alignment) const;
  void straighten_first_scan(const Sample& second, Alignment& alignment, const OdometryStep& step);
  double min_overlap_share(const OdometryStep& step) const;
  void search_if_lost(double usual_interval, Alignment& alignment, OdometryStep& step) const;
  void accept(const Alignment& alignment, OdometryStep& step);
  void add_to_map(const Alignment& alignment, OdometryStep& step);

  OdometryOptions options_;
  ScanClock clock_;
  AdaptiveThreshold threshold_;
  LocalMap map_;
  std::optional<Sample> first_sample_;  // until another scan is registered, which tells its motion
  SensorMotion motion_;
  Eigen::Isometry3d first_from_registered_ = Eigen::Isometry3d::Identity();  // of the last registered scan
  double last_lead_ = 0;                                                     // [s] of a scan with usable times
  double expected_share_ = 0;  // of inliers: that of the last registered scan, less for each one rejected since
};

}  // namespace vdbmap::registration

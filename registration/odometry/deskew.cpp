// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/deskew.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "vdbmap/core/parallel.h"

namespace vdbmap::registration {
namespace {

// motion_of_twist() for many points and times, with Rodrigues' formula in vectors: an exponential map for each of
// 100,000 points would cost more than the registration.
class TwistMotion {
 public:
  explicit TwistMotion(const Vector6d& twist) : rate_(twist.head<3>().norm()), velocity_(twist.tail<3>()) {
    if (rate_ < 1e-9) return;  // [rad/s]
    axis_ = twist.head<3>() / rate_;
    sideways_ = axis_.cross(velocity_) / rate_;
    backwards_ = axis_.cross(sideways_);
  }

  Eigen::Vector3d move(const Eigen::Vector3d& point, double seconds) const {
    const double angle = rate_ * seconds;
    const double sine = std::sin(angle);
    const double lift = 1 - std::cos(angle);
    const Eigen::Vector3d turned = axis_.cross(point);
    const Eigen::Vector3d turned_twice = axis_.cross(turned);
    return point + sine * turned + lift * turned_twice + seconds * velocity_ + lift * sideways_ +
           (angle - sine) * backwards_;
  }

 private:
  double rate_;                                          // [rad/s]
  Eigen::Vector3d velocity_;                             // [m/s]
  Eigen::Vector3d axis_ = Eigen::Vector3d::Zero();       // of the rotation
  Eigen::Vector3d sideways_ = Eigen::Vector3d::Zero();   // [m] axis x velocity / rate
  Eigen::Vector3d backwards_ = Eigen::Vector3d::Zero();  // [m] axis x (axis x velocity) / rate
};

}  // namespace

double mean_lead(std::span<const double> times, double first) {
  double sum = 0;
  for (const double time : times) sum += time - first;  // of small numbers, without loss
  return times.empty() ? 0 : sum / static_cast<double>(times.size());
}

std::vector<Eigen::Vector3d> deskew_points(std::span<const Eigen::Vector3d> positions, std::span<const double> times,
                                           const ScanMotion& motion) {
  if (positions.size() != times.size()) {
    throw std::invalid_argument("cannot deskew " + std::to_string(positions.size()) + " points with " +
                                std::to_string(times.size()) + " times");
  }
  constexpr std::size_t kGrain = 1024;
  const TwistMotion sensor(motion.twist);
  std::vector<Eigen::Vector3d> deskewed(positions.size());
  parallel_for(
      positions.size(),
      [&](std::size_t i) { deskewed[i] = sensor.move(positions[i], times[i] - motion.reference_time); }, kGrain);
  return deskewed;
}

PointCloud deskew(PointCloud scan, const ScanMotion& motion) {
  if (scan.times.empty() || motion.twist.isZero(0)) return scan;
  scan.positions = deskew_points(scan.positions, scan.times, motion);
  return scan;
}

}  // namespace vdbmap::registration

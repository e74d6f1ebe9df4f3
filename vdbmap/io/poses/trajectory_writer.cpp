// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

void append_number(std::string& text, double number) {
  std::array<char, 32> digits;
  const auto [end, error] =
      std::to_chars(digits.data(), digits.data() + digits.size(), number, std::chars_format::general, 17);
  if (!text.empty() && text.back() != '\n') text += ' ';
  text.append(digits.data(), end);
}

void append_kitti(std::string& text, const std::optional<Eigen::Isometry3d>& pose) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) append_number(text, pose ? pose->matrix()(row, column) : kMissing);
  }
  text += '\n';
}

void append_tum(std::string& text, double time, const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond rotation = Eigen::Quaterniond(pose.linear()).normalized();
  append_number(text, time);
  for (const double coordinate : pose.translation()) append_number(text, coordinate);
  for (const double coefficient : rotation.coeffs()) append_number(text, coefficient);  // x y z w
  text += '\n';
}

}  // namespace

void write_trajectory(const std::filesystem::path& path, const Trajectory& trajectory, TrajectoryFormat format) {
  if (!trajectory.times.empty() && trajectory.times.size() != trajectory.size()) {
    throw std::invalid_argument("trajectory of " + std::to_string(trajectory.size()) + " poses with " +
                                std::to_string(trajectory.times.size()) + " times");
  }
  std::string text;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const std::optional<Eigen::Isometry3d>& pose = trajectory.map_from_scan[i];
    if (format == TrajectoryFormat::kKitti) {
      append_kitti(text, pose);
      continue;
    }
    const double time = trajectory.times.empty() ? static_cast<double>(i) : trajectory.times[i];
    if (pose && !std::isnan(time)) append_tum(text, time, *pose);
  }
  write_file(path, text);
}

}  // namespace vdbmap

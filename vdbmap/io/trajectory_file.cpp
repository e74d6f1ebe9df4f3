// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/trajectory_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include <Eigen/SVD>

#include "vdbmap/core/error.h"
#include "vdbmap/io/atomic_file.h"
#include "vdbmap/io/text.h"

namespace vdbmap {
namespace {

constexpr std::size_t kKittiColumns = 12;
constexpr std::size_t kTumColumns = 8;
constexpr double kRotationTolerance = 1e-3;  // files with few digits pass, sheared and scaled matrices do not
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Where in the file a reason was found.
struct Place {
  const std::filesystem::path& path;
  std::uint64_t line;

  IoError error(const std::string& reason) const { return IoError::malformed_at_line(path, line, reason); }
};

std::vector<double> numbers_of(std::span<const std::string_view> words, const Place& place) {
  std::vector<double> numbers;
  for (const std::string_view word : words) {
    const std::optional<double> number = parse_number(word);
    if (!number || std::isinf(*number)) {
      throw place.error("column " + std::to_string(numbers.size() + 1) + " is " + quoted(word) +
                        ", expected a finite number or nan");
    }
    numbers.push_back(*number);
  }
  return numbers;
}

TrajectoryFormat format_of(std::size_t num_columns, const Place& place) {
  if (num_columns == kKittiColumns) return TrajectoryFormat::kKitti;
  if (num_columns == kTumColumns) return TrajectoryFormat::kTum;
  throw place.error(std::to_string(num_columns) + " columns, expected 12 (KITTI) or 8 (TUM)");
}

void check_columns(std::size_t num_columns, TrajectoryFormat format, const Place& place) {
  const std::size_t expected = format == TrajectoryFormat::kKitti ? kKittiColumns : kTumColumns;
  if (num_columns == expected) return;
  throw place.error(std::to_string(num_columns) + " columns, expected " + std::to_string(expected) +
                    " as in the lines before");
}

bool is_missing(std::span<const double> pose, const Place& place) {
  const auto num_nan = std::count_if(pose.begin(), pose.end(), [](double number) { return std::isnan(number); });
  if (num_nan == 0) return false;
  if (static_cast<std::size_t>(num_nan) == pose.size()) return true;
  throw place.error("pose with " + std::to_string(num_nan) + " of " + std::to_string(pose.size()) + " numbers nan");
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix, const Place& place) {
  const double deviation = (matrix.transpose() * matrix - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(deviation <= kRotationTolerance))
    throw place.error("matrix is not a rotation, its columns are not orthonormal");
  if (matrix.determinant() < 0) throw place.error("matrix is not a rotation but a reflection");

  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

Eigen::Isometry3d kitti_pose(std::span<const double> numbers, const Place& place) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> matrix(numbers.data());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = nearest_rotation(matrix.leftCols<3>(), place);
  pose.translation() = matrix.col(3);
  return pose;
}

Eigen::Isometry3d tum_pose(std::span<const double> numbers, const Place& place) {
  const Eigen::Quaterniond rotation(numbers[6], numbers[3], numbers[4], numbers[5]);
  if (!(std::abs(rotation.norm() - 1) <= kRotationTolerance)) {
    throw place.error("quaternion is not a rotation, its length is not 1");
  }
  Eigen::Isometry3d pose(rotation.normalized());
  pose.translation() = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
  return pose;
}

void append_pose(Trajectory& trajectory, std::span<const double> numbers, TrajectoryFormat format, const Place& place) {
  const bool is_tum = format == TrajectoryFormat::kTum;
  if (is_tum) {
    if (std::isnan(numbers[0])) throw place.error("time is nan");
    trajectory.times.push_back(numbers[0]);
    numbers = numbers.subspan(1);
  }
  std::optional<Eigen::Isometry3d>& pose = trajectory.map_from_scan.emplace_back();
  if (!is_missing(numbers, place)) pose = is_tum ? tum_pose(numbers, place) : kitti_pose(numbers, place);
}

void append_number(std::string& text, double number) {
  std::array<char, 32> digits;
  const auto [end, error] =
      std::to_chars(digits.data(), digits.data() + digits.size(), number, std::chars_format::general, 17);
  if (!text.empty() && text.back() != '\n') text += ' ';
  text.append(digits.data(), end);
}

void append_kitti(std::string& text, const std::optional<Eigen::Isometry3d>& pose) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) append_number(text, pose ? pose->matrix()(row, column) : kNan);
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

Trajectory read_trajectory(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw IoError::system(path, "cannot open", errno);

  Trajectory trajectory;
  std::optional<TrajectoryFormat> format;
  std::string line;
  for (std::uint64_t number = 1; std::getline(file, line); ++number) {
    const std::vector<std::string_view> words = split_words(line);
    if (words.empty() || words.front().starts_with('#')) continue;
    const Place place{path, number};
    if (!format) format = format_of(words.size(), place);
    check_columns(words.size(), *format, place);
    append_pose(trajectory, numbers_of(words, place), *format, place);
  }
  if (file.bad()) throw IoError::system(path, "cannot read", errno);
  if (!format) throw IoError::malformed(path, "holds no poses");
  return trajectory;
}

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
    } else if (pose) {
      append_tum(text, trajectory.times.empty() ? static_cast<double>(i) : trajectory.times[i], *pose);
    }
  }
  write_file(path, text);
}

}  // namespace vdbmap

// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/core/nearest_rotation.h"
#include "vdbmap/io/file/line_reader.h"
#include "vdbmap/io/file/text.h"
#include "vdbmap/io/poses/pose_layout.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap {
namespace {

constexpr double kRotationTolerance = 1e-3;    // files with few digits pass, sheared and scaled matrices do not
constexpr double kQuaternionTolerance = 1e-2;  // of the length, for two digits a coefficient
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Where in the file a reason was found.
struct Place {
  const std::filesystem::path& path;
  std::uint64_t line;

  IoError error(const std::string& reason) const { return IoError::malformed_at_line(path, line, reason); }
};

// An empty field is a missing number.
double number_of(std::span<const std::string_view> fields, std::size_t column, const Place& place) {
  const std::string_view field = fields[column];
  if (field.empty()) return kNan;
  const std::optional<double> number = parse_number(field);
  if (number && !std::isinf(*number)) return *number;
  const bool has_other_separator = field.find_first_of(", \t") != std::string_view::npos;
  throw place.error("column " + std::to_string(column + 1) + " is " + quoted(field) +
                    ", expected a finite number or nan" +
                    (has_other_separator ? " with a decimal point, and one separator for all columns" : ""));
}

bool is_missing(std::span<const double> pose, const Place& place) {
  const auto num_nan = std::count_if(pose.begin(), pose.end(), [](double number) { return std::isnan(number); });
  if (num_nan == 0) return false;
  if (static_cast<std::size_t>(num_nan) == pose.size()) return true;
  throw place.error("pose with " + std::to_string(num_nan) + " of " + std::to_string(pose.size()) + " numbers nan");
}

Eigen::Matrix3d rotation_of_file(const Eigen::Matrix3d& matrix, const Place& place) {
  const double deviation = (matrix.transpose() * matrix - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(deviation <= kRotationTolerance))
    throw place.error("matrix is not a rotation, its columns are not orthonormal");
  if (matrix.determinant() < 0) throw place.error("matrix is not a rotation but a reflection");
  return nearest_rotation(matrix);
}

Eigen::Isometry3d matrix_pose(std::span<const double> numbers, const Place& place) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> matrix(numbers.data());
  if (numbers.size() == 16) {
    const Eigen::Map<const Eigen::RowVector4d> last_row(numbers.data() + 12);
    if (!last_row.isApprox(Eigen::RowVector4d::UnitW(), kRotationTolerance)) {
      throw place.error("the last row of the 4x4 matrix is not 0 0 0 1");
    }
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation_of_file(matrix.leftCols<3>(), place);
  pose.translation() = matrix.col(3);
  return pose;
}

Eigen::Isometry3d quaternion_pose(std::span<const double> numbers, const Place& place) {
  const Eigen::Quaterniond rotation(numbers[6], numbers[3], numbers[4], numbers[5]);
  if (!(std::abs(rotation.norm() - 1) <= kQuaternionTolerance)) {
    throw place.error("quaternion is not a rotation, its length is not 1");
  }
  Eigen::Isometry3d pose(rotation.normalized());
  pose.translation() = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
  return pose;
}

bool has_zero_quaternion(std::span<const double> numbers) {
  return std::all_of(numbers.begin() + 3, numbers.end(), [](double number) { return number == 0; });
}

std::string line_text(std::uint64_t line) { return "line " + std::to_string(line); }

/// Takes a file line by line. What stands before the first pose may name the columns, as a comment or without a mark.
class TrajectoryReader {
 public:
  explicit TrajectoryReader(const std::filesystem::path& path) : path_(path) {}

  void take_line(std::string_view line) {
    ++line_;
    const std::size_t begin = line.find_first_not_of(" \t\v\f");
    if (begin == std::string_view::npos) return;
    for (const std::string_view mark : {"#", "%", "//"}) {
      if (!line.substr(begin).starts_with(mark)) continue;
      if (!layout_) comments_.emplace_back(line.substr(begin + mark.size()));
      return;
    }
    const char separator = layout_ ? separator_ : pose_separator(line);
    std::vector<std::string_view> fields = split_fields(line, separator);
    if (!layout_ && is_header(fields)) return take_header(line);
    if (!layout_) find_layout(separator, fields);
    if (fields.size() == layout_->num_columns + 1 && fields.back().empty()) fields.pop_back();
    take_pose(fields);
  }

  Trajectory finish() {
    if (!layout_ && !header_.empty() && !layout_of_header(header_, pose_separator(header_))) refuse_header();
    if (!layout_) throw IoError::malformed(path_, "holds no poses");
    scale_times();
    return std::move(trajectory_);
  }

 private:
  Place place() const { return {path_, line_}; }

  static bool is_header(std::span<const std::string_view> fields) {
    const auto is_like_number = [](std::string_view field) {
      return parse_number(field) ||
             (!field.empty() && std::string_view("+-.0123456789").find(field.front()) != std::string_view::npos);
    };
    return std::none_of(fields.begin(), fields.end(), is_like_number) &&
           std::any_of(fields.begin(), fields.end(), [](std::string_view field) { return !field.empty(); });
  }

  void take_header(std::string_view line) {
    if (!header_.empty()) refuse_header();
    header_ = line;
    header_line_ = line_;
  }

  [[noreturn]] void refuse_header() const {
    throw Place{path_, header_line_}.error(vdbmap::quoted(header_) +
                                           " is neither a pose nor names the columns of one, as timestamp tx ty tz qx "
                                           "qy qz qw do");
  }

  void find_layout(char separator, std::span<const std::string_view> fields) {
    separator_ = separator;
    for (const std::string& comment : comments_) {
      if (const auto named = layout_of_header(comment, separator)) layout_ = named;
    }
    if (!header_.empty()) {
      layout_ = layout_of_header(header_, separator);
      if (!layout_) refuse_header();
    }
    if (layout_) return;
    layout_ = layout_of_columns(fields.size());
    if (!layout_ && fields.back().empty()) layout_ = layout_of_columns(fields.size() - 1);
    if (layout_) return;
    throw place().error(std::to_string(fields.size()) +
                        " columns, expected 12 (KITTI) or 8 (TUM), 16 (4x4), or a header that names them");
  }

  void take_pose(std::span<const std::string_view> fields) {
    if (fields.size() != layout_->num_columns) {
      throw place().error(std::to_string(fields.size()) + " columns, expected " + std::to_string(layout_->num_columns) +
                          (layout_->is_named ? " as the header names" : " as in the lines before"));
    }
    if (layout_->time) {
      trajectory_.times.push_back(number_of(fields, *layout_->time, place()));
      if (std::isnan(trajectory_.times.back())) throw place().error("time is nan");
    }
    std::vector<double> numbers;
    if (layout_->is_matrix) {
      for (std::size_t i = 0; i < fields.size(); ++i) numbers.push_back(number_of(fields, i, place()));
    } else {
      for (const std::size_t column : layout_->columns) numbers.push_back(number_of(fields, column, place()));
    }
    std::optional<Eigen::Isometry3d>& pose = trajectory_.map_from_scan.emplace_back();
    if (is_missing(numbers, place())) return;
    if (layout_->is_matrix) {
      pose = matrix_pose(numbers, place());
    } else if (has_zero_quaternion(numbers)) {
      add_finding(trajectory_.findings, {"poses with a quaternion of zeros taken as missing", 1, line_text(line_)});
    } else {
      pose = quaternion_pose(numbers, place());
    }
  }

  // Seconds since 1970 have ten digits; no epoch in use gives more than eleven.
  void scale_times() {
    if (!layout_->time) return;
    if (!layout_->seconds_per_unit) guess_unit();
    const double seconds_per_unit = layout_->seconds_per_unit.value_or(1);
    for (double& time : trajectory_.times) time *= seconds_per_unit;
  }

  void guess_unit() {
    double greatest = 0;
    for (const double time : trajectory_.times) greatest = std::max(greatest, std::abs(time));
    constexpr std::tuple<double, double, const char*> kUnits[] = {
        {1e17, 1e-9, "nanoseconds"}, {1e14, 1e-6, "microseconds"}, {1e11, 1e-3, "milliseconds"}};
    for (const auto& [least, seconds, unit] : kUnits) {
      if (greatest < least) continue;
      if (separator_ == ',' && !layout_->is_named) {
        throw IoError::malformed(path_, std::string("times in ") + unit +
                                            " and no header: whether the quaternions begin with x or w, as EuRoC's "
                                            "do, is not known; expected a first line that names the columns");
      }
      layout_->seconds_per_unit = seconds;
      add_finding(trajectory_.findings, {std::string("its times are taken as ") + unit});
      return;
    }
  }

  const std::filesystem::path& path_;
  std::uint64_t line_ = 0;
  std::vector<std::string> comments_;  // before the first pose
  std::string header_;                 // a line without a number before the first pose
  std::uint64_t header_line_ = 0;
  std::optional<PoseLayout> layout_;  // known from the first pose on
  char separator_ = ' ';
  Trajectory trajectory_;
};

}  // namespace

Trajectory read_trajectory(const std::filesystem::path& path) {
  LineReader lines(path);
  TrajectoryReader reader(path);
  while (const auto line = lines.next()) reader.take_line(*line);
  return reader.finish();
}

}  // namespace vdbmap

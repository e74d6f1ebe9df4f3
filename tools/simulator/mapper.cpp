// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/mapper.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "vdbmap/core/parallel.h"

namespace vdbmap::simulator {
namespace {

using std::numbers::pi;

constexpr double kRoof = 1.55;             // [m] height of the mapper's own car
constexpr double kRoofRear = -1.95;        // [m] before the middle between the axles
constexpr double kRoofFront = 1.5;         // [m]
constexpr double kHalfRoofWidth = 0.8;     // [m]
constexpr std::size_t kLinesAtOnce = 256;  // kept apart before they are joined
constexpr double kPicturePeriod = 0.25;    // [s] between the camera's pictures
constexpr double kHidden = 0.2;            // [m] nearer than the point is what hides it

// The scanners stand at the rear end of the roof and look backwards over it.
bool hits_own_roof(const Eigen::Isometry3d& vehicle_from_scanner, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d origin = vehicle_from_scanner.translation();
  const Eigen::Vector3d down = vehicle_from_scanner.linear() * direction;
  if (down.z() >= 0) return false;
  const Eigen::Vector3d at_roof = origin + (kRoof - origin.z()) / down.z() * down;
  return kRoofRear < at_roof.x() && at_roof.x() < kRoofFront && std::abs(at_roof.y()) < kHalfRoofWidth;
}

void append_point(Survey& survey, const SceneView& view, const Eigen::Vector3d& position, const Rgb16& color,
                  const Echo& echo, double intensity, double time) {
  survey.cloud.positions.push_back(position);
  survey.cloud.colors.push_back(color);
  survey.cloud.intensities.push_back(static_cast<float>(std::min(intensity, 1.0)));
  survey.cloud.times.push_back(time);
  survey.truth.push_back(view.truth(echo.triangle));
}

// Lines of both scanners alternate.
struct LineId {
  std::size_t scanner;
  double start_time;  // [s]
  std::uint64_t seed;
};

// A line, and where its points really are [m, scene frame].
struct Line {
  Survey survey;
  std::vector<Eigen::Vector3d> true_points;
};

// What all lines of a survey share.
struct Setting {
  const SceneView& view;
  const Drive& drive;
  const MapperModel& mapper;
  const Daylight& light;
  const Eigen::Vector3d& origin;
  const MapOptions& options;
};

// The camera takes a picture every so often from the front of the roof; what it does not see has the colour of what
// hides it.
std::optional<Rgb16> blunder(const Setting& setting, const SceneView& view, const Eigen::Vector3d& point, double time,
                             RayRandom& random) {
  const double picture_time = kPicturePeriod * std::round(time / kPicturePeriod);
  const Eigen::Vector3d camera = setting.drive.scene_from_vehicle(picture_time) * Eigen::Vector3d(-0.6, 0, 2.0);
  const double distance = (point - camera).norm();
  const Ray ray = {camera, (point - camera) / distance, 1.0, distance - kHidden};
  const SceneView then = view.at(picture_time);
  const std::optional<Hit> hit = then.first_hit(ray);
  if (!hit) return std::nullopt;
  return color_of(then, setting.light, camera + hit->distance * ray.direction, {0, hit->triangle, hit->normal, 0},
                  random);
}

Rgb16 with_gain(const Rgb16& color, const Eigen::Array3d& gain) {
  const auto channel = [](std::uint16_t value, double factor) {
    return static_cast<std::uint16_t>(std::clamp(std::lround(value * factor), 0L, 65535L));
  };
  return {channel(color.r, gain[0]), channel(color.g, gain[1]), channel(color.b, gain[2])};
}

Rgb16 measured_color(const Setting& setting, const SceneView& view, const Eigen::Vector3d& point, const Echo& echo,
                     double time, RayRandom& random) {
  const Rgb16 color = color_of(view, setting.light, point, echo, random);
  const MapperError* error = setting.options.error;
  if (error == nullptr) return color;
  const std::optional<Rgb16> other =
      error->has_camera_blunders ? blunder(setting, view, point, time, random) : std::nullopt;
  return with_gain(other.value_or(color), error->color_gain);
}

// Where the survey has a point that was measured from a vehicle at a time.
Eigen::Isometry3d estimated_scanner(const Setting& setting, const Eigen::Isometry3d& scene_from_vehicle,
                                    const LineId& line, double time) {
  const Eigen::Isometry3d& mounting = setting.mapper.vehicle_from_scanner[line.scanner];
  const MapperError* error = setting.options.error;
  if (error == nullptr) return scene_from_vehicle * mounting;
  const double distance = setting.options.speed * (time - setting.drive.start_time());
  return error->estimated(scene_from_vehicle, distance) * error->estimated_mounting(mounting, line.scanner);
}

Line measure_line(const Setting& setting, const LineId& line) {
  Line result;
  const MapperModel& mapper = setting.mapper;
  const MapperError* error = setting.options.error;
  const Eigen::Isometry3d& mounting = mapper.vehicle_from_scanner[line.scanner];
  for (int pulse = 0; pulse < mapper.pulses_per_line; ++pulse) {
    const Eigen::Vector3d in_scanner = mapper.direction(pulse);
    if (hits_own_roof(mounting, in_scanner)) continue;
    const double time = line.start_time + pulse / (mapper.line_rate * mapper.pulses_per_line);
    const Eigen::Isometry3d scene_from_vehicle = setting.drive.scene_from_vehicle(time);
    const Eigen::Isometry3d scene_from_scanner = scene_from_vehicle * mounting;
    const Eigen::Vector3d direction = scene_from_scanner.linear() * in_scanner;
    RayRandom random(hash(line.seed, static_cast<std::uint64_t>(pulse)));
    const SceneView view = setting.view.at(time);
    const auto echo = measure(view, mapper.pulse, scene_from_scanner.translation(), direction, random);
    if (!echo) continue;
    const Eigen::Vector3d point = scene_from_scanner.translation() + echo->range * direction;
    const Rgb16 color = measured_color(setting, view, point, *echo, time, random);
    Eigen::Vector3d measured = point;
    if (error != nullptr) {
      measured = estimated_scanner(setting, scene_from_vehicle, line, time) * (echo->range * in_scanner);
      result.true_points.push_back(point);
    }
    const double gain = error != nullptr ? error->intensity_gain[line.scanner] : 1.0;
    append_point(result.survey, view, setting.origin + measured, color, *echo, gain * echo->reflectivity, time);
  }
  return result;
}

void take_note(SurveyFrame& frame, const Line& line, const Eigen::Vector3d& origin) {
  for (std::size_t i = 0; i < line.true_points.size(); i += 8) {
    frame.add(line.true_points[i], line.survey.cloud.positions[i] - origin, line.survey.cloud.times[i]);
  }
}

Survey map_lines(const Setting& setting, std::uint64_t seed, std::size_t first, std::size_t last) {
  Survey survey;
  for (std::size_t begin = first; begin < last; begin += kLinesAtOnce) {
    std::vector<Line> lines(std::min(kLinesAtOnce, last - begin));
    parallel_for(lines.size(), [&](std::size_t i) {
      const std::size_t line = begin + i;
      const double start = setting.drive.start_time() + static_cast<double>(line / 2) / setting.mapper.line_rate;
      lines[i] = measure_line(setting, {line % 2, start, hash(seed, line)});
    });
    for (const Line& line : lines) {
      survey.append(line.survey);
      if (setting.options.frame != nullptr) take_note(*setting.options.frame, line, setting.origin);
    }
  }
  return survey;
}

std::size_t num_lines(const Drive& drive, const MapperModel& mapper, double time) {
  return 2 * static_cast<std::size_t>(std::max(0.0, time - drive.start_time()) * mapper.line_rate);
}

}  // namespace

Eigen::Vector3d MapperModel::direction(int pulse_of_line) const {
  const double angle = 2 * pi * pulse_of_line / pulses_per_line;
  return {0, std::cos(angle), std::sin(angle)};
}

MapperModel vmx250() {
  MapperModel mapper;
  mapper.pulse = {.nearest = 1.0, .farthest = 100, .range_noise = 0.005, .half_range = 130, .random_loss = 0.005};
  for (const std::size_t i : {0, 1}) {
    const double side = i == 0 ? 1 : -1;
    mapper.vehicle_from_scanner[i] = Eigen::Translation3d(-1.95, side * 0.25, 2.35) *
                                     Eigen::AngleAxisd(side * pi / 4, Eigen::Vector3d::UnitZ()) *
                                     Eigen::AngleAxisd(pi / 7, Eigen::Vector3d::UnitY());
  }
  return mapper;
}

Survey map_street(const SceneView& view, const Drive& drive, const MapperModel& mapper, const Daylight& light,
                  const Eigen::Vector3d& origin, std::uint64_t seed, const MapOptions& options) {
  return map_part(view, drive, mapper, light, origin, seed, options, drive.start_time(), drive.end_time());
}

Survey map_part(const SceneView& view, const Drive& drive, const MapperModel& mapper, const Daylight& light,
                const Eigen::Vector3d& origin, std::uint64_t seed, const MapOptions& options, double from, double to) {
  return map_lines({view, drive, mapper, light, origin, options}, seed, num_lines(drive, mapper, from),
                   num_lines(drive, mapper, to));
}

}  // namespace vdbmap::simulator

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/mapper.h"

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

// The scanners stand at the rear end of the roof and look backwards over it.
bool hits_own_roof(const Eigen::Isometry3d& vehicle_from_scanner, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d origin = vehicle_from_scanner.translation();
  const Eigen::Vector3d down = vehicle_from_scanner.linear() * direction;
  if (down.z() >= 0) return false;
  const Eigen::Vector3d at_roof = origin + (kRoof - origin.z()) / down.z() * down;
  return kRoofRear < at_roof.x() && at_roof.x() < kRoofFront && std::abs(at_roof.y()) < kHalfRoofWidth;
}

void append_point(Survey& survey, const SceneView& view, const Eigen::Vector3d& position, const Rgb16& color,
                  const Echo& echo, double time) {
  survey.cloud.positions.push_back(position);
  survey.cloud.colors.push_back(color);
  survey.cloud.intensities.push_back(static_cast<float>(std::min(echo.reflectivity, 1.0)));
  survey.cloud.times.push_back(time);
  const Triangle& triangle = view.mesh.triangles[echo.triangle];
  survey.truth.push_back({static_cast<std::uint16_t>(view.materials[triangle.material].label), triangle.object});
}

// Lines of both scanners alternate.
struct LineId {
  std::size_t scanner;
  double start_time;  // [s]
  std::uint64_t seed;
};

Survey measure_line(const SceneView& view, const Drive& drive, const MapperModel& mapper, const Daylight& light,
                    const Eigen::Vector3d& origin, const LineId& line) {
  Survey survey;
  const Eigen::Isometry3d& mounting = mapper.vehicle_from_scanner[line.scanner];
  for (int pulse = 0; pulse < mapper.pulses_per_line; ++pulse) {
    const Eigen::Vector3d in_scanner = mapper.direction(pulse);
    if (hits_own_roof(mounting, in_scanner)) continue;
    const double time = line.start_time + pulse / (mapper.line_rate * mapper.pulses_per_line);
    const Eigen::Isometry3d scene_from_scanner = drive.scene_from_vehicle(time) * mounting;
    const Eigen::Vector3d direction = scene_from_scanner.linear() * in_scanner;
    RayRandom random(hash(line.seed, static_cast<std::uint64_t>(pulse)));
    const auto echo = measure(view, mapper.pulse, scene_from_scanner.translation(), direction, random);
    if (!echo) continue;
    const Eigen::Vector3d point = scene_from_scanner.translation() + echo->range * direction;
    append_point(survey, view, origin + point, color_of(view, light, point, *echo, random), *echo, time);
  }
  return survey;
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
                  const Eigen::Vector3d& origin, std::uint64_t seed) {
  const double duration = drive.end_time() - drive.start_time();
  const std::size_t num_lines = 2 * static_cast<std::size_t>(duration * mapper.line_rate);
  Survey survey;
  for (std::size_t begin = 0; begin < num_lines; begin += kLinesAtOnce) {
    std::vector<Survey> lines(std::min(kLinesAtOnce, num_lines - begin));
    parallel_for(lines.size(), [&](std::size_t i) {
      const std::size_t line = begin + i;
      const double start = drive.start_time() + static_cast<double>(line / 2) / mapper.line_rate;
      lines[i] = measure_line(view, drive, mapper, light, origin, {line % 2, start, hash(seed, line)});
    });
    for (const Survey& line : lines) survey.append(line);
  }
  return survey;
}

}  // namespace vdbmap::simulator

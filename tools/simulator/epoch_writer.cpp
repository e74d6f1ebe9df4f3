// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/epoch_writer.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "tools/simulator/mapper.h"
#include "tools/simulator/scan_poses.h"
#include "tools/simulator/street_json.h"
#include "tools/simulator/traffic_plan.h"
#include "tools/simulator/truth_files.h"
#include "tools/simulator/visibility.h"
#include "tools/simulator/weather.h"
#include "vdbmap/core/error.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/io/kitti/label_file.h"
#include "vdbmap/io/las/las.h"
#include "vdbmap/io/pcd/pcd.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::simulator {
namespace {

constexpr int kEpsg = 25832;
constexpr double kMapperSpeed = 13;         // [m/s]
constexpr double kScanSpeed = 9;            // [m/s] at most
constexpr double kScannedShare = 0.62;      // of the street's length: its middle, with houses to see on both sides
constexpr double kDay = 86400;              // [s]
constexpr double kMorning = 36000;          // [s] of the day
constexpr std::size_t kScansAtOnce = 16;    // in memory
constexpr double kTrajectoryPeriod = 0.01;  // [s] of the mapper's poses in a file
constexpr double kFromTourEnd = 5;          // [m] of a tour that is not driven
constexpr double kPartTime = 15;            // [s] of a tour in one file
constexpr double kSpecks = 1e-4;            // [1/m] chance of an echo for each mm/h of rain

DriveOptions mapper_drive(const Street& street, const Route& route, int epoch) {
  DriveOptions drive;
  drive.from = street.tour.empty() ? 0 : route.begin() + kFromTourEnd;
  drive.to = street.tour.empty() ? street.layouts.front().length : route.end() - kFromTourEnd;
  drive.speed = kMapperSpeed;
  drive.start_time = epoch * kDay + kMorning;
  drive.seed = hash(hash(street.options.seed, 71), static_cast<std::uint64_t>(epoch));
  return drive;
}

// Up the middle of a street in the time that the scans take; through a quarter for that time, or all the way.
DriveOptions scan_drive(const Street& street, const Route& route, int epoch, std::optional<double> duration) {
  DriveOptions drive;
  drive.start_time = epoch * kDay + kMorning + 600;  // after the mapper
  drive.seed = hash(hash(street.options.seed, 72), static_cast<std::uint64_t>(epoch));
  if (!street.tour.empty()) {
    drive.from = route.begin() + kFromTourEnd;
    drive.to = duration ? drive.from : route.end() - kFromTourEnd;
    drive.shortest_time = duration.value_or(0);
    drive.speed = kScanSpeed;
    return drive;
  }
  const double street_length = street.layouts.front().length;
  const double time = duration.value();
  const double length = std::min(kScanSpeed * time, kScannedShare * street_length);
  drive.from = (street_length - length) / 2;
  drive.to = drive.from;
  drive.speed = length / time;
  drive.shortest_time = time;
  return drive;
}

// Names without extension of what a turning scanner's files and folders are called: the VLP-16's have no name in them.
std::string scans_name(const Sensor& sensor) { return sensor.name == "vlp16" ? "scans" : "scans_" + sensor.name; }
std::string poses_name(const Sensor& sensor) { return sensor.name == "vlp16" ? "poses" : "poses_" + sensor.name; }

// A number of the sensor for seeds: named ones have their place in the table, others a number of their letters.
std::uint64_t number_of(const Sensor& sensor) {
  const auto& named = named_sensors();
  const auto found = std::ranges::find(named, sensor.name, &Sensor::name);
  if (found != named.end()) return static_cast<std::uint64_t>(found - named.begin());
  std::uint64_t number = 0;
  for (const char letter : sensor.name) number = hash(number, static_cast<unsigned char>(letter));
  return number;
}

// The middles of vehicles that stand in the carriageway, or near enough to it [m, scene frame].
std::vector<Eigen::Vector2d> obstacles_of(const Street& street, int epoch) {
  std::vector<Eigen::Vector2d> obstacles;
  for (const ParkedVehicle* vehicle : street.vehicles(epoch)) {
    if (vehicle->space == kNoSpace) obstacles.emplace_back(vehicle->scene_from_vehicle.translation().head<2>());
  }
  return obstacles;
}

FieldOfView field_of(const LidarModel& lidar) {
  const auto [low, high] = std::ranges::minmax_element(lidar.lasers, {}, &Laser::elevation);
  return {lidar.vehicle_from_scanner, low->elevation, high->elevation, std::min(60.0, lidar.pulse.farthest)};
}

FieldOfView field_of(const MapperModel& mapper) { return {mapper.vehicle_from_scanner[0]}; }

class EpochWriter {
 public:
  EpochWriter(const std::filesystem::path& folder, Street& street, int epoch, const SimulateOptions& options,
              SimulationRecord& record)
      : folder_(folder),
        street_(street),
        route_(street.route()),
        epoch_(epoch),
        options_(options),
        record_(record),
        mesh_(street.mesh(epoch)),
        caster_(mesh_),
        materials_(street.world.materials()) {}

  EpochResult write() {
    std::filesystem::create_directories(folder_ / "labels");
    const auto vehicles = street_.vehicles(epoch_);
    result_.num_vehicles = vehicles.size();
    write_vehicles(folder_ / "vehicles.csv", street_, epoch_);
    for (const Sensor& sensor : sensors_of_epoch(options_.sensors, epoch_)) {
      if (sensor.is_mapper()) {
        write_cloud();
      } else {
        write_scans(sensor);
      }
    }
    return result_;
  }

 private:
  std::uint64_t seed(std::uint64_t use) const {
    return hash(hash(street_.options.seed, 80 + use), static_cast<std::uint64_t>(epoch_));
  }

  bool is_ideal() const { return street_.options.is_ideal; }

  Eigen::Isometry3d map_from_scene() const { return Eigen::Isometry3d(Eigen::Translation3d(street_.origin())); }

  SceneView view() const { return {mesh_, materials_, caster_, traffic_ ? &*traffic_ : nullptr, 0}; }

  // What moves during a drive, and the materials of the day, its own among them; nothing on an ideal street.
  void begin_drive(const Drive& drive, const DriveOptions& options, const std::string& sensor) {
    if (is_ideal()) return;
    traffic_.emplace(plan_traffic(street_.world, route_, options, drive.end_time() - drive.start_time(),
                                  obstacles_of(street_, epoch_), epoch_, hash(options.seed, 73)));
    const bool wet = options_.rain > 0 || is_wet(street_.options.seed, epoch_);
    materials_ = weathered(street_.world.materials(), wet, street_.options.seed);
    write_movers(folder_ / ("movers_" + sensor + ".csv"), *traffic_, street_.world, street_.origin());
  }

  void end_drive(const Drive& drive, const std::string& sensor, const FieldOfView& field) {
    if (is_ideal()) return;
    record_.seen.push_back({epoch_, sensor, space_visibility(street_, epoch_, view(), drive, field)});
  }

  void note_drive(const std::string& sensor, const DriveOptions& drive, const nlohmann::ordered_json& scanner) {
    record_.drives.push_back(
        {{"epoch", epoch_}, {"sensor", sensor}, {"drive", json_of_drive(drive)}, {"scanner", scanner}});
  }

  void write_cloud() {
    const DriveOptions drive_options = mapper_drive(street_, route_, epoch_);
    const Drive drive(route_, drive_options);
    MapperModel mapper = vmx250();
    note_drive("mapper", drive_options, json_of_mapper(mapper));
    begin_drive(drive, drive_options, "mapper");
    const MapperError error = is_ideal() ? MapperError() : make_mapper_error(seed(0));
    if (!is_ideal()) {
      record_.drives.back()["error"] = json_of_mapper_error(error);
      record_.mapped.push_back({epoch_, {}});
      mapper.pulse.specks = kSpecks * options_.rain;
    }
    write_parts(drive, mapper, error);
    write_mapper_trajectory(drive, error);
    end_drive(drive, "mapper", field_of(mapper));
    options_.on_step();
  }

  // One file, or for a tour one of each part of it: so a quarter's cloud need not be held in memory whole.
  void write_parts(const Drive& drive, const MapperModel& mapper, const MapperError& error) {
    const Daylight light = make_daylight(street_.options.seed, epoch_);
    MapOptions options;
    if (!is_ideal()) options = {&error, &record_.mapped.back().frame, kMapperSpeed};
    const bool is_tour = !street_.tour.empty();
    const double part_time = is_tour ? kPartTime : drive.end_time() - drive.start_time() + 1;
    if (is_tour) std::filesystem::create_directories(folder_ / "labels" / "clouds");
    if (is_tour) std::filesystem::create_directories(folder_ / "clouds");
    int part = 0;
    for (double from = drive.start_time(); from < drive.end_time(); from += part_time, ++part) {
      const double to = std::min(from + part_time, drive.end_time());
      const Survey survey = map_part(view(), drive, mapper, light, street_.origin(), seed(0), options, from, to);
      const std::string name = is_tour ? fmt::format("clouds/{:03}", part) : "cloud";
      result_.num_cloud_points += survey.cloud.size();
      write_las(folder_ / (name + ".las"), survey.cloud, {.epsg = kEpsg});
      write_labels(folder_ / "labels" / (name + ".label"), survey.truth);
    }
  }

  // Where the mapper was, and where it believes it was.
  void write_mapper_trajectory(const Drive& drive, const MapperError& error) const {
    Trajectory trajectory, estimated;
    for (double time = drive.start_time(); time <= drive.end_time(); time += kTrajectoryPeriod) {
      const Eigen::Isometry3d pose = drive.scene_from_vehicle(time);
      trajectory.times.push_back(time);
      trajectory.map_from_scan.emplace_back(map_from_scene() * pose);
      estimated.times.push_back(time);
      estimated.map_from_scan.emplace_back(map_from_scene() *
                                           error.estimated(pose, kMapperSpeed * (time - drive.start_time())));
    }
    write_trajectory(folder_ / "mapper.tum", trajectory, TrajectoryFormat::kTum);
    if (!is_ideal()) write_trajectory(folder_ / "mapper_estimated.tum", estimated, TrajectoryFormat::kTum);
  }

  LidarModel lidar_of(const Sensor& sensor) const {
    if (is_ideal()) return *sensor.lidar;
    // The same scanner in every epoch.
    LidarModel lidar = with_errors(*sensor.lidar, hash(street_.options.seed, number_of(sensor)));
    lidar.pulse.specks = kSpecks * options_.rain;
    return lidar;
  }

  // The time of a scan's pose is that of its first point, by the clock that is right.
  static double time_of(const Survey& scan, const LidarModel& lidar, double start) {
    return scan.cloud.times.empty() ? start : scan.cloud.times.front() - lidar.clock_error;
  }

  void write_scans(const Sensor& sensor) {
    const LidarModel lidar = lidar_of(sensor);
    const bool takes_all = !street_.tour.empty() && !options_.num_scans;
    const double wanted = options_.num_scans.value_or(kNumScans);
    const DriveOptions drive_options =
        scan_drive(street_, route_, epoch_, takes_all ? std::nullopt : std::optional(wanted * lidar.turn_time));
    const Drive drive(route_, drive_options);
    const double turns = std::floor((drive.end_time() - drive.start_time()) / lidar.turn_time);
    const auto num_scans = static_cast<std::size_t>(takes_all ? turns : wanted);
    note_drive(sensor.name, drive_options, json_of_lidar(lidar));
    begin_drive(drive, drive_options, sensor.name);
    std::filesystem::create_directories(folder_ / scans_name(sensor));
    std::filesystem::create_directories(folder_ / "labels" / scans_name(sensor));

    const auto start_of = [&](std::size_t index) {
      return drive.start_time() + static_cast<double>(index) * lidar.turn_time;
    };
    ScanPoses poses(record_.mapped);
    for (std::size_t begin = 0; begin < num_scans; begin += kScansAtOnce) {
      std::vector<Survey> scans(std::min(kScansAtOnce, num_scans - begin));
      parallel_for(scans.size(),
                   [&](std::size_t i) { scans[i] = take_scan(sensor, lidar, drive, start_of(begin + i), begin + i); });
      for (std::size_t i = 0; i < scans.size(); ++i) {
        const double start = start_of(begin + i);
        poses.append(scans[i], drive.scene_from_vehicle(time_of(scans[i], lidar, start)), lidar.vehicle_from_scanner,
                     start, map_from_scene());
        result_.num_scan_points += scans[i].cloud.size();
      }
    }
    result_.num_scans += num_scans;
    poses.write(folder_, poses_name(sensor));
    end_drive(drive, sensor.name, field_of(lidar));
    if (!street_.tour.empty()) options_.on_step();
  }

  Survey take_scan(const Sensor& sensor, const LidarModel& lidar, const Drive& drive, double start,
                   std::size_t index) const {
    Survey scan = scan_turn(view(), drive, lidar, start, hash(seed(1 + number_of(sensor)), index));
    const std::string name = fmt::format("{:06}", index);
    write_pcd(folder_ / scans_name(sensor) / (name + ".pcd"), scan.cloud);
    write_labels(folder_ / "labels" / scans_name(sensor) / (name + ".label"), scan.truth);
    if (street_.tour.empty()) options_.on_step();
    return scan;
  }

  const std::filesystem::path& folder_;
  Street& street_;
  Route route_;
  int epoch_;
  const SimulateOptions& options_;
  SimulationRecord& record_;
  Mesh mesh_;
  RayCaster caster_;
  std::vector<Material> materials_;
  std::optional<Traffic> traffic_;
  EpochResult result_;
};

}  // namespace

EpochResult write_epoch(const std::filesystem::path& folder, Street& street, int epoch, const SimulateOptions& options,
                        SimulationRecord& record) {
  return EpochWriter(folder, street, epoch, options, record).write();
}

}  // namespace vdbmap::simulator

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/epoch_writer.h"

#include <algorithm>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "tools/simulator/mapper.h"
#include "tools/simulator/street_json.h"
#include "tools/simulator/truth_files.h"
#include "vdbmap/core/error.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/io/label_file.h"
#include "vdbmap/io/las.h"
#include "vdbmap/io/pcd.h"
#include "vdbmap/io/trajectory_file.h"

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

DriveOptions mapper_drive(const Street& street, int epoch) {
  DriveOptions drive;
  drive.from = 0;
  drive.to = street.layouts.front().length;
  drive.speed = kMapperSpeed;
  drive.start_time = epoch * kDay + kMorning;
  drive.seed = hash(hash(street.options.seed, 71), static_cast<std::uint64_t>(epoch));
  return drive;
}

DriveOptions scan_drive(const Street& street, int epoch, double duration) {
  const double length = std::min(kScanSpeed * duration, kScannedShare * street.layouts.front().length);
  DriveOptions drive;
  drive.from = (street.layouts.front().length - length) / 2;
  drive.to = drive.from;
  drive.speed = length / duration;
  drive.shortest_time = duration;
  drive.start_time = epoch * kDay + kMorning + 600;  // after the mapper
  drive.seed = hash(hash(street.options.seed, 72), static_cast<std::uint64_t>(epoch));
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

class EpochWriter {
 public:
  EpochWriter(const std::filesystem::path& folder, const Street& street, int epoch, const SimulateOptions& options,
              nlohmann::ordered_json& drives)
      : folder_(folder),
        street_(street),
        epoch_(epoch),
        options_(options),
        drives_(drives),
        mesh_(street.mesh(epoch)),
        caster_(mesh_),
        view_{mesh_, street.world.materials(), caster_} {}

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

  Eigen::Isometry3d map_from_scene() const { return Eigen::Isometry3d(Eigen::Translation3d(street_.origin())); }

  void note_drive(const std::string& sensor, const DriveOptions& drive, const nlohmann::ordered_json& scanner) {
    drives_.push_back({{"epoch", epoch_}, {"sensor", sensor}, {"drive", json_of_drive(drive)}, {"scanner", scanner}});
  }

  void write_cloud() {
    const DriveOptions drive_options = mapper_drive(street_, epoch_);
    const Drive drive(street_.layouts.front(), drive_options);
    const MapperModel mapper = vmx250();
    note_drive("mapper", drive_options, json_of_mapper(mapper));
    const Daylight light = make_daylight(street_.options.seed, epoch_);
    const Survey survey = map_street(view_, drive, mapper, light, street_.origin(), seed(0));
    result_.num_cloud_points = survey.cloud.size();
    write_las(folder_ / "cloud.las", survey.cloud, {.epsg = kEpsg});
    write_labels(folder_ / "labels" / "cloud.label", survey.truth);
    write_mapper_trajectory(drive);
    options_.on_step();
  }

  void write_mapper_trajectory(const Drive& drive) const {
    Trajectory trajectory;
    for (double time = drive.start_time(); time <= drive.end_time(); time += kTrajectoryPeriod) {
      trajectory.times.push_back(time);
      trajectory.map_from_scan.emplace_back(map_from_scene() * drive.scene_from_vehicle(time));
    }
    write_trajectory(folder_ / "mapper.tum", trajectory, TrajectoryFormat::kTum);
  }

  void write_scans(const Sensor& sensor) {
    const LidarModel& lidar = *sensor.lidar;
    const auto num_scans = static_cast<std::size_t>(options_.num_scans);
    const DriveOptions drive_options = scan_drive(street_, epoch_, static_cast<double>(num_scans) * lidar.turn_time);
    const Drive drive(street_.layouts.front(), drive_options);
    note_drive(sensor.name, drive_options, json_of_lidar(lidar));
    std::filesystem::create_directories(folder_ / scans_name(sensor));
    std::filesystem::create_directories(folder_ / "labels" / scans_name(sensor));

    Trajectory trajectory;
    for (std::size_t begin = 0; begin < num_scans; begin += kScansAtOnce) {
      std::vector<Survey> scans(std::min(kScansAtOnce, num_scans - begin));
      parallel_for(scans.size(), [&](std::size_t i) { scans[i] = take_scan(sensor, drive, begin + i); });
      for (const Survey& scan : scans) {
        // The pose of a scan is that of its first point.
        const double time = scan.cloud.times.front();
        trajectory.times.push_back(time);
        trajectory.map_from_scan.emplace_back(map_from_scene() * drive.scene_from_vehicle(time) *
                                              lidar.vehicle_from_scanner);
        result_.num_scan_points += scan.cloud.size();
      }
    }
    result_.num_scans += num_scans;
    write_trajectory(folder_ / (poses_name(sensor) + ".txt"), trajectory, TrajectoryFormat::kKitti);
    write_trajectory(folder_ / (poses_name(sensor) + ".tum"), trajectory, TrajectoryFormat::kTum);
  }

  Survey take_scan(const Sensor& sensor, const Drive& drive, std::size_t index) const {
    const LidarModel& lidar = *sensor.lidar;
    const double start = drive.start_time() + static_cast<double>(index) * lidar.turn_time;
    Survey scan = scan_turn(view_, drive, lidar, start, hash(seed(1 + number_of(sensor)), index));
    const std::string name = fmt::format("{:06}", index);
    write_pcd(folder_ / scans_name(sensor) / (name + ".pcd"), scan.cloud);
    write_labels(folder_ / "labels" / scans_name(sensor) / (name + ".label"), scan.truth);
    options_.on_step();
    return scan;
  }

  const std::filesystem::path& folder_;
  const Street& street_;
  int epoch_;
  const SimulateOptions& options_;
  nlohmann::ordered_json& drives_;
  Mesh mesh_;
  RayCaster caster_;
  SceneView view_;
  EpochResult result_;
};

}  // namespace

EpochResult write_epoch(const std::filesystem::path& folder, const Street& street, int epoch,
                        const SimulateOptions& options, nlohmann::ordered_json& drives) {
  return EpochWriter(folder, street, epoch, options, drives).write();
}

}  // namespace vdbmap::simulator

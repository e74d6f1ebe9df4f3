// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/epoch_writer.h"

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "tools/simulator/lidar.h"
#include "tools/simulator/mapper.h"
#include "tools/simulator/street_json.h"
#include "tools/simulator/truth_files.h"
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

DriveOptions mapper_drive(const Street& street, int epoch) {
  DriveOptions drive;
  drive.from = 0;
  drive.to = street.layout.length;
  drive.speed = kMapperSpeed;
  drive.start_time = epoch * kDay + kMorning;
  drive.seed = hash(hash(street.options.seed, 71), static_cast<std::uint64_t>(epoch));
  return drive;
}

DriveOptions scan_drive(const Street& street, int epoch, double duration) {
  const double length = std::min(kScanSpeed * duration, kScannedShare * street.layout.length);
  DriveOptions drive;
  drive.from = (street.layout.length - length) / 2;
  drive.to = drive.from;
  drive.speed = length / duration;
  drive.shortest_time = duration;
  drive.start_time = epoch * kDay + kMorning + 600;  // after the mapper
  drive.seed = hash(hash(street.options.seed, 72), static_cast<std::uint64_t>(epoch));
  return drive;
}

// The folders, files and model of a turning scanner.
struct LidarFiles {
  const char* scans;
  const char* poses;  // without extension
  LidarModel model;
};

LidarFiles files_of(Sensor sensor) {
  if (sensor == Sensor::kHdl64) return {"scans_hdl64", "poses_hdl64", hdl64()};
  return {"scans", "poses", vlp16()};
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
    for (const Sensor sensor : sensors_of_epoch(options_, epoch_)) {
      if (sensor == Sensor::kMapper) {
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

  Eigen::Isometry3d map_from_scene() const {
    return Eigen::Isometry3d(Eigen::Translation3d(street_.layout.axis.origin));
  }

  void note_drive(Sensor sensor, const DriveOptions& drive, const nlohmann::ordered_json& scanner) {
    drives_.push_back(
        {{"epoch", epoch_}, {"sensor", name_of(sensor)}, {"drive", json_of_drive(drive)}, {"scanner", scanner}});
  }

  void write_cloud() {
    const DriveOptions drive_options = mapper_drive(street_, epoch_);
    const Drive drive(street_.layout, drive_options);
    const MapperModel mapper = vmx250();
    note_drive(Sensor::kMapper, drive_options, json_of_mapper(mapper));
    const Daylight light = make_daylight(street_.options.seed, epoch_);
    const Survey survey = map_street(view_, drive, mapper, light, street_.layout.axis.origin, seed(0));
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

  void write_scans(Sensor sensor) {
    const LidarFiles files = files_of(sensor);
    const auto num_scans = static_cast<std::size_t>(options_.num_scans);
    const DriveOptions drive_options =
        scan_drive(street_, epoch_, static_cast<double>(num_scans) * files.model.turn_time);
    const Drive drive(street_.layout, drive_options);
    note_drive(sensor, drive_options, json_of_lidar(files.model));
    std::filesystem::create_directories(folder_ / files.scans);
    std::filesystem::create_directories(folder_ / "labels" / files.scans);

    Trajectory trajectory;
    for (std::size_t begin = 0; begin < num_scans; begin += kScansAtOnce) {
      std::vector<Survey> scans(std::min(kScansAtOnce, num_scans - begin));
      parallel_for(scans.size(), [&](std::size_t i) { scans[i] = take_scan(sensor, files, drive, begin + i); });
      for (const Survey& scan : scans) {
        // The pose of a scan is that of its first point.
        const double time = scan.cloud.times.front();
        trajectory.times.push_back(time);
        trajectory.map_from_scan.emplace_back(map_from_scene() * drive.scene_from_vehicle(time) *
                                              files.model.vehicle_from_scanner);
        result_.num_scan_points += scan.cloud.size();
      }
    }
    result_.num_scans += num_scans;
    write_trajectory(folder_ / (std::string(files.poses) + ".txt"), trajectory, TrajectoryFormat::kKitti);
    write_trajectory(folder_ / (std::string(files.poses) + ".tum"), trajectory, TrajectoryFormat::kTum);
  }

  Survey take_scan(Sensor sensor, const LidarFiles& files, const Drive& drive, std::size_t index) const {
    const double start = drive.start_time() + static_cast<double>(index) * files.model.turn_time;
    Survey scan = scan_turn(view_, drive, files.model, start, hash(seed(1 + static_cast<int>(sensor)), index));
    const std::string name = fmt::format("{:06}", index);
    write_pcd(folder_ / files.scans / (name + ".pcd"), scan.cloud);
    write_labels(folder_ / "labels" / files.scans / (name + ".label"), scan.truth);
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

std::vector<Sensor> sensors_of_epoch(const SimulateOptions& options, int epoch) {
  if (options.sensors.empty()) return {epoch == 0 ? Sensor::kMapper : Sensor::kVlp16};
  std::vector<Sensor> sensors;
  for (const Sensor sensor : {Sensor::kMapper, Sensor::kVlp16, Sensor::kHdl64}) {
    const bool is_used = std::ranges::any_of(options.sensors, [&](const SensorUse& use) {
      return use.sensor == sensor && use.epoch.value_or(epoch) == epoch;
    });
    if (is_used) sensors.push_back(sensor);
  }
  return sensors;
}

const char* name_of(Sensor sensor) {
  constexpr std::array<const char*, 3> kNames = {"mapper", "vlp16", "hdl64"};
  return kNames[static_cast<std::size_t>(sensor)];
}

}  // namespace vdbmap::simulator

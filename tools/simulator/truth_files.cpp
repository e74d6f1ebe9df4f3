// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/truth_files.h"

#include <cmath>
#include <iterator>
#include <string>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "vdbmap/io/file/atomic_file.h"

namespace vdbmap::simulator {
namespace {

using Json = nlohmann::ordered_json;
using SeenSpaces = std::vector<SimulationRecord::SeenSpaces>;

// Coordinates to a tenth of a millimetre: 17 digits would only show how doubles round.
double rounded(double value) { return std::round(value * 1e4) / 1e4; }

Json json_of_outline(const Street& street, const ParkingSpace& space) {
  Json ring = Json::array();
  for (const Eigen::Vector3d& corner : outline_of(street, space)) {
    ring.push_back({rounded(corner.x()), rounded(corner.y()), rounded(corner.z())});
  }
  ring.push_back(ring.front());  // closed, as RFC 7946 wants it
  return {{"type", "Polygon"}, {"coordinates", Json::array({ring})}};
}

// What blocks the space in each epoch, and how much of it each drive saw.
void add_rough_truth(Json& properties, const Street& street, std::size_t index, const SeenSpaces& seen) {
  Json blocked_by = Json::array();
  for (const auto& epoch : street.parking.thing_in_space)
    blocked_by.push_back(epoch[index] ? Json(*epoch[index]) : Json());
  properties["blocked_by"] = blocked_by;
  Json visibility = Json::array();
  for (const SimulationRecord::SeenSpaces& drive : seen) {
    visibility.push_back({{"epoch", drive.epoch}, {"sensor", drive.sensor}, {"share", drive.shares[index]}});
  }
  properties["visibility"] = visibility;
}

Json json_of_space(const Street& street, std::size_t index, const SeenSpaces& seen) {
  const ParkingSpace& space = street.parking.spaces[index];
  const SideLayout& side = street.layouts[space.street].sides[space.side];
  Json states = Json::array();
  Json vehicles = Json::array();
  for (const auto& epoch : street.parking.vehicle_in_space) {
    const auto& vehicle = epoch[index];
    states.push_back(vehicle ? "occupied" : "vacant");
    vehicles.push_back(vehicle ? Json(street.parking.vehicles[*vehicle].object) : Json());
  }
  const double heading = street.layouts[space.street].axis.heading_at(space.station) + space.yaw;
  Json properties = {{"id", index},
                     {"side", side.sign > 0 ? "left" : "right"},
                     {"kind", space.in_car_park ? "car park" : name_of(side.parking)},
                     {"length", space.length},
                     {"width", space.width},
                     {"heading", std::remainder(heading, 2 * EIGEN_PI)},
                     {"states", states},
                     {"vehicles", vehicles}};
  if (street.layouts.size() > 1) properties["street"] = space.street;
  if (!street.options.is_ideal) add_rough_truth(properties, street, index, seen);
  return {{"type", "Feature"}, {"geometry", json_of_outline(street, space)}, {"properties", properties}};
}

}  // namespace

VehicleBox box_of(const Street& street, const ParkedVehicle& vehicle) {
  const Eigen::Isometry3d& frame = vehicle.scene_from_vehicle;
  const Eigen::Matrix3d& rotation = frame.linear();
  VehicleBox box;
  box.center = street.origin() + frame * Eigen::Vector3d(0, 0, vehicle.shape.height / 2);
  box.size = {vehicle.shape.length, vehicle.shape.width, vehicle.shape.height};
  box.heading = std::atan2(rotation(1, 0), rotation(0, 0));
  box.pitch = -std::asin(rotation(2, 0));
  box.roll = std::atan2(rotation(2, 1), rotation(2, 2));
  return box;
}

std::vector<Eigen::Vector3d> outline_of(const Street& street, const ParkingSpace& space) {
  const double offset = street.layouts[space.street].sides[space.side].sign * space.distance;
  const Eigen::Isometry3d frame = street.layouts[space.street].place(space.station, offset, space.yaw);
  const double x = space.length / 2;
  const double y = space.width / 2;
  std::vector<Eigen::Vector3d> corners;
  for (const auto& [along, aside] : {std::pair(x, y), std::pair(-x, y), std::pair(-x, -y), std::pair(x, -y)}) {
    corners.emplace_back(street.origin() + frame * Eigen::Vector3d(along, aside, 0));
  }
  return corners;
}

void write_vehicles(const std::filesystem::path& path, const Street& street, int epoch) {
  std::string text = "id,body,x,y,z,length,width,height,heading,pitch,roll,space\n";
  for (const ParkedVehicle* vehicle : street.vehicles(epoch)) {
    const VehicleBox box = box_of(street, *vehicle);
    fmt::format_to(std::back_inserter(text),
                   "{},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.6f},{:.6f},{:.6f},{}\n", vehicle->object,
                   name_of(vehicle->shape.body), box.center.x(), box.center.y(), box.center.z(), box.size.x(),
                   box.size.y(), box.size.z(), box.heading, box.pitch, box.roll,
                   vehicle->space == kNoSpace ? -1 : static_cast<std::int64_t>(vehicle->space));
  }
  write_file(path, text);
}

void write_spaces(const std::filesystem::path& path, const Street& street,
                  const std::vector<SimulationRecord::SeenSpaces>& seen) {
  Json features = Json::array();
  for (std::size_t i = 0; i < street.parking.spaces.size(); ++i) features.push_back(json_of_space(street, i, seen));
  // The member that GeoJSON had for other systems than WGS 84 before RFC 7946; GDAL and QGIS still read it.
  const Json crs = {{"type", "name"}, {"properties", {{"name", "urn:ogc:def:crs:EPSG::25832"}}}};
  const Json collection = {{"type", "FeatureCollection"}, {"crs", crs}, {"features", features}};
  write_file(path, collection.dump(1) + "\n");
}

void write_movers(const std::filesystem::path& path, const Traffic& traffic, const World& world,
                  const Eigen::Vector3d& origin) {
  std::string text = "object,kind,time,x,y,z,heading\n";
  constexpr std::size_t kStep = 4;  // of the mover's poses
  for (const Traffic::Mover& mover : traffic.movers()) {
    for (std::size_t i = 0; i < mover.scene_from_body.size(); i += kStep) {
      const Eigen::Isometry3d& pose = mover.scene_from_body[i];
      const Eigen::Vector3d position = origin + pose.translation();
      fmt::format_to(std::back_inserter(text), "{},{},{:.2f},{:.3f},{:.3f},{:.3f},{:.4f}\n", mover.object,
                     world.objects()[mover.object].kind, mover.begin_time + Traffic::kPeriod * static_cast<double>(i),
                     position.x(), position.y(), position.z(), std::atan2(pose.linear()(1, 0), pose.linear()(0, 0)));
    }
  }
  write_file(path, text);
}

std::size_t write_changes(const std::filesystem::path& path, const Street& street) {
  std::size_t count = 0;
  AtomicFile file(path);
  file.write("from_epoch,to_epoch,x,y,z,change,label,object\n");
  const Eigen::Vector3d anchor = change_anchor(street);
  for (int epoch = 0; epoch + 1 < street.options.num_epochs; ++epoch) {
    for (const ChangedVoxel& voxel : changed_voxels(street, epoch)) {
      const Eigen::Vector3d center = anchor + center_of_voxel(voxel.voxel, kChangeVoxelSize);
      file.write(fmt::format("{},{},{:.2f},{:.2f},{:.2f},{},{},{}\n", epoch, epoch + 1, center.x(), center.y(),
                             center.z(), voxel.has_appeared ? "appeared" : "vanished", voxel.label, voxel.object));
      ++count;
    }
  }
  file.commit();
  return count;
}

}  // namespace vdbmap::simulator

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "tools/simulator/changes.h"
#include "tools/simulator/simulation_record.h"
#include "tools/simulator/street.h"
#include "tools/simulator/traffic.h"

namespace vdbmap::simulator {

/// A vehicle's box, standing in EPSG:25832: its rotation is Rz(heading) Ry(pitch) Rx(roll).
struct VehicleBox {
  Eigen::Vector3d center;  ///< [m]
  Eigen::Vector3d size;    ///< [m] length, width without mirrors, height
  double heading;          ///< [rad] from east to north
  double pitch;            ///< [rad] nose down
  double roll;             ///< [rad] left side up
};
VehicleBox box_of(const Street& street, const ParkedVehicle& vehicle);

/// A space's four corners [m, EPSG:25832], counterclockwise.
std::vector<Eigen::Vector3d> outline_of(const Street& street, const ParkingSpace& space);

/// id,body,x,y,z,length,width,height,heading,pitch,roll,space of the vehicles that stand there in an epoch; space -1
/// for those in none. Throws IoError.
void write_vehicles(const std::filesystem::path& path, const Street& street, int epoch);

/// Parking spaces as polygons in EPSG:25832, each with its state in every epoch and the share of it that each drive
/// saw. Throws IoError.
void write_spaces(const std::filesystem::path& path, const Street& street,
                  const std::vector<SimulationRecord::SeenSpaces>& seen);

/// object,kind,time,x,y,z,heading of what moves, five times a second [m, EPSG:25832; rad]. Throws IoError.
void write_movers(const std::filesystem::path& path, const Traffic& traffic, const World& world,
                  const Eigen::Vector3d& origin);

/// from_epoch,to_epoch,x,y,z,change,label,object of all voxels that changed. Returns their number. Throws IoError.
std::size_t write_changes(const std::filesystem::path& path, const Street& street);

}  // namespace vdbmap::simulator

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "tools/simulator/changes.h"
#include "tools/simulator/street.h"

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

/// id,body,x,y,z,length,width,height,heading,pitch,roll,space of the vehicles of an epoch. Throws IoError.
void write_vehicles(const std::filesystem::path& path, const Street& street, int epoch);

/// Parking spaces as polygons in EPSG:25832, each with its state in every epoch. Throws IoError.
void write_spaces(const std::filesystem::path& path, const Street& street);

/// from_epoch,to_epoch,x,y,z,change,label,object of all voxels that changed. Returns their number. Throws IoError.
std::size_t write_changes(const std::filesystem::path& path, const Street& street);

}  // namespace vdbmap::simulator

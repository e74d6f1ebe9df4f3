// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "vdbmap/io/points/point_reader.h"

namespace vdbmap {

// Packet captures of a Velodyne VLP-16 (Puck), Puck Lite, Puck Hi-Res or HDL-32E, in single or dual return mode.
//
// Frame: x forward (azimuth 0, opposite to the cable), y left, z up, metres, as other drivers for robots have it. With
// distance r, elevation w and azimuth a, which runs clockwise seen from above,
//   x = r cos(w) cos(a),  y = -r cos(w) sin(a),  z = r sin(w) + vertical offset of the laser,
// which is the manual's frame (X right, Y forward) turned by 90 degrees: x = Y, y = -X. The azimuth is interpolated
// to the firing of each laser.
//
// Rings count from the lowest laser, intensities are calibrated reflectivities 0..255, times [s] count from the hour in
// which the capture began, and on over the next. Where several sensors were captured, one is decoded: the one that is
// chosen, else the first on port 2368, else the first; the findings name the others.

/// Reads all points of a capture. Damaged packets are left out, and what follows where the file itself is damaged, and
/// the findings say so. Throws IoError for a sensor that is not supported, and where there are no points.
ReadResult read_vlp16_pcap(const std::filesystem::path& path, const ReadOptions& options = {});

/// As read_vlp16_pcap(), but one cloud a turn: each begins with the data block in which the azimuth passes 0. The first
/// and the last turn are as incomplete as the capture has them.
std::vector<PointCloud> read_vlp16_scans(const std::filesystem::path& path);

}  // namespace vdbmap

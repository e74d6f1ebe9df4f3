// SPDX-License-Identifier: GPL-3.0-or-later
// How well boxes around the vehicles of a labelled map fit the true ones: vehicle_accuracy LABELLED.vdb VEHICLES.csv,
// the second one of `vdbmap simulate`. Vehicles count where the map has 100 voxels of theirs or more, whatever they are
// called.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "parking/objects/vehicles.h"
#include "vdbmap/io/vdb/map_file.h"

namespace vdbmap::parking {
namespace {

constexpr double kFound = 0.5;        // overlap in plan
constexpr double kAboveGround = 0.3;  // [m] what is lower in a box may be the road

// id, body, x, y, z, length, width, height, heading, pitch, roll, space
std::vector<UprightBox> read_boxes(const std::filesystem::path& path, const Eigen::Vector3d& anchor) {
  std::vector<UprightBox> boxes;
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::vector<std::string> fields;
    std::stringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    UprightBox box;
    box.center = Eigen::Vector3d(std::stod(fields.at(2)), std::stod(fields[3]), std::stod(fields[4])) - anchor;
    box.length = std::stod(fields[5]);
    box.width = std::stod(fields[6]);
    box.height = std::stod(fields[7]);
    box.heading = std::stod(fields[8]);
    boxes.push_back(box);
  }
  return boxes;
}

// Voxels in a box, of whatever class, but those of the road.
std::size_t num_seen(const VoxelLevel& level, const UprightBox& box) {
  std::size_t count = 0;
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    const Eigen::Vector3d mean = mean_of(level.records()[number], voxel, level.voxel_size());
    const double from_middle = mean.z() - box.center.z();
    if (from_middle < kAboveGround - box.height / 2 || from_middle > box.height / 2) return;
    count += box.contains(mean.head<2>()) ? 1 : 0;
  });
  return count;
}

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  std::ranges::sort(values);
  return values[values.size() / 2];
}

int run(const std::filesystem::path& map_path, const std::filesystem::path& truth_path) {
  const VoxelMap map = load_map(map_path);
  const std::vector<Vehicle> found = find_vehicles(map.finest());
  std::vector<double> centers, headings, lengths, widths;
  std::size_t num_visible = 0;
  std::vector<bool> is_true(found.size(), false);
  for (const UprightBox& truth : read_boxes(truth_path, map.frame.anchor)) {
    if (num_seen(map.finest(), truth) < 100) continue;
    ++num_visible;
    const auto overlap = [&](const Vehicle& vehicle) { return overlap_in_plan(vehicle.box, truth); };
    const auto best = std::ranges::max_element(found, {}, overlap);
    if (best == found.end() || overlap(*best) < kFound) continue;
    is_true[static_cast<std::size_t>(best - found.begin())] = true;
    centers.push_back((best->box.center - truth.center).head<2>().norm());
    headings.push_back(std::abs(std::remainder(best->box.heading - truth.heading, std::numbers::pi)) * 180 /
                       std::numbers::pi);
    lengths.push_back(std::abs(best->box.length - truth.length));
    widths.push_back(std::abs(best->box.width - truth.width));
  }
  const auto num_doubted = std::ranges::count_if(found, [](const Vehicle& vehicle) { return !vehicle.doubt.empty(); });
  std::printf(
      "%zu of %zu vehicles with 100 voxels or more found; %zu boxes, %zd of them doubted, %zd of no such vehicle\n",
      centers.size(), num_visible, found.size(), num_doubted, std::ranges::count(is_true, false));
  std::printf("medians: centre %.3f m, heading %.2f deg, length %.3f m, width %.3f m\n", median(centers),
              median(headings), median(lengths), median(widths));
  return 0;
}

}  // namespace
}  // namespace vdbmap::parking

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: vehicle_accuracy LABELLED.vdb VEHICLES.csv\n");
    return 2;
  }
  try {
    return vdbmap::parking::run(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

// SPDX-License-Identifier: GPL-3.0-or-later
// update_accuracy MAP.vdb SCANS LABELS POSES [MIN_RANGE]: how well an update tells what moved within a drive. LABELS
// holds a .label file a scan, SemanticKITTI's classes: 252 and above moved, 0 and 1 do not count, the others stood
// still. Prints the share of moving points that were left out (DA of DUFOMap, Duberg et al. 2024), the share of still
// ones that were kept (SA), by class too, and how long it took.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <vector>

#include "registration/posed_scans.h"
#include "vdbmap/change/map_update.h"
#include "vdbmap/core/point_cell.h"
#include "vdbmap/io/kitti/label_file.h"
#include "vdbmap/io/points/point_cloud_filter.h"
#include "vdbmap/io/scans/scan_poses.h"
#include "vdbmap/io/vdb/map_file.h"

namespace vdbmap {
namespace {

struct KeptScan {
  PointCloud cloud;
  Eigen::Isometry3d map_from_cloud;
  std::vector<Eigen::Vector3d> origins;
  double time;
  double time_stamp;
};

struct Count {
  std::size_t kept = 0;
  std::size_t left_out = 0;

  double share_left_out() const {
    return static_cast<double>(left_out) / static_cast<double>(std::max<std::size_t>(kept + left_out, 1));
  }
};

std::vector<KeptScan> read_drive(const std::filesystem::path& folder, const std::filesystem::path& labels,
                                 const std::filesystem::path& poses, double min_range) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::ranges::sort(files);
  const std::vector<ScanPlace> places = list_scans(files);
  const ScanPoses of_scans = read_scan_poses(poses, places, PoseFrame::kLidar);
  std::vector<KeptScan> drive;
  registration::PosedScans deskewed([&](const PosedCloud& posed) {
    drive.push_back({posed.cloud,
                     posed.map_from_cloud,
                     {posed.origins_in_cloud.begin(), posed.origins_in_cloud.end()},
                     posed.time,
                     posed.time_stamp});
  });
  ScanReader reader({.is_in_sensor_frame = true});
  for (std::size_t i = 0; i < places.size() && i < of_scans.poses.size(); ++i) {
    const auto label_file = labels / files[i].filename().replace_extension(".label");
    if (!of_scans.poses.map_from_scan[i] || !std::filesystem::exists(label_file)) {
      deskewed.pass_over(1);
      continue;
    }
    ReadResult read = reader.read(places[i]);
    attach_labels(read, label_file);
    drop_out_of_range(read, {min_range, 1e9});
    deskewed.add(std::move(read.cloud), *of_scans.poses.map_from_scan[i]);
  }
  deskewed.finish();
  return drive;
}

// A point was kept where the updated map has points of the drive's epoch in its voxel.
std::map<int, Count> count_points(const std::vector<KeptScan>& drive, const VoxelMap& updated, std::int32_t epoch) {
  const VoxelLevel& level = updated.finest();
  const VoxelFinder finder(level);
  std::map<int, Count> counts;
  for (const KeptScan& scan : drive) {
    Eigen::Isometry3d local_from_scan = scan.map_from_cloud;
    local_from_scan.translation() -= updated.frame.anchor;
    const CellFinder cells(local_from_scan, voxels_per_metre(level.voxel_size()));
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
      const std::optional<PointCell> cell = cells.find(scan.cloud.positions[i]);
      if (!cell) continue;
      const VoxelRecord* record = finder.find(cell->voxel);
      const bool is_kept =
          record && level.channels().last_epochs[static_cast<std::size_t>(record - level.records().data())] == epoch;
      Count& count = counts[scan.cloud.labels[i]];
      ++(is_kept ? count.kept : count.left_out);
    }
  }
  return counts;
}

void print(const std::map<int, Count>& counts) {
  Count moving;
  Count still;
  for (const auto& [label, count] : counts) {
    Count& sum = label >= 252 ? moving : still;
    if (label > 1) {
      sum.kept += count.kept;
      sum.left_out += count.left_out;
    }
    std::printf("class %3d: %9zu kept, %8zu left out (%.4f)\n", label, count.kept, count.left_out,
                count.share_left_out());
  }
  std::printf("moving points left out (DA) %.4f of %zu, still points kept (SA) %.4f of %zu\n", moving.share_left_out(),
              moving.kept + moving.left_out, 1 - still.share_left_out(), still.kept + still.left_out);
}

int run(char** arguments, double min_range) {
  constexpr std::int32_t kEpoch = 1'000'000;
  const VoxelMap map = load_map(arguments[1]);
  const std::vector<KeptScan> drive = read_drive(arguments[2], arguments[3], arguments[4], min_range);
  const CloudSource source = [&](const std::function<void(const PosedCloud&)>& take) {
    for (const KeptScan& scan : drive) {
      take({scan.cloud, scan.map_from_cloud, scan.origins, scan.time, scan.time_stamp});
    }
  };
  UpdateOptions options;
  options.epoch = kEpoch;
  const auto start = std::chrono::steady_clock::now();
  const UpdatedMap updated = update_map(map, std::nullopt, source, options);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  print(count_points(drive, updated.map, kEpoch));
  std::printf("map: %zu voxels, %zu gone, %zu replaced, %zu confirmed, %zu unseen, %zu added\n", map.finest().size(),
              updated.counts.gone, updated.counts.replaced, updated.counts.confirmed, updated.counts.unseen,
              updated.counts.added);
  std::printf(
      "%zu scans of %.0f points in %.2f s: %.1f scans a second\n", drive.size(),
      static_cast<double>(updated.counts.num_points) / static_cast<double>(std::max<std::size_t>(drive.size(), 1)),
      seconds, static_cast<double>(drive.size()) / seconds);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace vdbmap

int main(int count, char** arguments) {
  if (count < 5 || count > 6) {
    std::fprintf(stderr, "update_accuracy MAP.vdb SCANS LABELS POSES [MIN_RANGE]\n");
    return EXIT_FAILURE;
  }
  try {
    return vdbmap::run(arguments, count == 6 ? std::atof(arguments[5]) : 3.0);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
}

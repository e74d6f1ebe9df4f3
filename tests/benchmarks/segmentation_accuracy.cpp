// SPDX-License-Identifier: GPL-3.0-or-later
// How well the network tells classes apart on what it was not trained on: segmentation_accuracy WEIGHTS FOLDER..., each
// a street of `vdbmap simulate` (its survey and the VLP-16 scans of its second epoch), or a real drive with velodyne/,
// labels/*.u8 and poses.txt (kitti00 of the real data).
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "parking/segmentation/segment.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/point_cell.h"
#include "vdbmap/core/voxel_level.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/kitti/label_file.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::parking {
namespace {

using Confusion = std::array<std::array<std::size_t, kNumClasses>, kNumClasses>;  // a row a true class
using Truth = std::vector<std::optional<SurfaceClass>>;

// SemanticKITTI's 19 classes as kitti00/labels numbers them.
std::optional<SurfaceClass> class_of(std::uint8_t label) {
  using enum SurfaceClass;
  constexpr std::array<std::int32_t, 20> kLabels = {0,  10, 11, 15, 18, 20, 30, 31, 32, 40,
                                                    44, 48, 49, 50, 51, 70, 71, 72, 80, 81};
  return label < kLabels.size() ? surface_class_of(kLabels[label]) : std::nullopt;
}

// Points in the frame of all scans.
struct Scan {
  PointCloud cloud;
  Truth truth;
  std::vector<int> rings;
};

std::vector<int> rings_of(const PointCloud& cloud) {
  std::vector<int> rings;
  double before = 0;
  int ring = 0;
  for (const Eigen::Vector3d& point : cloud.positions) {
    const double angle = std::atan2(point.y(), point.x());
    const double turn = angle < 0 ? angle + 2 * std::numbers::pi : angle;
    if (turn < before - std::numbers::pi) ++ring;
    before = turn;
    rings.push_back(ring);
  }
  return rings;
}

std::vector<Scan> read_scans(const std::filesystem::path& folder) {
  const Trajectory poses = read_trajectory(folder / "poses.txt");
  std::vector<Scan> scans;
  for (const std::filesystem::path& file : list_point_files({folder / "velodyne"})) {
    Scan scan{read_points(file).cloud, {}, {}};
    scan.rings = rings_of(scan.cloud);
    ByteReader labels(folder / "labels" / file.filename().replace_extension(".u8"));
    for (Eigen::Vector3d& point : scan.cloud.positions) {
      point = poses.map_from_scan[scans.size()].value() * point;
      scan.truth.push_back(class_of(labels.read_le<std::uint8_t>()));
      labels.skip(1);  // the class carried over from neighbours
    }
    scans.push_back(std::move(scan));
  }
  return scans;
}

struct Part {
  PointCloud cloud;
  Truth truth;

  void add(const Scan& scan, int ring_step) {
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
      if (scan.rings[i] % ring_step != 0) continue;
      cloud.positions.push_back(scan.cloud.positions[i]);
      truth.push_back(scan.truth[i]);
    }
  }
};

struct Judgement {
  Confusion confusion{};
  std::size_t num_voxels = 0;
  double seconds = 0;
};

void judge(const Part& part, const NetworkWeights& network, Judgement& judgement) {
  const auto begin = std::chrono::steady_clock::now();
  BuildOptions options;
  options.voxel_sizes = {0.1};
  const VoxelMap map = build_map(part.cloud, options);
  const VoxelLevel& level = map.finest();
  const std::vector<SurfaceClass> classes = segment(level, network);
  judgement.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  judgement.num_voxels += level.size();
  const VoxelFinder finder(level);
  const CellFinder cells(Eigen::Isometry3d(Eigen::Translation3d(-map.frame.anchor)), 10);
  for (std::size_t i = 0; i < part.cloud.size(); ++i) {
    if (!part.truth[i]) continue;
    const VoxelRecord* record = finder.find(cells.of_reached(part.cloud.positions[i]).voxel);
    const SurfaceClass found = classes[static_cast<std::size_t>(record - level.records().data())];
    ++judgement.confusion[static_cast<std::size_t>(*part.truth[i])][static_cast<std::size_t>(found)];
  }
}

void print(const char* name, const Judgement& judgement) {
  constexpr auto kVehicle = static_cast<std::size_t>(SurfaceClass::kVehicle);
  const Confusion& confusion = judgement.confusion;
  std::array<double, kNumClasses> rows{}, columns{};
  double all = 0;
  for (std::size_t i = 0; i < kNumClasses; ++i) {
    for (std::size_t j = 0; j < kNumClasses; ++j) {
      const auto count = static_cast<double>(confusion[i][j]);
      rows[i] += count, columns[j] += count, all += count;
    }
  }
  std::printf("\n%s: %zu voxels in %.1f s\n%-11s", name, judgement.num_voxels, judgement.seconds, "IoU");
  double mean = 0;
  for (std::size_t i = 0; i < kNumClasses; ++i) {
    const auto hits_of_class = static_cast<double>(confusion[i][i]);
    const double iou = hits_of_class / (rows[i] + columns[i] - hits_of_class);
    mean += iou / kNumClasses;
    std::printf(" %10.3f", iou);
  }
  const auto hits = static_cast<double>(confusion[kVehicle][kVehicle]);
  std::printf("   mean %.3f\nvehicles: precision %.3f, recall %.3f, called so %.2f %% of all other points\n%-11s", mean,
              hits / columns[kVehicle], hits / rows[kVehicle],
              100 * (columns[kVehicle] - hits) / (all - rows[kVehicle]), "true");
  for (std::size_t i = 0; i < kNumClasses; ++i) std::printf(" %10s", name_of(static_cast<SurfaceClass>(i)).data());
  for (std::size_t i = 0; i < kNumClasses; ++i) {
    std::printf("\n%-11s", name_of(static_cast<SurfaceClass>(i)).data());
    for (std::size_t j = 0; j < kNumClasses; ++j) std::printf(" %10zu", confusion[i][j]);
  }
  std::printf("\n");
}

void judge_drive(const NetworkWeights& network, const std::filesystem::path& folder) {
  const std::vector<Scan> scans = read_scans(folder);
  Part together;
  for (const Scan& scan : scans) together.add(scan, 1);
  Judgement all;
  judge(together, network, all);
  print("all scans together", all);
  for (const int ring_step : {1, 4}) {
    Judgement single;
    for (const Scan& scan : scans) {
      Part part;
      part.add(scan, ring_step);
      judge(part, network, single);
    }
    print(ring_step == 1 ? "single scans" : "single scans, every fourth ring", single);
  }
}

void judge_file(const NetworkWeights& network, const std::filesystem::path& points, const std::filesystem::path& labels,
                Judgement& judgement) {
  ReadResult read = read_points(points);
  attach_labels(read, labels);
  Part part;
  part.cloud = std::move(read.cloud);
  for (const std::int32_t label : part.cloud.labels) part.truth.push_back(surface_class_of(label));
  judge(part, network, judgement);
}

struct StreetJudgement {
  Judgement surveys;
  Judgement scans;
};

void judge_street(const NetworkWeights& network, const std::filesystem::path& folder, StreetJudgement& judgement) {
  judge_file(network, folder / "epoch0" / "cloud.las", folder / "epoch0" / "labels" / "cloud.label", judgement.surveys);
  for (const std::filesystem::path& scan : list_point_files({folder / "epoch1" / "scans"})) {
    const auto label = scan.filename().replace_extension(".label");
    judge_file(network, scan, folder / "epoch1" / "labels" / "scans" / label, judgement.scans);
  }
}

int run(const std::filesystem::path& weights, const std::vector<std::filesystem::path>& folders) {
  const NetworkWeights network = *read_network(weights);
  StreetJudgement streets;
  for (const std::filesystem::path& folder : folders) {
    if (std::filesystem::exists(folder / "street.json")) {
      judge_street(network, folder, streets);
    } else {
      judge_drive(network, folder);
    }
  }
  if (streets.surveys.num_voxels > 0) {
    print("surveys", streets.surveys);
    print("VLP-16 scans", streets.scans);
  }
  return 0;
}

}  // namespace
}  // namespace vdbmap::parking

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: segmentation_accuracy WEIGHTS FOLDER...\n");
    return 2;
  }
  try {
    return vdbmap::parking::run(argv[1], {argv + 2, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

// SPDX-License-Identifier: GPL-3.0-or-later
// How like a real street simulated ones are: street_likeness [--ideal] lays the scans of a real HDL-64 with the classes
// of their points beside those of simulated streets, as Markdown tables: medians, and distances between distributions.
// Real scans: kitti00 in the folder of real data.
#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tests/benchmarks/likeness_distributions.h"
#include "tests/support/folders.h"
#include "tools/simulator/lidar.h"
#include "tools/simulator/street.h"
#include "vdbmap/core/eigen_features.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/core/voxel_record.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/points/point_reader.h"

namespace vdbmap::benchmarks {
namespace {

// SemanticKITTI's 19 classes as kitti00/labels numbers them.
Group group_of_kitti(std::uint8_t label) {
  if (label >= 9 && label <= 12) return kGround;
  if (label == 17) return kGround;
  if (label == 13) return kFacade;
  if (label == 14) return kFence;
  if (label == 15 || label == 16) return kVegetation;
  if (label == 1 || label == 4 || label == 5) return kVehicle;
  return label == 18 || label == 19 ? kPole : kOther;
}

Group group_of(simulator::SurfaceClass label) {
  using enum simulator::SurfaceClass;
  switch (label) {
    case kRoad:
    case kParking:
    case kPavement:
    case kTerrain:
      return kGround;
    case kBuilding:
      return kFacade;
    case kFence:
      return Group::kFence;
    case kVegetation:
    case kTrunk:
      return Group::kVegetation;
    case kCar:
    case kBus:
    case kTruck:
    case kOtherVehicle:
    case kMovingCar:
    case kMovingBus:
    case kMovingTruck:
    case kMovingOtherVehicle:
      return kVehicle;
    case kPole:
    case kTrafficSign:
      return Group::kPole;
    default:
      return kOther;
  }
}

std::vector<LabelledScan> real_scans(const std::filesystem::path& folder) {
  std::vector<LabelledScan> scans;
  for (const std::filesystem::path& file : list_point_files({folder / "velodyne"})) {
    LabelledScan scan{read_points(file).cloud, {}};
    ByteReader labels(folder / "labels" / file.filename().replace_extension(".u8"));
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
      labels.skip(1);  // the exact class; the second byte is the propagated one
      scan.groups.push_back(group_of_kitti(labels.read_le<std::uint8_t>()));
    }
    scans.push_back(std::move(scan));
  }
  return scans;
}

// As many scans of a street as of the drive, 0.1 s apart, from its middle on; a scanner with errors in a street that is
// not ideal.
std::vector<LabelledScan> simulated_scans(std::uint64_t seed, bool is_ideal, std::size_t count) {
  const simulator::Street street = simulator::make_street({.seed = seed, .num_epochs = 1, .is_ideal = is_ideal});
  const simulator::Mesh mesh = street.mesh(0);
  const simulator::RayCaster caster(mesh);
  const simulator::LidarModel lidar = is_ideal ? simulator::hdl64() : with_errors(simulator::hdl64(), seed);
  const simulator::Drive drive(street.layouts.front(), {.from = 70, .to = 110, .seed = seed});
  std::vector<LabelledScan> scans(count);
  parallel_for(count, [&](std::size_t i) {
    const simulator::Survey survey = scan_turn({mesh, street.world.materials(), caster}, drive, lidar,
                                               0.1 * static_cast<double>(i), simulator::hash(seed, i));
    scans[i].cloud = survey.cloud;
    for (const auto& truth : survey.truth) {
      scans[i].groups.push_back(group_of(static_cast<simulator::SurfaceClass>(truth.label)));
    }
  });
  return scans;
}

// One figure of a scan: a row of the table.
struct Row {
  std::string name;
  std::vector<double> values;  // a scan each
};

double quantile(std::vector<double> values, double share) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

std::vector<double> planarities(const VoxelLevel& level, std::uint32_t fewest_points) {
  std::vector<double> values;
  for (const VoxelRecord& record : level.records()) {
    if (record.count >= fewest_points) values.push_back(fit_plane(covariance_of(record)).planarity);
  }
  return values;
}

class Statistics {
 public:
  void add(const LabelledScan& scan) {
    next_ = 0;
    put("points a scan", static_cast<double>(scan.cloud.size()));
    add_shares(scan);
    add_ranges(scan.cloud);
    add_voxels(scan.cloud);
  }

  const std::vector<Row>& rows() const { return rows_; }

 private:
  void put(const std::string& name, double value) {
    if (next_ == rows_.size()) rows_.push_back({name, {}});
    rows_[next_++].values.push_back(value);
  }

  void add_shares(const LabelledScan& scan) {
    for (int group = 0; group < kNumGroups; ++group) {
      const auto count = std::ranges::count(scan.groups, static_cast<Group>(group));
      put(std::string("share of ") + name_of(static_cast<Group>(group)) + " [%]",
          100.0 * static_cast<double>(count) / static_cast<double>(scan.groups.size()));
    }
  }

  void add_ranges(const PointCloud& cloud) {
    std::vector<double> ranges;
    for (const Eigen::Vector3d& point : cloud.positions) ranges.push_back(point.norm());
    for (const int percent : {5, 25, 50, 75, 95, 99}) {
      put("range, " + std::to_string(percent) + " % quantile [m]", quantile(ranges, percent / 100.0));
    }
  }

  void add_voxels(const PointCloud& cloud) {
    const VoxelMap map = build_map(cloud);
    const auto& records = map.finest().records();
    const auto num_single = std::ranges::count_if(records, [](const VoxelRecord& r) { return r.count == 1; });
    const auto num_voxels = static_cast<double>(records.size());
    put("points a 10 cm voxel", static_cast<double>(cloud.size()) / num_voxels);
    put("10 cm voxels of one point [%]", 100.0 * static_cast<double>(num_single) / num_voxels);
    put("planarity of 10 cm voxels from 5 points on, median", quantile(planarities(map.finest(), 5), 0.5));
    for (const int percent : {25, 50, 75}) {
      put("planarity of 1 m voxels from 10 points on, " + std::to_string(percent) + " % quantile",
          quantile(planarities(map.coarsest(), 10), percent / 100.0));
    }
  }

  std::vector<Row> rows_;
  std::size_t next_ = 0;
};

std::vector<Row> statistics_of(const std::vector<LabelledScan>& scans) {
  Statistics statistics;
  for (const LabelledScan& scan : scans) statistics.add(scan);
  return statistics.rows();
}

void print_table(const std::vector<std::string>& names, const std::vector<std::vector<Row>>& columns) {
  std::string header = "| median over the scans |", rule = "|---|";
  for (const std::string& name : names) {
    header += " " + name + " |";
    rule += "---|";
  }
  std::printf("%s\n%s\n", header.c_str(), rule.c_str());
  for (std::size_t i = 0; i < columns.front().size(); ++i) {
    std::printf("| %s |", columns.front()[i].name.c_str());
    for (const std::vector<Row>& rows : columns) {
      const double value = quantile(rows[i].values, 0.5);
      std::printf(value >= 1000 ? " %.0f |" : value >= 1 ? " %.1f |" : " %.2f |", value);
    }
    std::printf("\n");
  }
}

double median_of(const Distribution& distribution) {
  return distribution.samples.empty() ? 0 : distribution.samples[distribution.samples.size() / 2];
}

// Medians of the real drive's and of all streets' samples; distances to the real drive: of each street, then the median
// over the streets, and that between two of them.
void print_distances(const std::vector<std::string>& names, const std::vector<Distributions>& places) {
  std::string header = "\n| distance between distributions | real median | simulated |", rule = "|---|---|---|";
  for (std::size_t i = 1; i < names.size(); ++i) {
    header += " " + names[i] + " |";
    rule += "---|";
  }
  std::printf("%s median | between seeds |\n%s---|---|\n", header.c_str(), rule.c_str());
  const std::span<const Distributions> streets = std::span(places).subspan(1);
  for (std::size_t figure = 0; figure < places.front().size(); ++figure) {
    std::vector<double> medians, to_real, between;
    for (const Distributions& place : places) medians.push_back(median_of(place[figure]));
    for (std::size_t i = 0; i < streets.size(); ++i) {
      to_real.push_back(distance(places.front()[figure], streets[i][figure]));
      for (std::size_t j = 0; j < i; ++j) between.push_back(distance(streets[i][figure], streets[j][figure]));
    }
    std::printf("| %s | %.4f | %.4f |", places.front()[figure].name.c_str(), medians.front(),
                quantile({medians.begin() + 1, medians.end()}, 0.5));
    for (const double value : to_real) std::printf(" %.3f |", value);
    std::printf(" %.3f | %.3f |\n", quantile(to_real, 0.5), quantile(between, 0.5));
  }
}

int run(bool is_ideal) {
  const auto data = test::real_data_folder();
  constexpr std::size_t kNumScans = 16;
  std::vector<std::string> names;
  std::vector<std::vector<Row>> columns;
  std::vector<Distributions> distributions;
  const auto add = [&](const std::string& name, const std::vector<LabelledScan>& scans) {
    names.push_back(name);
    columns.push_back(statistics_of(scans));
    distributions.push_back(distributions_of(scans));
  };
  const bool has_real = data && std::filesystem::is_directory(*data / "kitti00");
  if (has_real) add("KITTI 00", real_scans(*data / "kitti00"));
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    add("seed " + std::to_string(seed), simulated_scans(seed, is_ideal, kNumScans));
  }
  print_table(names, columns);
  if (has_real) print_distances(names, distributions);
  return 0;
}

}  // namespace
}  // namespace vdbmap::benchmarks

int main(int argc, char** argv) {
  const bool is_ideal = argc == 2 && std::string_view(argv[1]) == "--ideal";
  if (argc > 1 && !is_ideal) {
    std::fprintf(stderr, "usage: street_likeness [--ideal]\n");
    return 2;
  }
  try {
    return vdbmap::benchmarks::run(is_ideal);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

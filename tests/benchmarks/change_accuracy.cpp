// SPDX-License-Identifier: GPL-3.0-or-later
// How well the diff of two surveys of a simulated street tells what came and went:
//
//     change_accuracy STREET [--voxel S=0.2] [--later mapper|vlp16] [--poses FILE] [--align] [--pose-sigma S]
//     [--regions]
//
// STREET is a folder of `vdbmap simulate`, surveyed by its mapper in epoch 0 and by the mapper or the VLP-16 in epoch
// 1; scans lie at the poses of FILE (KITTI), without it at the true ones in the frame of the survey. Every voxel
// belongs to the object with most points in it. Objects are gone or new where changes.csv lists them for one epoch
// only; what moves during a survey, plants that grew and points that are no surface are left out.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "registration/fine/map_alignment.h"
#include "registration/posed_scans.h"
#include "vdbmap/change/change_regions.h"
#include "vdbmap/change/map_diff.h"
#include "vdbmap/change/map_visibility.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/pose_track.h"
#include "vdbmap/io/kitti/label_file.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap {
namespace {

const Eigen::Vector3d kMapperScanner(-1.95, 0, 2.35);  // [m] in its vehicle
constexpr std::uint16_t kFirstMoving = 252;            // SemanticKITTI's moving classes from here on
constexpr std::size_t kFewestVoxels = 20;              // of a vehicle that was seen
constexpr double kLargeRegion = 0.2;                   // [m^3]
constexpr auto kNoRecord = static_cast<std::size_t>(-1);

struct Options {
  std::filesystem::path street;
  double voxel_size = 0.2;
  std::string later = "mapper";
  std::filesystem::path poses;
  bool lists_regions = false;
  bool aligns = false;
  DiffOptions diff;
  RegionOptions regions;
};

bool is_vehicle(int label) { return label == 10 || label == 13 || label == 18 || label == 20; }
bool is_plant(int label) { return label == 70 || label == 71 || label == 72; }
bool is_ground_or_wall(int label) { return label == 40 || label == 44 || label == 48 || label == 49 || label == 50; }

// A class and the number of an object.
using Thing = std::pair<std::uint16_t, std::uint16_t>;

// Points of one epoch, each time in the same order.
struct Epoch {
  CloudSource clouds;
  std::vector<PointLabel> labels;
};

Epoch mapper_epoch(const Options& options, int number) {
  const std::filesystem::path folder = options.street / ("epoch" + std::to_string(number));
  Epoch epoch;
  epoch.labels = read_labels(folder / "labels/cloud.label");
  std::filesystem::path trajectory = folder / "mapper_estimated.tum";
  if (!std::filesystem::exists(trajectory)) trajectory = folder / "mapper.tum";
  epoch.clouds = [folder, trajectory](const std::function<void(const PosedCloud&)>& take) {
    const PointCloud cloud = read_points(folder / "cloud.las").cloud;
    const Trajectory poses = read_trajectory(trajectory);
    const PoseTrack track(poses.map_from_scan, poses.times);
    std::vector<Eigen::Vector3d> origins = cloud.positions;
    for (std::size_t i = 0; i < origins.size(); ++i) {
      if (const auto pose = track.at(cloud.times[i])) origins[i] = *pose * kMapperScanner;
    }
    take({cloud, Eigen::Isometry3d::Identity(), origins});
  };
  return epoch;
}

Epoch scanner_epoch(const Options& options, int number) {
  const std::filesystem::path folder = options.street / ("epoch" + std::to_string(number));
  std::filesystem::path file = options.poses.empty() ? folder / "poses_in_survey0.txt" : options.poses;
  if (!std::filesystem::exists(file)) file = folder / "poses.txt";
  const Trajectory poses = read_trajectory(file);
  std::vector<std::filesystem::path> scans = list_point_files({folder / "scans"});
  scans.resize(std::min(scans.size(), poses.size()));
  Epoch epoch;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (!poses.map_from_scan[i]) continue;
    const auto labels = read_labels(folder / "labels/scans" / scans[i].filename().replace_extension(".label"));
    epoch.labels.insert(epoch.labels.end(), labels.begin(), labels.end());
  }
  epoch.clouds = [scans, poses](const std::function<void(const PosedCloud&)>& take) {
    registration::PosedScans posed(take);
    for (std::size_t i = 0; i < scans.size(); ++i) {
      if (!poses.map_from_scan[i]) {
        posed.pass_over(1);
      } else {
        posed.add(read_points(scans[i]).cloud, *poses.map_from_scan[i]);
      }
    }
    posed.finish();
  };
  return epoch;
}

// The objects that changes.csv lists, by what became of them.
constexpr double kCell = 0.1;  // [m]

std::uint64_t cell_key(int object, const VoxelIndex& cell) {
  const auto part = [](std::int32_t i) { return static_cast<std::uint64_t>(i) & 0xfffff; };
  return (static_cast<std::uint64_t>(object) << 60 ^ static_cast<std::uint64_t>(object) * 0x9e3779b97f4a7c15) ^
         (part(cell.x()) << 40 | part(cell.y()) << 20 | part(cell.z()));
}

VoxelIndex cell_of(const Eigen::Vector3d& point) { return voxel_of_point(point, 1 / kCell); }

struct Truth {
  std::set<int> gone, came, grown;
  std::unordered_set<std::uint64_t> cells;  // of 10 cm, that the surface of an object passes in one epoch only

  // Whether a point of an object lies in a cell that changed, or beside one: surveys are some centimetres off.
  bool has_changed(int object, const Eigen::Vector3d& point) const {
    const VoxelIndex cell = cell_of(point);
    if (cells.contains(cell_key(object, cell))) return true;
    for (int axis = 0; axis < 3; ++axis) {
      for (const int step : {-1, 1}) {
        VoxelIndex beside = cell;
        beside[axis] += step;
        if (cells.contains(cell_key(object, beside))) return true;
      }
    }
    return false;
  }

  bool is_listed(int object) const { return gone.contains(object) || came.contains(object) || grown.contains(object); }
};

Truth read_truth(const std::filesystem::path& path) {
  Truth truth;
  std::set<int> vanished, appeared;
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path.string() + ": cannot open");
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::vector<std::string> fields;
    std::stringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    const int object = std::stoi(fields.at(7)), label = std::stoi(fields[6]);
    truth.cells.insert(cell_key(object, cell_of({std::stod(fields[2]), std::stod(fields[3]), std::stod(fields[4])})));
    if (is_plant(label)) {
      truth.grown.insert(object);
    } else {
      (fields[5] == "vanished" ? vanished : appeared).insert(object);
    }
  }
  for (const int object : vanished) (appeared.contains(object) ? truth.grown : truth.gone).insert(object);
  for (const int object : appeared) {
    if (!vanished.contains(object)) truth.came.insert(object);
  }
  return truth;
}

// A map, what its rays saw, and the thing in each of its voxels.
struct Survey {
  VoxelMap map;
  Visibility visibility;
  std::vector<Thing> things;
  std::vector<std::size_t> records;        // of each point
  std::vector<std::uint32_t> num_changed;  // a record: points in cells of their objects that changed

  Thing thing_of(const VoxelRecord& record) const {
    return things[static_cast<std::size_t>(&record - map.finest().records().data())];
  }

  // Whether the other epoch has another surface, or none, where this voxel's is.
  bool has_changed(std::size_t record) const { return 2 * num_changed[record] > map.finest().records()[record].count; }
};

std::vector<Thing> most_of(const std::vector<std::size_t>& records, const std::vector<PointLabel>& labels,
                           std::size_t num_records) {
  std::vector<std::pair<std::size_t, Thing>> votes;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (records[i] != kNoRecord) votes.push_back({records[i], {labels[i].label, labels[i].object}});
  }
  std::ranges::sort(votes);
  std::vector<Thing> things(num_records);
  for (std::size_t begin = 0; begin < votes.size();) {
    const std::size_t record = votes[begin].first;
    std::size_t most = 0;
    while (begin < votes.size() && votes[begin].first == record) {
      std::size_t end = begin;
      while (end < votes.size() && votes[end] == votes[begin]) ++end;
      if (end - begin > most) {
        most = end - begin;
        things[record] = votes[begin].second;
      }
      begin = end;
    }
  }
  return things;
}

Survey survey_of(const Epoch& epoch, const Truth& truth, double voxel_size) {
  BuildOptions build;
  build.voxel_sizes = {voxel_size};
  MapBuilder builder(build);
  epoch.clouds([&](const PosedCloud& posed) { builder.add(posed.cloud, posed.map_from_cloud); });
  Survey survey{builder.finish(), {}, {}, {}, {}};
  survey.visibility = find_visibility(survey.map, epoch.clouds);
  const VoxelLevel& level = survey.map.finest();
  const VoxelFinder finder(level);
  survey.num_changed.resize(level.size());
  epoch.clouds([&](const PosedCloud& posed) {
    for (const Eigen::Vector3d& point : posed.cloud.positions) {
      const Eigen::Vector3d local = posed.map_from_cloud * point - survey.map.frame.anchor;
      const VoxelRecord* record = finder.find(voxel_of_point(local, voxels_per_metre(voxel_size)));
      // Rounding puts a point on a border on either side of it.
      survey.records.push_back(record ? static_cast<std::size_t>(record - level.records().data()) : kNoRecord);
      const int object = epoch.labels.at(survey.records.size() - 1).object;
      if (record && truth.is_listed(object) && truth.has_changed(object, posed.map_from_cloud * point)) {
        ++survey.num_changed[survey.records.back()];
      }
    }
  });
  const auto num_lost = std::ranges::count(survey.records, kNoRecord);
  if (static_cast<std::size_t>(num_lost) > survey.records.size() / 1000)
    throw std::runtime_error("points lie in no voxel");
  if (survey.records.size() != epoch.labels.size()) throw std::runtime_error("labels are not those of the points");
  survey.things = most_of(survey.records, epoch.labels, level.size());
  return survey;
}

struct Rate {
  std::uint64_t count = 0, all = 0;

  void add(bool counts, std::uint64_t weight = 1) {
    all += weight;
    count += counts ? weight : 0;
  }
  double percent() const { return all == 0 ? 100.0 : 100.0 * static_cast<double>(count) / static_cast<double>(all); }
};

struct Rates {
  Rate kept, rejected, rejected_of_all, kept_points, rejected_points;  // static and dynamic
  Rate false_solid;                                                    // ground and walls called anything
  Rate false_unseen;                                                   // of what the other survey never saw
  std::map<int, Rate> kept_by_label;
  std::map<int, std::array<std::uint64_t, 5>> missed_by_label;  // dynamic and seen: by what the diff says of them
};

// What the diff says of each voxel of a survey.
std::vector<Change> changes_of(const Survey& survey, const MapDiff& diff, Change one_sided, const VoxelIndex& shift) {
  const VoxelFinder one((one_sided == Change::kAppeared ? diff.appeared : diff.vanished).level);
  const VoxelFinder changed(diff.changed.level);
  std::vector<Change> changes(survey.map.finest().size(), Change::kUnchanged);
  for_each_voxel(survey.map.finest(), [&](const VoxelIndex& voxel, std::size_t record) {
    const VoxelIndex place = voxel + shift;
    const VoxelLeaf* leaf = diff.unobserved.find_leaf(place);
    if (one.find(place))
      changes[record] = one_sided;
    else if (changed.find(place))
      changes[record] = Change::kChanged;
    else if (leaf && leaf->getValueMask().isOn(VoxelLeaf::coordToOffset(place)))
      changes[record] = Change::kUnobserved;
  });
  return changes;
}

bool is_change(Change change) {
  return change == Change::kAppeared || change == Change::kVanished || change == Change::kChanged;
}

void judge(const Survey& survey, const Survey& other, const std::vector<Change>& changes, const Truth& truth,
           const std::set<int>& dynamic, const VoxelIndex& other_from_this, Rates& rates) {
  const SightFinder sight(other.map.finest(), other.visibility);
  const VoxelFinder finder(other.map.finest());
  for_each_voxel(survey.map.finest(), [&](const VoxelIndex& voxel, std::size_t record) {
    const auto [label, object] = survey.things[record];
    const bool is_called = is_change(changes[record]);
    const bool is_seen = sight.find(voxel + other_from_this) != Sight::kNeverSeen;
    if (!is_seen) rates.false_unseen.add(is_called && changes[record] != Change::kChanged);
    if (label >= kFirstMoving || label == 1) return;
    const std::uint64_t points = survey.map.finest().records()[record].count;
    if (dynamic.contains(object)) {
      const VoxelRecord* counterpart = finder.find(voxel + other_from_this);
      const bool is_replaced = counterpart && truth.is_listed(other.thing_of(*counterpart).second);
      if (is_replaced || !survey.has_changed(record)) return;
      rates.rejected_of_all.add(is_called);
      if (!is_seen) return;
      ++rates.missed_by_label[label][static_cast<std::size_t>(changes[record])];
      rates.rejected.add(is_called);
      rates.rejected_points.add(is_called, points);
    } else if (!truth.is_listed(object)) {
      rates.kept.add(!is_called);
      rates.kept_points.add(!is_called, points);
      rates.kept_by_label[label].add(!is_called);
      if (is_ground_or_wall(label)) rates.false_solid.add(is_called);
    }
  });
}

// Of vehicles that left or came and whose place the other survey saw: whether each is one region.
struct RegionRates {
  Rate vehicles;     // that are one region
  Rate false_large;  // of regions
};

void judge_regions(const Survey& survey, const Survey& other, const MapDiff& diff, const ChangedVoxels& voxels,
                   Change kind, const Truth& truth, const std::set<int>& dynamic, const VoxelIndex& this_from_diff,
                   const VoxelIndex& other_from_this, const Options& options, RegionRates& rates) {
  const VoxelFinder finder(survey.map.finest());
  const SightFinder sight(other.map.finest(), other.visibility);
  const double size = options.voxel_size;
  std::vector<Thing> things;
  for_each_voxel(voxels.level, [&](const VoxelIndex& voxel, std::size_t) {
    const VoxelRecord* record = finder.find(voxel + this_from_diff);
    things.push_back(record ? survey.things[static_cast<std::size_t>(record - survey.map.finest().records().data())]
                            : Thing{});
  });
  std::map<int, std::size_t> seen_of;  // voxels of each vehicle that the other survey saw
  for_each_voxel(survey.map.finest(), [&](const VoxelIndex& voxel, std::size_t record) {
    const auto [label, object] = survey.things[record];
    if (!is_vehicle(label) || !dynamic.contains(object) || !survey.has_changed(record)) return;
    if (sight.find(voxel + other_from_this) != Sight::kNeverSeen) ++seen_of[object];
  });
  std::map<int, std::set<std::size_t>> regions_of;
  for (const ChangeRegion& region : find_regions(diff, options.regions)) {
    if (region.kind != kind) continue;
    std::map<int, std::size_t> counts;
    std::map<int, std::size_t> labels;
    std::size_t num_true = 0, num_all = 0;
    const PlanRectangle& plan = region.plan;
    const Eigen::Vector2d along(std::cos(plan.yaw), std::sin(plan.yaw)), across(-along.y(), along.x());
    std::size_t i = 0;
    for_each_voxel(voxels.level, [&](const VoxelIndex& voxel, std::size_t record) {
      const Thing thing = things[i++];
      const Eigen::Vector3d mean = mean_of(voxels.level.records()[record], voxel, size) + diff.frame.anchor;
      const Eigen::Vector2d from = mean.head<2>() - plan.center;
      constexpr double kTolerance = 1e-6;
      if (std::abs(from.dot(along)) > plan.length / 2 + kTolerance ||
          std::abs(from.dot(across)) > plan.width / 2 + kTolerance || mean.z() < region.bottom - kTolerance ||
          mean.z() > region.top + kTolerance) {
        return;
      }
      ++num_all;
      ++labels[thing.first];
      const bool is_real =
          dynamic.contains(thing.second) || truth.grown.contains(thing.second) || thing.first >= kFirstMoving;
      num_true += is_real ? 1 : 0;
      if (dynamic.contains(thing.second)) ++counts[thing.second];
    });
    const bool is_false = 2 * num_true < num_all;
    if (region.volume > kLargeRegion) rates.false_large.add(is_false);
    for (const auto& [object, count] : counts) {
      if (4 * count >= region.num_voxels) regions_of[object].insert(region.id);
    }
    if (options.lists_regions && region.volume > 0.05) {
      std::printf("    region %zu %s %.2f m3, %zu voxels, %.0f %% true, size %.1f %.1f %.1f at %.1f %.1f %.1f:",
                  region.id, name_of(region.kind), region.volume, region.num_voxels,
                  100.0 * static_cast<double>(num_true) / static_cast<double>(num_all), region.size().x(),
                  region.size().y(), region.size().z(), region.center().x(), region.center().y(), region.center().z());
      for (const auto& [label, count] : labels) std::printf(" %d:%zu", label, count);
      std::printf("\n");
    }
  }
  for (const auto& [object, count] : seen_of) {
    if (count < kFewestVoxels) continue;
    rates.vehicles.add(regions_of[object].size() == 1);
    if (options.lists_regions && regions_of[object].size() != 1) {
      std::printf("    vehicle %d, %zu voxels seen: %zu regions\n", object, count, regions_of[object].size());
    }
  }
}

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const auto value = [&]() -> std::string {
      if (i + 1 >= argc) throw std::invalid_argument(argument + " needs a value");
      return argv[++i];
    };
    if (argument == "--voxel")
      options.voxel_size = std::stod(value());
    else if (argument == "--later")
      options.later = value();
    else if (argument == "--poses")
      options.poses = value();
    else if (argument == "--pose-sigma")
      options.diff.pose_sigma = std::stod(value());
    else if (argument == "--reach")
      options.regions.reach = std::stod(value());
    else if (argument == "--align")
      options.aligns = true;
    else if (argument == "--regions")
      options.lists_regions = true;
    else
      options.street = argument;
  }
  if (options.street.empty()) {
    throw std::invalid_argument("usage: change_accuracy STREET [--voxel S] [--later mapper|vlp16] [--poses FILE]");
  }
  return options;
}

VoxelIndex shift_between(const VoxelMap& from, const VoxelMap& to) {
  const Eigen::Vector3d shift = (from.frame.anchor - to.frame.anchor) / from.finest().voxel_size();
  return voxel_of_point(shift.array().round() + 0.5, 1);
}

int run(const Options& options) {
  const Truth truth = read_truth(options.street / "changes.csv");
  const Survey earlier = survey_of(mapper_epoch(options, 0), truth, options.voxel_size);
  const Survey later = survey_of(options.later == "mapper" ? mapper_epoch(options, 1) : scanner_epoch(options, 1),
                                 truth, options.voxel_size);
  DiffOptions diff_options = options.diff;
  if (options.aligns) {
    const registration::MapAlignment alignment = registration::align_maps(earlier.map, later.map);
    diff_options.earlier_from_later = alignment.earlier_from_later;
    std::printf("aligned by %.1f %.1f %.1f mm, %.4f degrees\n", 1e3 * alignment.shift.x(), 1e3 * alignment.shift.y(),
                1e3 * alignment.shift.z(), alignment.turn_deg);
  }
  const MapDiff diff = map_diff({earlier.map, &earlier.visibility}, {later.map, &later.visibility}, diff_options);
  const VoxelIndex later_from_earlier = shift_between(earlier.map, later.map);

  Rates rates;
  judge(earlier, later, changes_of(earlier, diff, Change::kVanished, later_from_earlier), truth, truth.gone,
        later_from_earlier, rates);
  judge(later, earlier, changes_of(later, diff, Change::kAppeared, VoxelIndex(0)), truth, truth.came,
        -later_from_earlier, rates);
  RegionRates regions;
  judge_regions(earlier, later, diff, diff.vanished, Change::kVanished, truth, truth.gone, -later_from_earlier,
                later_from_earlier, options, regions);
  judge_regions(later, earlier, diff, diff.appeared, Change::kAppeared, truth, truth.came, VoxelIndex(0),
                -later_from_earlier, options, regions);

  const ChangeCounts& counts = diff.counts;
  std::printf(
      "%s, %s, %.2f m: %zu and %zu voxels; appeared %zu vanished %zu changed %zu unchanged %zu unobserved %zu\n",
      options.street.filename().c_str(), options.later.c_str(), options.voxel_size, earlier.map.finest().size(),
      later.map.finest().size(), counts.appeared, counts.vanished, counts.changed, counts.unchanged, counts.unobserved);
  std::printf("  preserved %.3f %%, rejected %.2f %% (of all, seen or not, %.2f %% of %zu), SA %.3f DA %.2f\n",
              rates.kept.percent(), rates.rejected.percent(), rates.rejected_of_all.percent(),
              rates.rejected_of_all.all, rates.kept_points.percent(), rates.rejected_points.percent());
  std::printf("  never seen but called %.4f %%, ground and walls called %.4f %% (%zu of %zu)\n",
              rates.false_unseen.percent(), rates.false_solid.percent(), rates.false_solid.count,
              rates.false_solid.all);
  std::printf("  vehicles that are one region %zu of %zu, false regions above 0.2 m3 %zu of %zu\n",
              regions.vehicles.count, regions.vehicles.all, regions.false_large.count, regions.false_large.all);
  std::printf("  called of static, by class:");
  for (const auto& [label, rate] : rates.kept_by_label) {
    std::printf(" %d: %zu of %zu;", label, rate.all - rate.count, rate.all);
  }
  std::printf("\n  dynamic, by class (unchanged, appeared, vanished, changed, unobserved):");
  for (const auto& [label, counts_of] : rates.missed_by_label) {
    std::printf(" %d:", label);
    for (const std::uint64_t count : counts_of) std::printf(" %zu", count);
    std::printf(";");
  }
  std::printf("\n");
  return 0;
}

}  // namespace
}  // namespace vdbmap

int main(int argc, char** argv) {
  try {
    return vdbmap::run(vdbmap::parse(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

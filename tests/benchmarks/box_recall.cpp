// SPDX-License-Identifier: GPL-3.0-or-later
// Which labelled vehicles of real scans are found: box_recall WEIGHTS FOLDER..., each with velodyne/*.bin and boxes.csv
// of boxes in the frame of each scan that were labelled in the view of a camera (kitti_object, kitti_drive5 of the real
// data). Every scan by itself: segmented, its vehicles boxed. A labelled car, van or truck with 100 points or more is
// found where a box overlaps its own in plan by half of their union or more. A box in the camera's view that touches no
// labelled one of any class is confirmed by none.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "parking/objects/vehicles.h"
#include "parking/segmentation/segment.h"
#include "vdbmap/core/error.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/io/points/point_reader.h"

namespace vdbmap::parking {
namespace {

constexpr double kFound = 0.5;                             // overlap in plan
constexpr double kTouching = 0.01;                         // the same of boxes that have to do with each other
constexpr double kHalfView = 40 * std::numbers::pi / 180;  // [rad] of KITTI's cameras: 81 degrees
constexpr double kNearest = 4;                             // [m] nearer than that the camera sees no whole car
constexpr double kFarthest = 50;                           // [m] beyond hardly anything is labelled
constexpr int kFewestPoints = 100;
constexpr std::array<const char*, 3> kClasses = {"Car", "Van", "Truck"};

struct LabelledBox {
  std::string kind;
  UprightBox box;
  int num_points = 0;
};

// The values of a row by the names of the columns: kitti_drive5 has one more, the track.
class Table {
 public:
  explicit Table(const std::filesystem::path& path) : path_(path), file_(path) {
    if (!file_) throw IoError::system(path, "cannot open", errno);
    std::string line;
    std::getline(file_, line);
    names_ = fields_of(line);
  }

  bool next() {
    std::string line;
    if (!std::getline(file_, line)) return false;
    values_ = fields_of(line);
    if (values_.size() != names_.size()) throw IoError::malformed(path_, "has a row of another length: " + line);
    return true;
  }

  const std::string& text(const char* name) const {
    const auto found = std::ranges::find(names_, name);
    if (found == names_.end()) throw IoError::malformed(path_, std::string("has no column ") + name);
    return values_[static_cast<std::size_t>(found - names_.begin())];
  }
  double number(const char* name) const { return std::stod(text(name)); }

 private:
  static std::vector<std::string> fields_of(const std::string& line) {
    std::vector<std::string> fields;
    std::stringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) {
      fields.push_back(field.ends_with('\r') ? field.substr(0, field.size() - 1) : field);
    }
    return fields;
  }

  std::filesystem::path path_;
  std::ifstream file_;
  std::vector<std::string> names_, values_;
};

// By frame.
std::map<int, std::vector<LabelledBox>> read_labels(const std::filesystem::path& path) {
  std::map<int, std::vector<LabelledBox>> labels;
  for (Table table(path); table.next();) {
    LabelledBox label;
    label.kind = table.text("class");
    label.box.center = {table.number("cx"), table.number("cy"), table.number("cz")};
    label.box.length = table.number("length");
    label.box.width = table.number("width");
    label.box.height = table.number("height");
    label.box.heading = table.number("yaw");
    label.num_points = static_cast<int>(table.number("points_inside"));
    labels[static_cast<int>(table.number("frame"))].push_back(label);
  }
  return labels;
}

// Vehicles [m, scan's frame], those of no plausible size left out.
std::vector<UprightBox> find_boxes(const std::filesystem::path& scan, const NetworkWeights& network) {
  BuildOptions options;
  options.voxel_sizes = {0.1};
  VoxelMap map = build_map(read_points(scan).cloud, options);
  label_map(map, network);
  std::vector<UprightBox> boxes;
  for (const Vehicle& vehicle : find_vehicles(map.finest())) {
    if (!vehicle.doubt.empty()) continue;
    boxes.push_back(vehicle.box);
    boxes.back().center += map.frame.anchor;
  }
  return boxes;
}

bool is_in_view(const UprightBox& box) {
  const double range = box.center.head<2>().norm();
  return std::abs(std::atan2(box.center.y(), box.center.x())) < kHalfView && range > kNearest && range < kFarthest;
}

struct Count {
  int labelled = 0, found = 0;
  double error = 0;  // [m] of the centres of those found, sum
};

struct Result {
  std::map<std::string, Count> of_class;
  int num_scans = 0, in_view = 0, unconfirmed = 0;
};

void judge_scan(const std::vector<UprightBox>& boxes, const std::vector<LabelledBox>& labels, Result& result) {
  for (const LabelledBox& label : labels) {
    if (label.num_points < kFewestPoints || std::ranges::find(kClasses, label.kind) == kClasses.end()) continue;
    Count& count = result.of_class[label.kind];
    ++count.labelled;
    const auto overlap = [&](const UprightBox& box) { return overlap_in_plan(box, label.box); };
    const auto best = std::ranges::max_element(boxes, {}, overlap);
    if (best == boxes.end() || overlap(*best) < kFound) {
      std::printf("  missed: %s of %d points at (%.1f, %.1f), best overlap %.2f\n", label.kind.c_str(),
                  label.num_points, label.box.center.x(), label.box.center.y(),
                  best == boxes.end() ? 0 : overlap(*best));
      continue;
    }
    ++count.found;
    count.error += (best->center - label.box.center).head<2>().norm();
  }
  for (const UprightBox& box : boxes) {
    if (!is_in_view(box)) continue;
    ++result.in_view;
    const bool is_confirmed = std::ranges::any_of(
        labels, [&](const LabelledBox& label) { return overlap_in_plan(box, label.box) > kTouching; });
    if (is_confirmed) continue;
    ++result.unconfirmed;
    std::printf("  no label: %.1f x %.1f x %.1f m at (%.1f, %.1f)\n", box.length, box.width, box.height, box.center.x(),
                box.center.y());
  }
}

void judge_folder(const std::filesystem::path& folder, const NetworkWeights& network) {
  const auto labels = read_labels(folder / "boxes.csv");
  Result result;
  for (const std::filesystem::path& scan : list_point_files({folder / "velodyne"})) {
    const int frame = std::stoi(scan.stem().string());
    std::printf("%s\n", scan.c_str());
    const auto of_frame = labels.find(frame);
    judge_scan(find_boxes(scan, network), of_frame == labels.end() ? std::vector<LabelledBox>{} : of_frame->second,
               result);
    ++result.num_scans;
  }
  std::printf("\n%s, %d scans\n", folder.c_str(), result.num_scans);
  for (const auto& [kind, count] : result.of_class) {
    std::printf("%s: %d of %d with %d points or more found (%.1f %%), centre %.2f m off on average\n", kind.c_str(),
                count.found, count.labelled, kFewestPoints, 100.0 * count.found / count.labelled,
                count.found > 0 ? count.error / count.found : 0.0);
  }
  std::printf("%d boxes in the camera's view, from %.0f to %.0f m; no label confirms %d of them\n\n", result.in_view,
              kNearest, kFarthest, result.unconfirmed);
}

}  // namespace
}  // namespace vdbmap::parking

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: box_recall WEIGHTS FOLDER...\n");
    return 2;
  }
  try {
    const auto network = vdbmap::parking::read_network(argv[1]);
    for (int i = 2; i < argc; ++i) vdbmap::parking::judge_folder(argv[i], *network);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Other programs open our files: Debian's Blender and OpenVDB's Python module.
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tests/support/folders.h"
#include "tests/support/picture.h"
#include "tests/support/run_command.h"
#include "tests/support/sample_maps.h"
#include "vdbmap/change/map_diff.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/io/vdb/channel_codes.h"
#include "vdbmap/io/vdb/diff_file.h"
#include "vdbmap/io/vdb/map_channels.h"
#include "vdbmap/io/vdb/map_file.h"

namespace vdbmap {
namespace {

using nlohmann::json;

constexpr const char* kPython = "/usr/bin/python3";  // Debian's, which knows Debian's modules
const std::string kScripts = VDBMAP_SOURCE_DIR "/tests/exchange/";

std::optional<std::string> find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (::access((folder + "/" + name).c_str(), X_OK) == 0) return folder + "/" + name;
  }
  return std::nullopt;
}

class Exchange : public testing::Test {
 protected:
  // Runs a program that writes a report.
  json report(const std::string& program, std::vector<std::string> arguments) const {
    const test::CommandResult result = test::run_command(program, arguments, {.timeout = std::chrono::seconds(300)});
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    std::ifstream stream(report_file());
    return stream ? json::parse(stream) : json();
  }
  std::string report_file() const { return folder_ / "report.json"; }

  test::TemporaryFolder folder_;
};

// Voxels far enough from each other to stand alone, also at 1 m, on both sides of every axis.
struct KnownVoxel {
  Eigen::Vector3d point;  // [m, local frame]
  VoxelIndex voxel;       // of 10 cm
  Rgb16 color;
};

const std::vector<KnownVoxel> kKnownVoxels = {
    {{0.03, 0.02, 0.07}, {0, 0, 0}, {65535, 65535, 65535}},
    {{-5.01, 0.09, 3.33}, {-51, 0, 33}, {65535, 30000, 20000}},
    {{8.88, -7.77, -2.22}, {88, -78, -23}, {20000, 50000, 65535}},
    {{-10.06, -12.34, 0.55}, {-101, -124, 5}, {40000, 10000, 10000}},
    {{14.951, 13.049, -6.0001}, {149, 130, -61}, {30000, 65535, 30000}},
};

const Eigen::Vector3d kAnchor(550016, 5804992, 64);

VoxelMap known_map() {
  PointCloud cloud;
  for (const KnownVoxel& known : kKnownVoxels) {
    cloud.positions.emplace_back(kAnchor + known.point);
    cloud.colors.push_back(known.color);
  }
  BuildOptions options;
  options.anchor = kAnchor;
  options.epsg = 25832;
  return build_map(cloud, options);
}

// --- Blender

class Blender : public Exchange {
 protected:
  static void SetUpTestSuite() { program_ = find_program("blender"); }
  void SetUp() override {
    if (!program_) GTEST_SKIP() << "Blender is not installed";
  }

  json report_of(const VoxelMap& map) const {
    save_map(folder_ / "map.vdb", map);
    std::vector<std::string> arguments = {
        "-b", "--factory-startup", "--python-exit-code", "1", "-P", kScripts + "blender_test.py",
        "--", folder_ / "map.vdb", report_file()};
    for (const KnownVoxel& known : kKnownVoxels) {
      const Eigen::Vector3d center = center_of_voxel(known.voxel, 0.1);
      std::ostringstream text;
      text << center.x() << "," << center.y() << "," << center.z();
      arguments.push_back(text.str());
    }
    return report(*program_, arguments);
  }

  static std::optional<std::string> program_;
};

std::optional<std::string> Blender::program_;

// OpenVDB and Houdini have the value of index i at i, and so has Blender from pull request 138449 on. Before, it draws
// every volume half a voxel farther on each axis, whoever wrote it: [voxels]
double shift_of_blender(const json& report) { return report["version"] < json({4, 5, 0}) ? 0.5 : 0.0; }

// Where the grid's matrix puts an index.
Eigen::Vector3d place(const json& grid, const VoxelIndex& voxel) {
  Eigen::Vector3d point;
  for (int row = 0; row < 3; ++row) {
    const json& m = grid["matrix"][static_cast<std::size_t>(row)];
    point[row] = m[0].get<double>() * voxel.x() + m[1].get<double>() * voxel.y() + m[2].get<double>() * voxel.z() +
                 m[3].get<double>();
  }
  return point;
}

// Mean of the vertices within a voxel's edge of a place, and how many there are.
std::pair<Eigen::Vector3d, int> center_of_vertices(const json& vertices, const Eigen::Vector3d& near, double edge) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const json& vertex : vertices) {
    const Eigen::Vector3d point(vertex[0].get<double>(), vertex[1].get<double>(), vertex[2].get<double>());
    if ((point - near).cwiseAbs().maxCoeff() > edge) continue;
    sum += point;
    ++count;
  }
  return {sum / count, count};
}

void expect_places(const json& report, const json& grid, double voxel_size) {
  const json& vertices = report["vertices"][grid["name"].get<std::string>()];
  int num_vertices = 0;
  for (const KnownVoxel& known : kKnownVoxels) {
    const VoxelIndex voxel = voxel_of_point(known.point, 1 / voxel_size);
    const Eigen::Vector3d expected = center_of_voxel(voxel, voxel_size);
    // Single precision keeps micrometres up to some 15 m.
    EXPECT_LT((place(grid, voxel) - expected).norm(), 5e-6);
    const Eigen::Vector3d drawn = expected + Eigen::Vector3d::Constant(shift_of_blender(report) * voxel_size);
    const auto [center, count] = center_of_vertices(vertices, drawn, voxel_size);
    EXPECT_EQ(count, 8);
    EXPECT_LT((center - drawn).norm(), 5e-6) << center.transpose();
    num_vertices += count;
  }
  EXPECT_EQ(vertices.size(), static_cast<std::size_t>(num_vertices)) << "no other voxels";
}

TEST_F(Blender, SeesNamesTypesPlacesAndColors) {
  const json report = report_of(known_map());
  ASSERT_TRUE(report.contains("grids"));
  EXPECT_EQ(report["error"], "");
  std::map<std::string, std::string> types;
  for (const json& grid : report["grids"]) types[grid["name"]] = grid["type"];
  EXPECT_EQ(types, (std::map<std::string, std::string>{{"density", "FLOAT"},
                                                       {"density_1m", "FLOAT"},
                                                       {"color", "VECTOR_FLOAT"},
                                                       {"color_1m", "VECTOR_FLOAT"},
                                                       {"voxels", "POINTS"},
                                                       {"voxels_1m", "POINTS"}}));

  for (const json& grid : report["grids"]) {
    if (grid["name"] == "density") expect_places(report, grid, 0.1);
    if (grid["name"] == "density_1m") expect_places(report, grid, 1.0);
  }

  const VoxelMap map = known_map();
  VoxelFinder finder(map.finest());
  ASSERT_EQ(report["light"].size(), kKnownVoxels.size());
  for (std::size_t i = 0; i < kKnownVoxels.size(); ++i) {
    const json& light = report["light"][i];
    const Eigen::Vector3d seen(light[0].get<double>(), light[1].get<double>(), light[2].get<double>());
    const Eigen::Vector3d color = color_of(*finder.find(kKnownVoxels[i].voxel));
    ASSERT_GT(seen.sum(), 0.01) << "voxel " << i << " is dark";
    // Rays are random.
    EXPECT_LT((seen / seen.sum() - color / color.sum()).norm(), 0.005) << seen.transpose();
  }
}

// A slab of ground, on it a block that appeared and one that vanished.
TEST_F(Blender, DrawsAMapAndWhatChangedWithTheScriptForIt) {
  const auto slab = [](const VoxelIndex& low, const VoxelIndex& high) {
    std::vector<VoxelIndex> voxels;
    for (const auto& voxel : openvdb::CoordBBox(low, high)) voxels.push_back(voxel);
    return voxels;
  };
  std::vector<VoxelIndex> later = slab({0, 0, 0}, {39, 19, 0}), earlier = later;
  for (const VoxelIndex& voxel : slab({5, 6, 1}, {12, 13, 6})) later.push_back(voxel);
  for (const VoxelIndex& voxel : slab({25, 6, 1}, {32, 13, 6})) earlier.push_back(voxel);
  const VoxelMap map = test::map_of_voxels(later);
  DiffOptions options;
  options.takes_unseen_as_empty = true;
  save_map(folder_ / "map.vdb", map);
  save_diff(folder_ / "diff.vdb", map_diff({test::map_of_voxels(earlier)}, {map}, options));

  const test::CommandResult result = test::run_command(
      *program_,
      {"-b", "--factory-startup", "--python-exit-code", "1", "-P", VDBMAP_SOURCE_DIR "/tools/blender/open_map.py", "--",
       folder_ / "map.vdb", "--diff", folder_ / "diff.vdb", "--render", folder_ / "picture.png", "--size", "160x90",
       "--samples", "4"},
      {.timeout = std::chrono::seconds(300)});
  ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
  const Image picture = test::read_picture(folder_ / "picture.png");
  ASSERT_EQ(picture.width(), 160);
  int num_green = 0, num_red = 0, num_pale = 0;
  for (const Rgb8& pixel : picture.pixels()) {
    num_green += pixel.g > pixel.r + 50 && pixel.g > pixel.b ? 1 : 0;
    num_red += pixel.r > pixel.g + 50 && pixel.r > pixel.b + 50 ? 1 : 0;
    num_pale += std::abs(pixel.r - pixel.g) < 25 && std::abs(pixel.g - pixel.b) < 25 ? 1 : 0;
  }
  EXPECT_GT(num_green, 150);
  EXPECT_GT(num_red, 150);
  EXPECT_GT(num_pale, 1000);
}

// --- OpenVDB's Python module

class PythonOpenvdb : public Exchange {
 protected:
  void SetUp() override {
    const bool is_there =
        ::access(kPython, X_OK) == 0 && test::run_command(kPython, {"-c", "import pyopenvdb"}).exit_code == 0;
    if (!is_there) GTEST_SKIP() << "python3-openvdb is not installed";
  }

  // By name; all grids without names.
  std::map<std::string, json> read(const std::string& file, const std::vector<std::string>& names = {}) const {
    std::vector<std::string> arguments = {kScripts + "openvdb_test.py", file, report_file()};
    arguments.insert(arguments.end(), names.begin(), names.end());
    std::map<std::string, json> grids;
    for (const json& grid : report(kPython, arguments)) grids[grid["name"]] = grid;
    return grids;
  }
};

void expect_frame(const json& grid, const VoxelMap& map, double voxel_size) {
  EXPECT_EQ(grid["metadata"]["anchor_x"], map.frame.anchor.x());
  EXPECT_EQ(grid["metadata"]["anchor_y"], map.frame.anchor.y());
  EXPECT_EQ(grid["metadata"]["anchor_z"], map.frame.anchor.z());
  EXPECT_EQ(grid["metadata"]["epsg"], 25832);
  EXPECT_EQ(grid["metadata"]["voxel_size"], voxel_size);
  EXPECT_EQ(grid["origin"], json({voxel_size / 2, voxel_size / 2, voxel_size / 2}));
  EXPECT_EQ(grid["background"], grid["type"] == "float" ? json(0.0) : json({0.0, 0.0, 0.0}));
}

// Compares the values of all voxels with value_of(record number).
template <typename ValueOf>
void expect_values(const json& grid, const VoxelMap& map, const VoxelLevel& level, const ValueOf& value_of) {
  expect_frame(grid, map, level.voxel_size());
  std::map<VoxelIndex, json> values;
  for (const json& voxel : grid["voxels"]) values[VoxelIndex(voxel[0][0], voxel[0][1], voxel[0][2])] = voxel[1];
  EXPECT_EQ(values.size(), level.size()) << grid["name"];
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    const json& found = values[voxel];
    const std::vector<float> expected = value_of(number);
    ASSERT_EQ(found.is_array() ? found.size() : 1, expected.size()) << grid["name"];
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const double value = found.is_array() ? found[i] : found;
      ASSERT_EQ(value, expected[i]) << grid["name"] << " " << voxel;
    }
  });
}

std::vector<float> values(const openvdb::Vec3f& vector) { return {vector.x(), vector.y(), vector.z()}; }

TEST_F(PythonOpenvdb, ReadsDensityAndColorBesideThePoints) {
  const VoxelMap map = test::sample_map();
  save_map(folder_ / "map.vdb", map);
  auto grids = read(folder_ / "map.vdb", {"density", "density_1m", "color", "color_1m"});
  ASSERT_EQ(grids.size(), 4u);
  for (const VoxelLevel& level : map.levels) {
    const std::string suffix = &level == &map.finest() ? "" : "_1m";
    EXPECT_EQ(grids["density" + suffix]["class"], "fog volume");
    expect_values(grids["density" + suffix], map, level,
                  [](std::size_t) { return std::vector<float>{SaveOptions().density}; });
    expect_values(grids["color" + suffix], map, level,
                  [&](std::size_t i) { return values(color_value_of(level.records()[i])); });
  }
}

TEST_F(PythonOpenvdb, ReadsEveryChannelExactly) {
  const VoxelMap map = test::sample_map();
  export_channels(folder_ / "channels.vdb", map, {.integers_as_float = true});
  auto grids = read(folder_ / "channels.vdb");
  ASSERT_EQ(grids.size(), 24u);
  for (const VoxelLevel& level : map.levels) {
    const std::string suffix = &level == &map.finest() ? "" : "_1m";
    const auto expect = [&](const std::string& name, const auto& value_of) {
      expect_values(grids[name + suffix], map, level, value_of);
    };
    const auto record = [&](std::size_t i) -> const VoxelRecord& { return level.records()[i]; };
    const auto& channels = level.channels();
    const auto number = [](auto value) { return std::vector<float>{static_cast<float>(value)}; };
    expect("count", [&](std::size_t i) { return number(record(i).count); });
    expect("mean", [&](std::size_t i) { return values(mean_offset_of(record(i), level.voxel_size())); });
    expect("cov_diag", [&](std::size_t i) { return values(openvdb::Vec3f(record(i).covariance.data())); });
    expect("cov_offdiag", [&](std::size_t i) { return values(openvdb::Vec3f(record(i).covariance.data() + 3)); });
    expect("normal", [&](std::size_t i) { return values(normal_value_of(record(i))); });
    expect("color", [&](std::size_t i) { return values(color_value_of(record(i))); });
    expect("planarity", [&](std::size_t i) { return number(planarity_value_of(record(i))); });
    expect("intensity", [&](std::size_t i) { return number(channels.intensities[i]); });
    expect("label", [&](std::size_t i) { return number(channels.labels[i]); });
    expect("first_epoch", [&](std::size_t i) { return number(channels.first_epochs[i]); });
    expect("last_epoch", [&](std::size_t i) { return number(channels.last_epochs[i]); });
  }
}

TEST_F(PythonOpenvdb, ReadsTheChannelsOfNumbersAndVectorsByNameBesideIntegers) {
  const VoxelMap map = test::sample_map();
  export_channels(folder_ / "channels.vdb", map);
  auto grids = read(folder_ / "channels.vdb", {"mean", "cov_diag", "cov_offdiag", "normal", "color", "planarity"});
  expect_values(grids["mean"], map, map.finest(),
                [&](std::size_t i) { return values(mean_offset_of(map.finest().records()[i], 0.1)); });
}

TEST_F(PythonOpenvdb, WritesChannelsThatWeImport) {
  const std::string script =
      "import pyopenvdb as vdb, sys\n"
      "def grid(kind, name, value):\n"
      "  made = kind()\n"
      "  made.name = name\n"
      "  made.transform = vdb.createLinearTransform(0.1)\n"
      "  made.transform.translate((0.05, 0.05, 0.05))\n"
      "  for x in range(-10, 10): made.getAccessor().setValueOn((x, 3, -7), value)\n"
      "  return made\n"
      "vdb.write(sys.argv[1], [grid(vdb.FloatGrid, 'count', 4.0), grid(vdb.Vec3SGrid, 'mean', (0, 0.01, -0.02)),\n"
      "  grid(vdb.Vec3SGrid, 'cov_diag', (1e-4, 2e-4, 3e-4)), grid(vdb.Vec3SGrid, 'cov_offdiag', (0, 0, 0))],\n"
      "  metadata={'anchor_x': 640, 'anchor_y': -64.0, 'epsg': 25832})\n";
  const auto result = test::run_command(kPython, {"-c", script, folder_ / "hand_made.vdb"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const VoxelMap map = import_channels(folder_ / "hand_made.vdb");
  EXPECT_EQ(map.frame.anchor, Eigen::Vector3d(640, -64, 0));
  EXPECT_EQ(map.frame.epsg, 25832);
  EXPECT_EQ(map.finest().size(), 20u);
  EXPECT_EQ(num_points(map.coarsest()), 80u);
  EXPECT_EQ(map.coarsest().size(), 2u);
}

}  // namespace
}  // namespace vdbmap

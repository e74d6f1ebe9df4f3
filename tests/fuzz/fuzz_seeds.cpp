// SPDX-License-Identifier: GPL-3.0-or-later
// fuzz_seeds FOLDER: writes small valid files to begin fuzzing with, FOLDER/TARGET/NAME.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include "tests/support/las_bytes.h"
#include "tests/support/laz_seeds.h"
#include "tests/support/raw_files.h"
#include "tests/support/sample_maps.h"
#include "tests/support/vlp16_packets.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/io/kitti/kitti_bin.h"
#include "vdbmap/io/kitti/label_file.h"
#include "vdbmap/io/las/las.h"
#include "vdbmap/io/pcd/pcd.h"
#include "vdbmap/io/ply/ply.h"
#include "vdbmap/io/poses/trajectory_file.h"
#include "vdbmap/io/table/xyz.h"
#include "vdbmap/io/vdb/map_channels.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/io/vdb/vdb_file.h"

namespace vdbmap {
namespace {

namespace fs = std::filesystem;

fs::path file_in(const fs::path& folder, const char* target, const std::string& name) {
  fs::create_directories(folder / target);
  return folder / target / name;
}

PointCloud small_cloud(bool has_attributes) {
  PointCloud cloud;
  for (int i = 0; i < 12; ++i) {
    cloud.positions.emplace_back(1.5 * i, 20.25 - i, 0.125 * i * i);
    if (!has_attributes) continue;
    cloud.intensities.push_back(0.1F * static_cast<float>(i));
    cloud.colors.push_back({static_cast<std::uint16_t>(5000 * i), 20'000, 300});
    cloud.labels.push_back(i % 4);
    cloud.times.push_back(0.01 * i);
  }
  return cloud;
}

void write_clouds(const fs::path& folder, bool has_attributes) {
  const PointCloud cloud = small_cloud(has_attributes);
  const std::string name = has_attributes ? "full" : "bare";
  write_ply(file_in(folder, "ply", name + "_ascii.ply"), cloud, PlyEncoding::kAscii);
  write_ply(file_in(folder, "ply", name + "_binary.ply"), cloud);
  write_pcd(file_in(folder, "pcd", name + "_ascii.pcd"), cloud, PcdEncoding::kAscii);
  write_pcd(file_in(folder, "pcd", name + "_binary.pcd"), cloud);
  write_pcd(file_in(folder, "pcd", name + "_compressed.pcd"), cloud, PcdEncoding::kBinaryCompressed);
  write_xyz(file_in(folder, "xyz", name + ".xyz"), cloud);
  write_kitti_bin(file_in(folder, "kitti_bin", name + ".bin"), cloud);
  write_las(file_in(folder, "las", name + ".las"), cloud);
}

void write_tables(const fs::path& folder) {
  test::write_raw(file_in(folder, "xyz", "agisoft.txt"), "1 2 3 10 20 30 0.1 0.2 0.97\n4 5 6 200 210 220 0 0 1\n");
  test::write_raw(file_in(folder, "xyz", "cloudcompare.csv"),
                  "//X,Y,Z,Rf,Gf,Bf,Intensity\n2\n1.5,2.5,3.5,0.1,0.2,0.3,7\n1.25,2,3,1,1,1,9\n");
  test::write_raw(file_in(folder, "xyz", "leica.pts"), "2\n1 2 3 -1200 10 20 30\n4 5 6 800 1 2 3\n");
}

void write_las_formats(const fs::path& folder) {
  for (const unsigned format : {0U, 1U, 2U, 3U, 6U, 7U, 8U}) {
    test::LasBytes las;
    las.minor_version = format < 6 ? 2 : 4;
    las.format = format;
    las.points = {{1, 2, 3, 4, 2}, {500, -600, 700, 8, 6, 1.5, 100, 200, 300}};
    las.records = {{"LASF_Projection", 34735, test::geo_keys({{1024, 1}, {3072, 25832}})}};
    test::write_raw(file_in(folder, "las", "format" + std::to_string(format) + ".las"), las.bytes());
  }
  for (const test::LazSeed& seed : test::laz_seeds()) test::write_raw(file_in(folder, "laz", seed.name), seed.bytes);
}

void write_captures(const fs::path& folder) {
  for (const bool has_dual_returns : {false, true}) {
    test::Vlp16Recording recording;
    recording.num_packets = 4;
    recording.has_dual_returns = has_dual_returns;
    const std::string bytes = test::ethernet_capture(test::vlp16_payloads(test::RoundRoom(), recording));
    test::write_raw(file_in(folder, "pcap", has_dual_returns ? "dual.pcap" : "strongest.pcap"), bytes);
  }
}

void write_texts(const fs::path& folder) {
  Trajectory trajectory;
  for (int i = 0; i < 3; ++i) {
    trajectory.map_from_scan.emplace_back(Eigen::Translation3d(i, 2.5, 0) *
                                          Eigen::AngleAxisd(0.3 * i, Eigen::Vector3d::UnitZ()));
    trajectory.times.push_back(1e9 + i);
  }
  write_trajectory(file_in(folder, "trajectory", "kitti.txt"), trajectory, TrajectoryFormat::kKitti);
  write_trajectory(file_in(folder, "trajectory", "tum.txt"), trajectory, TrajectoryFormat::kTum);
  test::write_raw(file_in(folder, "trajectory", "euroc.csv"),
                  "#timestamp [ns],p_x,p_y,p_z,q_w,q_x,q_y,q_z\n1403636579763555584,1,2,3,1,0,0,0\n");
  write_labels(file_in(folder, "label", "small.label"), {{10, 1}, {40, 0}, {252, 7}});
  test::write_raw(
      file_in(folder, "wkt", "utm.wkt"),
      R"(PROJCS["ETRS89 / UTM 32N",GEOGCS["ETRS89",DATUM["E",SPHEROID["GRS",6378137,298.257]],UNIT["degree",0.0174533]],)"
      R"(PROJECTION["Transverse_Mercator"],UNIT["metre",1],AUTHORITY["EPSG","25832"]])");
  test::write_raw(file_in(folder, "wkt", "compound.wkt"),
                  R"(COMPD_CS["c",PROJCS["p",UNIT["US survey foot",0.3048006]],VERT_CS["v",UNIT["m",1]]])");
}

// Without our checksum, in place of which another program writes a random id.
std::string without_checksum(std::string vdb) {
  constexpr std::size_t kIdOffset = 21, kIdLength = 36;
  return vdb.replace(kIdOffset, kIdLength, "01234567-89ab-cdef-0123-456789abcdef");
}

void write_with_openvdb(const fs::path& path, const openvdb::GridPtrVec& grids, const openvdb::MetaMap& metadata = {},
                        std::uint32_t compression = openvdb::io::COMPRESS_ACTIVE_MASK) {
  openvdb::io::File file(path.string());
  file.setCompression(compression);
  file.write(grids, metadata);
}

// Changed bytes of compressed blocks mostly end in the decompressor: so files are there as plain numbers, too.
void rewrite_plain(const fs::path& path) {
  const VdbContent content = read_vdb(path);
  write_with_openvdb(path, content.grids, *content.metadata);
}

openvdb::GridBase::Ptr fog() {
  const auto density = openvdb::FloatGrid::create(0);
  density->setName("density");
  density->tree().setValue({1, 2, 3}, 0.5F);
  density->fill({{0, 0, 0}, {15, 7, 7}}, 0.25F);
  return density;
}

// A few voxels of some type.
template <typename Grid>
openvdb::GridBase::Ptr few_voxels(const char* name, const typename Grid::ValueType& value) {
  const auto grid = Grid::create();
  grid->setName(name);
  grid->tree().setValue({1, 2, 3}, value);
  grid->tree().addTile(1, {8, 0, 0}, value, true);
  return grid;
}

// One grid of each kind that programs write, with every kind of transform.
openvdb::GridPtrVec one_of_each() {
  openvdb::GridPtrVec grids = {fog(),
                               few_voxels<openvdb::Vec3SGrid>("Cd", {0.1F, 0.2F, 0.3F}),
                               few_voxels<openvdb::Vec3DGrid>("v", {1, 2, 3}),
                               few_voxels<openvdb::DoubleGrid>("height", 2.5),
                               few_voxels<openvdb::Int32Grid>("id", 7),
                               few_voxels<openvdb::Int64Grid>("time", 1'000'000'000'000),
                               few_voxels<openvdb::BoolGrid>("inside", true),
                               few_voxels<openvdb::MaskGrid>("mask", true)};
  grids[1]->setTransform(openvdb::math::Transform::createLinearTransform(0.1));
  grids[1]->setVectorType(openvdb::VEC_INVARIANT);
  openvdb::Mat4d sheared = openvdb::Mat4d::identity();
  sheared[1][0] = 0.5;
  grids[2]->setTransform(openvdb::math::Transform::createLinearTransform(sheared));
  grids[3]->setTransform(openvdb::math::Transform::createFrustumTransform({{0, 0, 0}, {10, 10, 10}}, 0.5, 5, 0.1));
  grids[3]->setSaveFloatAsHalf(true);
  grids[4]->setGridClass(openvdb::GRID_LEVEL_SET);
  return grids;
}

// A map with all attributes, of one level: every grid takes 9 kB for the masks of its nodes, however few its voxels.
VoxelMap small_map(bool has_attributes) {
  BuildOptions options;
  options.voxel_sizes = {0.1};
  return build_map(small_cloud(has_attributes), options);
}

// A grid, and an instance of its voxels.
openvdb::GridPtrVec two_of_one_tree() {
  const openvdb::GridBase::Ptr grid = fog();
  const openvdb::GridBase::Ptr instance = grid->copyGrid();
  instance->setName("instance");
  return {grid, instance};
}

void write_vdb_files(const fs::path& folder) {
  const fs::path scratch = folder / "scratch.vdb";
  const auto add = [&](const std::string& name) {
    const std::string bytes = without_checksum(test::read_raw(scratch));
    for (const char* target : {"map", "vdb", "outline"}) test::write_raw(file_in(folder, target, name), bytes);
  };
  const auto add_both = [&](const std::string& name) {
    add(name + ".vdb");
    rewrite_plain(scratch);
    add(name + "_plain.vdb");
  };
  save_map(scratch, small_map(false));
  add_both("bare_map");
  save_map(scratch, small_map(true));
  add_both("full_map");
  save_map(scratch, test::map_of_voxels({{0, 0, 0}, {1, 0, 0}, {0, 9, -3}}));
  add_both("two_levels");
  export_channels(scratch, small_map(true));
  add("channels.vdb");
  for (const std::uint32_t compression : {1U, 2U, 3U, 6U}) {
    write_with_openvdb(scratch, {fog()}, {}, compression);
    add("fog" + std::to_string(compression) + ".vdb");
  }
  for (const openvdb::GridBase::Ptr& grid : one_of_each()) {
    write_with_openvdb(scratch, {grid});
    add(grid->getName() + ".vdb");
  }
  write_with_openvdb(scratch, two_of_one_tree());
  add("instance.vdb");
  std::ofstream stream(scratch, std::ios::binary);
  openvdb::io::Stream(stream).write(openvdb::GridPtrVec{fog()});
  stream.close();
  add("stream.vdb");
  fs::remove(scratch);
}

}  // namespace
}  // namespace vdbmap

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: fuzz_seeds FOLDER\n";
    return 2;
  }
  using namespace vdbmap;
  openvdb::initialize();
  const std::filesystem::path folder = argv[1];
  for (const bool has_attributes : {false, true}) write_clouds(folder, has_attributes);
  write_tables(folder);
  write_las_formats(folder);
  write_captures(folder);
  write_texts(folder);
  write_vdb_files(folder);
  return 0;
}

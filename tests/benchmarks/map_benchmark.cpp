// SPDX-License-Identifier: GPL-3.0-or-later
// How long does it take to make, write and read a map, and how much room does it need? The peer of `build_map` is
// `open3d_voxel_down_sample` in map_peer_benchmark.cpp.
#include <filesystem>
#include <optional>

#include <benchmark/benchmark.h>
#include <malloc.h>

#include "tests/benchmarks/drive.h"
#include "tests/benchmarks/sample_clouds.h"
#include "tests/support/folders.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/io/vdb/map_file.h"

namespace vdbmap::benchmarks {
namespace {

constexpr int kRepetitions = 7;

void set_options(benchmark::internal::Benchmark* row) {
  row->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1)->Repetitions(kRepetitions)->DisplayAggregatesOnly();
}

void with_one_and_two_threads(benchmark::internal::Benchmark* row) {
  row->ArgName("threads")->Arg(1)->Arg(2);
  set_options(row);
}

/// Bytes in use on the heap, whatever data structures say of themselves.
double heap_bytes() {
  const struct mallinfo2 info = ::mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

std::optional<PointCloud> cloud_of(CloudSource source, bool has_color) {
  const PointCloud* cloud = source();
  if (!cloud) return std::nullopt;
  return has_color ? *cloud : without_colors(*cloud);
}

// 4.34 M points to the map of 10 cm and 1 m in memory: moments, colours, normals.
void build_map(benchmark::State& state, CloudSource source) {
  const PointCloud* cloud = source();
  if (!cloud) return state.SkipWithError(kNoDrive);
  const ThreadLimit limit(static_cast<std::size_t>(state.range(0)));
  std::optional<VoxelMap> map;
  for (auto _ : state) map = vdbmap::build_map(*cloud);

  state.counters["points"] = static_cast<double>(cloud->size());
  state.counters["voxels"] = static_cast<double>(map->finest().size());
}
BENCHMARK_CAPTURE(build_map, drive, drive_cloud)->Apply(with_one_and_two_threads);
BENCHMARK_CAPTURE(build_map, street, street_cloud)->Apply(with_one_and_two_threads);

VoxelMap map_of_scans(const Drive& drive) {
  MapBuilder builder({});
  for (std::size_t i = 0; i < drive.scans.size(); ++i) builder.add(drive.scans[i], drive.map_from_scan[i]);
  return builder.finish();
}

// All scans of the drive one by one with their poses, as `vdbmap build` adds them.
void build_from_scans(benchmark::State& state) {
  const Drive* drive = kitti_drive();
  if (!drive) return state.SkipWithError(kNoDrive);
  const ThreadLimit limit(static_cast<std::size_t>(state.range(0)));
  std::optional<VoxelMap> map;
  for (auto _ : state) map = map_of_scans(*drive);

  state.counters["points"] = static_cast<double>(num_points(map->finest()));
  state.counters["voxels"] = static_cast<double>(map->finest().size());
}
BENCHMARK(build_from_scans)->Apply(with_one_and_two_threads);

// The same scans from their files into memory.
void read_scans(benchmark::State& state) {
  const Drive* drive = kitti_drive();
  if (!drive) return state.SkipWithError(kNoDrive);
  for (auto _ : state) {
    for (const auto& file : drive->files) benchmark::DoNotOptimize(read_points(file));
  }
}
BENCHMARK(read_scans)->Apply(set_options);

void count_bytes(benchmark::State& state, const VoxelMap& map, double heap, const std::filesystem::path& file) {
  const auto voxels = static_cast<double>(map.finest().size());
  state.counters["voxels"] = voxels;
  state.counters["points_per_voxel"] = static_cast<double>(num_points(map.finest())) / voxels;
  state.counters["voxels_per_leaf"] = voxels / static_cast<double>(map.finest().leaves().size());
  state.counters["memory_B_per_voxel"] = static_cast<double>(memory_bytes(map)) / voxels;
  state.counters["heap_B_per_voxel"] = heap / voxels;
  state.counters["file_B_per_voxel"] = static_cast<double>(std::filesystem::file_size(file)) / voxels;
}

void measure_saving(benchmark::State& state, const VoxelMap& map, double heap) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "map.vdb";
  for (auto _ : state) save_map(file, map);
  count_bytes(state, map, heap, file);
}

// Counters: bytes of all levels and attributes, per voxel of the finest level.
void save_cloud_map(benchmark::State& state, CloudSource source, bool has_color) {
  const std::optional<PointCloud> cloud = cloud_of(source, has_color);
  if (!cloud) return state.SkipWithError(kNoDrive);
  const double before = heap_bytes();
  const VoxelMap map = vdbmap::build_map(*cloud);
  measure_saving(state, map, heap_bytes() - before);
}
BENCHMARK_CAPTURE(save_cloud_map, drive_color, drive_cloud, true)->Apply(set_options);
BENCHMARK_CAPTURE(save_cloud_map, drive_plain, drive_cloud, false)->Apply(set_options);
BENCHMARK_CAPTURE(save_cloud_map, street_color, street_cloud, true)->Apply(set_options);
BENCHMARK_CAPTURE(save_cloud_map, street_plain, street_cloud, false)->Apply(set_options);

// The map of all scans of the drive, with their intensities.
void save_scan_map(benchmark::State& state) {
  const Drive* drive = kitti_drive();
  if (!drive) return state.SkipWithError(kNoDrive);
  const double before = heap_bytes();
  const VoxelMap map = map_of_scans(*drive);
  measure_saving(state, map, heap_bytes() - before);
}
BENCHMARK(save_scan_map)->Apply(set_options);

void load_cloud_map(benchmark::State& state, CloudSource source) {
  const PointCloud* cloud = source();
  if (!cloud) return state.SkipWithError(kNoDrive);
  const test::TemporaryFolder folder;
  save_map(folder / "map.vdb", vdbmap::build_map(*cloud));
  std::optional<VoxelMap> map;
  for (auto _ : state) map = load_map(folder / "map.vdb");
  state.counters["voxels"] = static_cast<double>(map->finest().size());
}
BENCHMARK_CAPTURE(load_cloud_map, drive, drive_cloud)->Apply(set_options);
BENCHMARK_CAPTURE(load_cloud_map, street, street_cloud)->Apply(set_options);

}  // namespace
}  // namespace vdbmap::benchmarks

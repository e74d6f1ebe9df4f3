#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# tools/benchmark.sh [DATA_FOLDER]: measures speed, size and accuracy, and prints them as one table. DATA_FOLDER holds
# velodyne/ and poses.txt of a drive; without it only what needs no data is measured. VDBMAP_BUILD_DIR chooses another
# build folder than build/release. Everything measured stays in that folder's benchmark/.
set -euo pipefail
if (($# > 1)); then
  echo "usage: tools/benchmark.sh [DATA_FOLDER]" >&2
  exit 2
fi
if (($# == 1)) && [[ ! -d $1/velodyne || ! -f $1/poses.txt ]]; then
  echo "tools/benchmark.sh: $1 must hold velodyne/ and poses.txt" >&2
  exit 3
fi
data=${1:+$(realpath "$1")}
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/packages.sh

build=${VDBMAP_BUILD_DIR:-build/release}
results=$build/benchmark
table=$results/table.txt

skip() { echo "SKIPPED: $*" | tee -a "$table"; }

row() { printf '%-46s %12s  %s\n' "$1" "$2" "${3:-}" >> "$table"; }

vdbmap() { "$build/bin/vdbmap" "$@"; }

build_all() {
  install_missing "${build_packages[@]}" "${test_packages[@]}" "${benchmark_packages[@]}"
  cmake --preset release -B "$build" -D VDBMAP_BUILD_BENCHMARKS=ON
  cmake --build "$build" \
    --target vdbmap_command map_benchmark fine_benchmark odometry_benchmark coarse_benchmark render_benchmark \
    laz_benchmark
  npm ci --prefix tests/exchange --no-audit --no-fund || echo "laz-perf is not installed: LAZ has no peer"
}

# Interleaving spreads other programs' work over all rows, so that their ratios hold on a busy machine.
run_benchmark() {
  "$build/bin/$1" --benchmark_enable_random_interleaving=true --benchmark_out="$results/$1.json" \
    --benchmark_out_format=json
}

# The median over the repetitions: benchmark file, row, field (default: time). Nothing where the row was skipped.
median() {
  jq -r --arg row "$2/" --arg field "${3:-real_time}" '[.benchmarks[]
    | select(.aggregate_name == "median" and (.run_name | startswith($row)) and (.error_occurred | not))][0][$field]
    // empty' "$results/$1.json"
}

# The median with decimals and a unit, or nothing.
median_text() {
  local value
  value=$(median "$1" "$2" "$3")
  if [[ -n $value ]]; then printf "%.$4f%s" "$value" "${5:-}"; fi
}

milliseconds() { median_text "$1" "$2" real_time "${3:-0}" ' ms'; }

# How many times as long the third argument's row takes as the second's: benchmark file, rows, field.
ratio() {
  local ours peer
  ours=$(median "$1" "$2" "$4")
  peer=$(median "$1" "$3" "$4")
  if [[ -n $ours && -n $peer ]]; then awk -v a="$ours" -v b="$peer" 'BEGIN { printf "%.1f times", b / a }'; fi
}

tabulate_building() {
  local cloud threads peer
  for cloud in drive street; do
    for threads in 1 2; do
      row "build 4.34 M points, $cloud, $threads threads" \
        "$(milliseconds map_benchmark "build_map/$cloud/threads:$threads")" \
        "$(median_text map_benchmark "build_map/$cloud/threads:$threads" voxels 0 ' voxels')"
    done
    peer=open3d_voxel_down_sample/$cloud
    if [[ -z $(median map_benchmark "$peer") ]]; then continue; fi
    row "  Open3D voxel_down_sample, 1 thread" "$(milliseconds map_benchmark "$peer")" \
      "$(ratio map_benchmark "build_map/$cloud/threads:2" "$peer" real_time) vdbmap with 2 threads,\
 $(ratio map_benchmark "build_map/$cloud/threads:1" "$peer" cpu_time) with 1 by CPU time"
  done
  row "build the drive scan by scan, 2 threads" "$(milliseconds map_benchmark build_from_scans/threads:2)"
  row "read its scans" "$(milliseconds map_benchmark read_scans)"
}

tabulate_size() {
  local map
  for map in save_cloud_map/drive_color save_cloud_map/drive_plain save_cloud_map/street_color \
    save_cloud_map/street_plain save_scan_map; do
    row "bytes a voxel, $map" "$(median_text map_benchmark "$map" memory_B_per_voxel 1 ' B')" \
      "in memory; $(median_text map_benchmark "$map" heap_B_per_voxel 1) of heap,\
 $(median_text map_benchmark "$map" file_B_per_voxel 1) in the file,\
 $(median_text map_benchmark "$map" voxels_per_leaf 1) voxels a leaf"
  done
  row "save the map, street" "$(milliseconds map_benchmark save_cloud_map/street_color)"
  row "load the map, street" "$(milliseconds map_benchmark load_cloud_map/street)"
}

tabulate_pictures() {
  local map view names=(plan perspective orbit)
  for map in street drive quarter; do
    for view in 0 1 2; do
      row "picture of 1920 x 1080, $map, ${names[view]}" "$(milliseconds render_benchmark "render_$map/view:$view/threads:2")" \
        "2 threads; $(median_text render_benchmark "render_$map/view:$view/threads:1" cpu_time 0 ' ms') CPU;\
 $(median_text render_benchmark "render_$map/view:$view/threads:1" voxels 0 ' voxels')"
    done
  done
}

tabulate_fine() {
  local name
  for name in align_scan/threads:1 align_scan/threads:2 open3d_icp/threads:2 open3d_icp_with_kept_tree/threads:2; do
    if [[ -z $(median fine_benchmark "$name") ]]; then continue; fi
    row "fine, one scan, $name" "$(milliseconds fine_benchmark "$name" 1)" \
      "$(median_text fine_benchmark "$name" cpu_ms 1 ' ms') CPU;\
 error $(median_text fine_benchmark "$name" median_m 4 ' m'), at most\
 $(median_text fine_benchmark "$name" max_m 3 ' m'); found $(median_text fine_benchmark "$name" found_share 2)"
  done
}

tabulate_odometry() {
  local name
  for name in register_scan/threads:1 register_scan/threads:2; do
    if [[ -z $(median odometry_benchmark "$name") ]]; then continue; fi
    row "odometry, one scan, $name" "$(milliseconds odometry_benchmark "$name" 1)" \
      "$(median_text odometry_benchmark "$name" cpu_ms 1 ' ms') CPU;\
 XY error at most $(median_text odometry_benchmark "$name" max_xy_m 3 ' m')"
  done
}

# A row's field with decimals, of a benchmark that ran once.
once() { jq -r --arg row "$1" --arg field "$2" '[.benchmarks[] | select(.run_name | startswith($row))][0][$field] // empty
  | if type == "number" then . * 1000 | round / 1000 else empty end' "$results/coarse_benchmark.json"; }

# 50 batches a row, found in the map of the same street and refused in that of another.
tabulate_coarse() {
  local place row
  for row in features/threads:1 features/threads:2 open3d_features/threads:1 open3d_features/threads:2; do
    if [[ -n $(once "$row" real_time) ]]; then row "normals and FPFH, $row" "$(once "$row" real_time) ms"; fi
  done
  for place in drive kitti00; do
    row "batch found in the map, $place" "$(once "find_batches/$place" real_time) ms" \
      "$(once "find_batches/$place" within_2m_5deg) within 2 m and 5 deg before alignment,\
 $(once "find_batches/$place" 'within_10cm_0.5deg') within 0.1 m and 0.5 deg after, $(once "find_batches/$place" wrong) wrong"
    row "  and every scan of it, $place" "$(once "localize_batches/$place" real_time) ms" \
      "$(once "localize_batches/$place" 'within_10cm_0.5deg') within 0.1 m and 0.5 deg,\
 $(once "localize_batches/$place" wrong) wrong"
  done
  for row in kitti00_in_drive drive_in_kitti00; do
    row "batches of another place accepted, $row" "$(once "refuse_batches/$row" accepted)"
  done
}

tabulate_laz() {
  local kind threads
  for kind in pointwise layered; do
    if [[ -z $(median laz_benchmark "read_laz/$kind/threads:1") ]]; then continue; fi
    for threads in 1 2; do
      row "read LAZ, 2.2 M points, $kind, $threads threads" \
        "$(median_text laz_benchmark "read_laz/$kind/threads:$threads" million_points_per_s 2 ' M/s')"
    done
    row "  laz-perf in Node.js, 1 thread, decoding alone" \
      "$(median_text laz_benchmark "laz_perf/$kind" million_points_per_s 2 ' M/s')"
  done
}

# Odd scans in the map of the even ones, each from the pose of the scan before.
measure_accuracy() {
  awk 'NR % 2 == 0 { print before } { before = $0 }' "$data/poses.txt" > "$results/guesses.txt"
  vdbmap build "$data/velodyne" --poses "$data/poses.txt" --every 2 -o "$results/even.vdb"
  vdbmap localize "$results/even.vdb" "$data/velodyne" --every 2 --offset 1 --initial "$results/guesses.txt" \
    -o "$results/poses.txt"
  vdbmap evaluate "$results/poses.txt" "$data/poses.txt" --every 2 --offset 1 --json > "$results/accuracy.json"

  row "localize: scans within 0.10 m and 0.3 deg" \
    "$(jq -r '(100 * ([.poses[] | select(. != null and .rotation_deg <= 0.3
      and .xy_m * .xy_m + .z_m * .z_m <= 0.01)] | length) / .num_poses | tostring) + " %"' "$results/accuracy.json")" \
    "of $(jq -r .num_poses "$results/accuracy.json")"
  row "localize: median error" "$(jq -r '.translation_m.median * 1e4 | round / 1e4' "$results/accuracy.json") m" \
    "at most $(jq -r '.translation_m.max * 1e4 | round / 1e4' "$results/accuracy.json") m"
}

# The drive $1 times, side by side: copies of 512 m to the left share no voxel.
repeat_drive() {
  local copy scan number=0
  rm -rf "$results/copies"
  mkdir -p "$results/copies/velodyne"
  for ((copy = 0; copy < $1; copy++)); do
    for scan in "$data"/velodyne/*; do
      ln -s "$scan" "$results/copies/velodyne/$(printf '%06d' "$number").${scan##*.}"
      number=$((number + 1))
    done
    awk -v shift="$((512 * copy))" '{ $8 = sprintf("%.9f", $8 + shift); print }' "$data/poses.txt"
  done > "$results/copies/poses.txt"
}

# Prints "seconds user system kilobytes" of the middle one of three runs.
time_build() {
  for _ in 1 2 3; do
    /usr/bin/time --quiet --format '%e %U %S %M' --output "$results/time.txt" "$build/bin/vdbmap" build \
      "$results/copies/velodyne" --poses "$results/copies/poses.txt" -o "$results/copies.vdb" \
      > "$results/build.log" 2>&1
    cat "$results/time.txt"
  done | sort -n | sed -n 2p
}

measure_scaling() {
  local times seconds user system kilobytes voxels
  for times in 1 2 4 8; do
    repeat_drive "$times"
    read -r seconds user system kilobytes < <(time_build)
    voxels=$(vdbmap info "$results/copies.vdb" --json | jq '.levels[0].voxels')
    row "vdbmap build, $times times the drive" "$seconds s" \
      "$(awk -v a="$user" -v b="$system" 'BEGIN { printf "%.1f", a + b }') s CPU, $((kilobytes / 1024)) MB at the\
 peak, $((kilobytes * 1024 / voxels)) B a voxel, $voxels voxels"
  done
  rm -rf "$results/copies" "$results/copies.vdb"
}

# The middle one of three runs [s] of a command in the environment of the first argument.
time_command() {
  local environment=$1
  shift
  for _ in 1 2 3; do
    env "$environment" /usr/bin/time --quiet --format %e --output "$results/time.txt" "$build/bin/vdbmap" "$@" > /dev/null
    cat "$results/time.txt"
  done | sort -n | sed -n 2p
}

# Whole commands on a simulated street, and what huge pages save them.
measure_commands() {
  local street=$results/street map=$results/street.vdb command
  vdbmap simulate "$street" --seed 1 --ideal
  vdbmap build "$street/epoch0/cloud.las" -o "$map"
  local commands=(
    "build $street/epoch0/cloud.las -o $results/again.vdb"
    "info $map"
    "render $map -o $results/street.png"
    "localize $map $street/epoch1/scans -o $results/street.txt"
  )
  for command in "${commands[@]}"; do
    # shellcheck disable=SC2086 # words of a command
    row "vdbmap ${command%% *}, simulated street" "$(time_command LC_ALL=C $command) s" \
      "$(time_command MALLOC_CONF=thp:never $command) s without huge pages of jemalloc"
  done
  rm -rf "$street" "$map" "$results/again.vdb"
}

build_all
mkdir -p "$results"
: > "$table"
if [[ -n $data ]]; then export VDBMAP_DRIVE=$data; else skip "no DATA_FOLDER given: accuracy and scaling"; fi
run_benchmark map_benchmark
run_benchmark fine_benchmark
run_benchmark odometry_benchmark
run_benchmark coarse_benchmark
run_benchmark render_benchmark
run_benchmark laz_benchmark
if [[ -z $(median map_benchmark open3d_voxel_down_sample/street) ]]; then
  skip "Open3D not found (apt-get install libopen3d-dev): no peers"
fi
tabulate_building
tabulate_size
tabulate_fine
tabulate_odometry
tabulate_coarse
tabulate_pictures
tabulate_laz
measure_commands
if [[ -n $data ]]; then
  measure_accuracy
  measure_scaling
fi

echo
cat "$table"

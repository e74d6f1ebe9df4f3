#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# tools/demo.sh: simulates a street, maps its first survey, finds the scans of another day in it with no first guess,
# compares them with the truth, tells which parking spaces are taken, brings the map up to date, says what changed, and
# makes a site of it all. tools/demo.sh DATA_FOLDER: with real scans, from a folder with velodyne/ and poses.txt: a map of
# every second scan, the others found in it. Everything is written to demo/; demo/summary.txt holds what the commands said.
set -euo pipefail
if (($# > 1)); then
  echo "usage: tools/demo.sh [DATA_FOLDER]" >&2
  exit 2
fi
if (($# == 1)) && [[ ! -d $1/velodyne || ! -f $1/poses.txt ]]; then
  echo "tools/demo.sh: $1 must hold velodyne/ and poses.txt" >&2
  exit 3
fi
data=${1:+$(realpath "$1")}
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/packages.sh

install_missing "${build_packages[@]}" "${test_packages[@]}"
cmake --preset release
cmake --build --preset release --target vdbmap_command
mkdir -p demo
: > demo/summary.txt

vdbmap() {
  {
    printf '\n$ vdbmap %s\n' "$*"
    build/release/bin/vdbmap "$@"
  } | tee -a demo/summary.txt
}

# The mean of a voxel halfway down the exported list: a place where there is something to ask for.
some_point() {
  awk -v count="$(wc -l < "$1")" -F '[ ,\t]+' 'NR > count / 2 && $1 + 0 == $1 { print $1 "," $2 "," $3; exit }' "$1"
}

look_into_map() {
  vdbmap info demo/map.vdb
  vdbmap export demo/map.vdb demo/map.xyz
  vdbmap query demo/map.vdb --at "$(some_point demo/map.xyz)"
  vdbmap check demo/map.vdb
  vdbmap export demo/map.vdb demo/map.ply
  vdbmap export demo/map.vdb --channels demo/channels.vdb
  vdbmap import demo/channels.vdb -o demo/imported.vdb
}

draw_pictures() {
  vdbmap render demo/map.vdb -o demo/street.png
  vdbmap render demo/map.vdb -o demo/plan.png --view plan --trajectory demo/poses.txt "$1"
  vdbmap render demo/map.vdb -o demo/drive.png --view perspective --trajectory demo/poses.txt
  vdbmap segment demo/map.vdb -o demo/labelled.vdb
  vdbmap render demo/labelled.vdb -o demo/classes.png --view perspective --color-by label
}

# Spaces of the first survey's vehicles, and which of them are taken on the day of the scans in $1.
look_for_parking() {
  vdbmap spaces demo/labelled.vdb -o demo/spaces.geojson --date 2023-03-01
  vdbmap occupancy demo/labelled.vdb demo/spaces.geojson "$1" --poses demo/poses.txt -o demo/occupancy.json \
    --geojson demo/occupancy.geojson --csv demo/occupancy.csv --cds demo/curbs.json --fiware demo/fiware.json \
    --report demo/report.png --city Hannover --date 2023-03-02
}

demonstrate_on_simulated_street() {
  local street=demo/street
  vdbmap simulate "$street" --seed 1 --ideal
  vdbmap build "$street/epoch0/cloud.las" --trajectory "$street/epoch0/mapper.tum" --lever-arm 0,0,2 --date 2023-03-01 \
    -o demo/map.vdb
  look_into_map
  vdbmap localize demo/map.vdb "$street/epoch1/scans" -o demo/poses.txt --report demo/report.json
  vdbmap evaluate demo/poses.txt "$street/epoch1/poses.txt" --plot demo/evaluation.png
  draw_pictures "$street/epoch1/poses.txt"
  look_for_parking "$street/epoch1/scans"
  vdbmap update demo/map.vdb "$street/epoch1/scans" --poses demo/poses.txt --date 2023-03-02 -o demo/map2.vdb
  vdbmap diff demo/map.vdb demo/map2.vdb -o demo/diff.vdb --geojson demo/changes.geojson --plot demo/changes.png
  vdbmap web demo/labelled.vdb -o demo/site --spaces demo/spaces.geojson demo/occupancy.geojson --name "A simulated street"
  echo "The street in the browser: build/release/bin/vdbmap web demo/site --serve --open"
}

demonstrate_on_real_scans() {
  # The guess for each odd scan is the pose of the scan before it.
  awk 'NR % 2 == 0 { print before } { before = $0 }' "$data/poses.txt" > demo/guesses.txt

  vdbmap build "$data/velodyne" --poses "$data/poses.txt" --every 2 -o demo/map.vdb
  look_into_map
  vdbmap build "$data/velodyne" --poses "$data/poses.txt" --every 2 --offset 1 -o demo/odd.vdb
  vdbmap merge demo/map.vdb demo/odd.vdb -o demo/both.vdb
  vdbmap odometry "$data/velodyne" -o demo/odometry.txt --map demo/local.vdb
  vdbmap localize demo/map.vdb "$data/velodyne" --every 2 --offset 1 --initial demo/guesses.txt -o demo/guided.txt
  vdbmap localize demo/map.vdb "$data/velodyne" --every 2 --offset 1 -o demo/poses.txt --report demo/report.json
  vdbmap evaluate demo/poses.txt "$data/poses.txt" --every 2 --offset 1 --plot demo/evaluation.png
  draw_pictures "$data/poses.txt"
}

if [[ -n $data ]]; then demonstrate_on_real_scans; else demonstrate_on_simulated_street; fi

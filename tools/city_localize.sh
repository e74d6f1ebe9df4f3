#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# tools/city_localize.sh WORK_FOLDER [STREETS]: localizes 101 scans of a simulated VLP-16 drive with no first guess in
# cities of 1, 4, 16, ... up to STREETS (64) streets of different seeds, headings and heights side by side, then in the
# largest with a twin of the drive's own street planted beside it. Prints how many scans are found, how many of these
# more than 0.5 m from the truth, time and peak of each. Streets are added one by one, each an epoch of one city, so the
# cities are city@1, city@4, ...; some 50 MB a street stay on the disk. VDBMAP_BUILD_DIR chooses another build folder
# than build/release.
set -euo pipefail
if (($# < 1 || $# > 2)); then
  echo "usage: tools/city_localize.sh WORK_FOLDER [STREETS]" >&2
  exit 2
fi
mkdir -p "$1"
work=$(realpath "$1")
most=${2:-64}
cd "$(dirname "${BASH_SOURCE[0]}")/.."
vdbmap=${VDBMAP_BUILD_DIR:-build/release}/bin/vdbmap
city=$work/city
first_seed=101

# Moves a survey to the place of street number $3: $1 is the LAS file, $2 the street.json beside it. Streets have 400 m
# each, the first stays where it is; a place that is no number is $3 = X,Y,Z [m] away.
place_survey() {
  python3 - "$@" "$work/first/street.json" << 'PYTHON'
import json
import math
import sys

sys.path.insert(0, 'tools')
from shift_las import shift


def middle(path):
    with open(path) as file:
        street = json.load(file)
    axis, half = street['axis'], street['options']['length'] / 2
    x, y, z = axis['origin']
    return x + half * math.cos(axis['heading']), y + half * math.sin(axis['heading']), z


cloud, street, place, first = sys.argv[1:]
if ',' in place:
    by = [float(value) for value in place.split(',')]
else:
    number = int(place)
    cell = (400 * (number // 8), 400 * (number % 8), 3 * (number % 5))
    by = [round(a + c - b) for a, b, c in zip(middle(first), middle(street), cell)]
shift(cloud, by)
PYTHON
}

# Adds the survey $2 to the city $1 as its epoch $3.
add_street() {
  local target=(--into "$1")
  [[ -e $1/map.json ]] || target=(-o "$1/")
  "$vdbmap" build "$2" "${target[@]}" --epoch "$3" --memory 1G --quiet > /dev/null
}

build_city() {
  [[ -e $work/first/epoch1 ]] || "$vdbmap" simulate "$work/first" --seed $first_seed --quiet > /dev/null
  [[ -e $city/map.json ]] || add_street "$city" "$work/first/epoch0/cloud.las" 1
  local number street=$work/next
  for ((number = $(jq .epoch "$city/map.json"); number < most; ++number)); do
    "$vdbmap" simulate "$street" --seed $((first_seed + number)) --epochs 1 --sensors mapper --quiet > /dev/null
    place_survey "$street/epoch0/cloud.las" "$street/street.json" "$number"
    add_street "$city" "$street/epoch0/cloud.las" $((number + 1))
    rm -r "$street"
  done
}

# A city with the first street once more, 400 m away and not by whole voxels: no place of it is the only one. Tiles are
# never changed, so the two cities share their files.
plant_twin() {
  rm -rf "$work/twin"
  cp -rl "$city" "$work/twin"
  rm "$work/twin/lock"
  cp "$work/first/epoch0/cloud.las" "$work/twin.las"
  place_survey "$work/twin.las" "$work/first/street.json" -400.37,-3.62,2.45
  add_street "$work/twin" "$work/twin.las" $((most + 1))
  rm "$work/twin.las"
}

# Localizes the drive in the map $2, and prints a row named $1.
localize() {
  local name=$work/found.$1 times
  times=$(mktemp)
  # 1: not a single scan found, which the row then says.
  /usr/bin/time -o "$times" -f '%e %U %S %M' "$vdbmap" localize "$2" "$work/first/epoch1/scans" -o "$name.txt" \
    --report "$name.report.json" --quiet > /dev/null || (($? == 1))
  local found=0 wrong=0
  if grep -qv nan "$name.txt"; then
    "$vdbmap" evaluate "$name.txt" "$work/first/epoch1/poses.txt" --json "$name.json" --quiet > /dev/null
    read -r found wrong < <(jq -r '[.poses[] | select(. != null)] | "\(length) \(map(select(.xy_m > 0.5)) | length)"' \
      "$name.json")
  fi
  tail -n 1 "$times" | awk -v name="$1" -v found="$found" -v wrong="$wrong" '{
    printf "%-24s %4d found %4d wrong %8.2f s %8.2f s of processors %6.0f MB\n", name, found, wrong, $1, $2 + $3, $4 / 1024 }'
  rm "$times"
  # What was said of batches that were not found, once each.
  jq -r '[.batches[] | select(.found | not) | .reason] | unique[] | "  " + .' "$name.report.json"
}

build_city
for ((count = 1; count <= most; count *= 4)); do localize "streets_$count" "$city@$count"; done
plant_twin
localize twin "$work/twin"

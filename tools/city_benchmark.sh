#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# tools/city_benchmark.sh WORK_FOLDER [STREETS] [MEMORY]: builds cities of 1, 4, 16, ... up to STREETS (16) simulated
# streets side by side with --memory MEMORY (1G), and prints time and peak of each beside those of one street in
# memory. Four streets of different seeds are simulated once; further ones are these four at other places, 320 m apart
# and of other heights. VDBMAP_BUILD_DIR chooses another build folder than build/release.
set -euo pipefail
if (($# < 1 || $# > 3)); then
  echo "usage: tools/city_benchmark.sh WORK_FOLDER [STREETS] [MEMORY]" >&2
  exit 2
fi
mkdir -p "$1"
work=$(realpath "$1")
most=${2:-16}
memory=${3:-1G}
cd "$(dirname "${BASH_SOURCE[0]}")/.."
vdbmap=${VDBMAP_BUILD_DIR:-build/release}/bin/vdbmap

simulate_streets() {
  for seed in 1 2 3 4; do
    [[ -e $work/street$seed ]] ||
      "$vdbmap" simulate "$work/street$seed" --seed "$seed" --epochs 1 --sensors mapper --quiet > /dev/null
  done
}

# Street number $1 as a LAS file of its own: one of the four with other offsets in its header.
place_street() {
  local file
  printf -v file '%s/survey/street_%03d.las' "$work" "$1"
  [[ -e $file ]] && return
  mkdir -p "$work/survey"
  cp "$work/street$(($1 % 4 + 1))/epoch0/cloud.las" "$file"
  python3 tools/shift_las.py "$file" $((320 * ($1 / 8))) $((320 * ($1 % 8))) $((3 * ($1 % 5)))
}

# A command's wall time [s], processor time [s] and peak [MB].
measure() {
  local times
  times=$(mktemp)
  /usr/bin/time -o "$times" -f '%e %U %S %M' "$@" > /dev/null
  tail -n 1 "$times" | awk '{ printf "%8.2f s %8.2f s of processors %8.0f MB\n", $1, $2 + $3, $4 / 1024 }'
  rm "$times"
}

row() { printf '%-34s %s\n' "$1" "$2"; }

simulate_streets
for ((i = 0; i < most; ++i)); do place_street "$i"; done

row "1 street in memory" "$(measure "$vdbmap" build "$work/survey/street_000.las" -o "$work/one.vdb")"
for ((count = 1; count <= most; count *= 4)); do
  city=$work/city_$count
  rm -rf "$city"
  files=("$work"/survey/street_*.las)
  row "$count streets as a city" "$(measure "$vdbmap" build "${files[@]:0:count}" -o "$city/" --memory "$memory")"
  row "  info" "$(measure "$vdbmap" info "$city")"
  at=$("$vdbmap" info "$city" --json | jq -r '.extent | [(.min[0]+.max[0])/2, (.min[1]+.max[1])/2, .min[2]] | join(",")')
  row "  query --at" "$(measure "$vdbmap" query "$city" --at "$at" || true)"
done

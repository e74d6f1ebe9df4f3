#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# tools/experiment.sh [SEED...]: repeats section 3 of Mortazavi et al. (2023) on simulated streets, seeds 1 to 5 unless
# others are given: the map from the mobile mapper's survey, then 101 VLP-16 scans of another day found in it with no first
# guess. Writes a table and a picture a street to assets/experiment/; everything else stays in build/experiment/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/packages.sh
seeds=("$@")
((${#seeds[@]} > 0)) || seeds=(1 2 3 4 5)
work=build/experiment
results=assets/experiment

vdbmap() { build/release/bin/vdbmap "$@"; }

run_street() {
  local street=$work/street$1
  vdbmap simulate "$street" --seed "$1" --ideal > /dev/null
  vdbmap build "$street/epoch0/cloud.las" -o "$street.vdb" > /dev/null
  # 1: not a single scan found, which the table then says.
  vdbmap localize "$street.vdb" "$street/epoch1/scans" -o "$street.txt" --report "$street.report.json" || (($? == 1))
  vdbmap evaluate "$street.txt" "$street/epoch1/poses.txt" --plot "$results/street$1.png" --json "$street.json"
}

# One row of the table: name, file of figures.
row() {
  jq -r --arg name "$1" 'def cm: . * 1000 | round / 10;
    [.poses[] | select(. != null)] as $found | [$found[].xy_m] as $xy |
    "| \($name) | \($found | length) of \(.num_poses) | \([$xy[] | select(. < 0.036)] | length) | \(.xy_m.median | cm) | " +
    "\(.xy_m.max | cm) | \(.z_m.median | cm) | \(.z_m.max | cm) |"' "$2"
}

write_table() {
  echo '| street | scans found | XY below 3.6 cm | XY median [cm] | XY maximum [cm] | Z median [cm] | Z maximum [cm] |'
  echo '|---|---|---|---|---|---|---|'
  echo '| the paper, Hannover | 101 of 101 | 88 | | 6.3 | mostly below 1 | 5 |'
  local seed
  for seed in "${seeds[@]}"; do row "simulated, seed $seed" "$work/street$seed.json"; done
}

install_missing "${build_packages[@]}" "${test_packages[@]}" jq
cmake --preset release
cmake --build --preset release --target vdbmap_command
mkdir -p "$work" "$results"
for seed in "${seeds[@]}"; do run_street "$seed"; done
write_table | tee "$results/table.md"

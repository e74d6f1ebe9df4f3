#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# tools/study.sh [SEED...]: the open questions of Mortazavi et al. (2023), section 5, on simulated streets, seeds 1 to 3
# unless others are given: size of the batches, levels of the map, fewer facades, other sensors, vehicles left out. Writes
# a table and a picture to assets/experiment/; everything else stays in build/study/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/packages.sh
seeds=("$@")
((${#seeds[@]} > 0)) || seeds=(1 2 3)

install_missing "${build_packages[@]}" "${test_packages[@]}" python3 python3-matplotlib python3-numpy
cmake --preset release
cmake --build --preset release --target vdbmap_command
mkdir -p assets/experiment
/usr/bin/python3 tools/study.py build/release/bin/vdbmap build/study assets/experiment "${seeds[@]}"

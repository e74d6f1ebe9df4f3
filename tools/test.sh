#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# tools/test.sh [PRESET]: installs the Debian and npm packages that are missing, builds vdbmap and runs its tests. PRESET of CMakePresets.json, by default
# release; results in build/PRESET/tests.xml and test_results/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/packages.sh

preset=${1:-release}
build=build/$preset

packages=("${build_packages[@]}" "${test_packages[@]}")
if [[ $preset == asan ]]; then packages+=("${sanitizer_packages[@]}"); fi
install_missing "${packages[@]}"
for folder in tests/exchange tests/web; do
  if [[ $folder/node_modules/.package-lock.json -nt $folder/package-lock.json ]]; then continue; fi # is installed
  npm ci --prefix $folder --ignore-scripts --no-audit --no-fund || echo "tests that need the packages of $folder will skip" # with CI=true that fails
done
cmake --preset "$preset"
cmake --build --preset "$preset"
rm -rf "$build/test_results" "$build/tests.xml"
ctest --preset "$preset" --parallel 2 --output-junit tests.xml || true
tools/count_tests.sh "$build"

#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs the Debian packages that are missing, builds vdbmap and runs its tests. Results: build/release/tests.xml.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/packages.sh

install_missing "${build_packages[@]}" "${test_packages[@]}"
cmake --preset release
cmake --build --preset release
ctest --preset release --parallel 2 --output-junit tests.xml

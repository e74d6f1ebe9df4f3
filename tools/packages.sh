# SPDX-License-Identifier: GPL-3.0-or-later
# The Debian 12 packages of the project, for the scripts beside this file to source.

build_packages=(
  cmake g++ ninja-build pkg-config
  libceres-dev libcgal-dev libcli11-dev libcpp-httplib-dev libeigen3-dev libembree-dev libjemalloc-dev libmeshoptimizer-dev libopenvdb-dev libpcap-dev libproj-dev libspdlog-dev libtbb-dev libxxhash-dev nlohmann-json3-dev
  # The coordinate systems that PROJ knows.
  proj-data
  # OpenVDB's find module wants these; libopenvdb-dev does not depend on them. Boost's headers make UUIDs too.
  libblosc-dev libboost-iostreams-dev zlib1g-dev
  # Pictures and their letters; the CMake config of OpenImageIO wants its tools too.
  fonts-dejavu-core libopenimageio-dev openimageio-tools
)
test_packages=(libgmock-dev libgtest-dev libpng-dev)
# For the page of the command web and what the tests compare ours with; other distributions of Node.js bring npm along.
command -v npm > /dev/null || test_packages+=(nodejs npm)
benchmark_packages=(jq libbenchmark-dev time)
# Slurm is for tools/cluster.sh.
ci_packages=(blender chromium clang-format python3-numpy python3-openvdb python3-torch slurm-client slurmctld slurmd)
# The compiler of the presets with sanitizers.
sanitizer_packages=(clang libclang-rt-14-dev)

is_installed() {
  [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null) == installed ]]
}

as_root() {
  if [[ $(id -u) == 0 ]]; then "$@"; else sudo "$@"; fi
}

# Installs packages whose daemons, of which we start our own, are not to be started now.
install_without_starting() {
  local policy=/usr/sbin/policy-rc.d is_ours=false status=0
  if [[ ! -e $policy ]]; then
    is_ours=true
    printf '#!/bin/sh\nexit 101\n' | as_root tee "$policy" > /dev/null
    as_root chmod +x "$policy"
  fi
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends "$@" || status=$?
  if $is_ours; then as_root rm "$policy"; fi
  return "$status"
}

# Installs those of the packages that are missing; touches nothing where all are there.
install_missing() {
  local package missing=()
  for package in "$@"; do
    is_installed "$package" || missing+=("$package")
  done
  if ((${#missing[@]} == 0)); then return; fi

  echo "installing: ${missing[*]}"
  as_root apt-get update
  install_without_starting "${missing[@]}"
}

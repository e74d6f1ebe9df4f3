#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# tools/fuzz.sh MINUTES [TARGET...]: installs what is missing, builds the fuzz targets of tests/fuzz and runs each, or those named, for so many
# minutes: 2 GB of memory, 10 s an input, no leaks but those of other libraries. Prints a line a target; what broke one lies in
# build/fuzz/findings, and the exit code is then 1. What broke OpenVDB's reader lies in build/fuzz/broken, for tests/fuzz/ask_command.sh.
set -euo pipefail
if (($# < 1)) || [[ ! $1 =~ ^[1-9][0-9]*$ ]]; then
  echo "usage: tools/fuzz.sh MINUTES [TARGET...]" >&2
  exit 2
fi
seconds=$(($1 * 60))
shift
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/packages.sh

build=build/fuzz
targets=("$@")
if ((${#targets[@]} == 0)); then
  for source in tests/fuzz/*_fuzz.cpp; do targets+=("$(basename "$source" _fuzz.cpp)"); done
fi
for target in "${targets[@]}"; do
  if [[ ! -f tests/fuzz/${target}_fuzz.cpp ]]; then
    echo "tools/fuzz.sh: no target '$target' in tests/fuzz" >&2
    exit 2
  fi
done

install_missing "${build_packages[@]}" "${test_packages[@]}" "${sanitizer_packages[@]}"
cmake --preset fuzz > /dev/null
cmake --build --preset fuzz
"$build/bin/fuzz_seeds" "$build/seeds"

has_finding=false
for target in "${targets[@]}"; do
  corpus=$build/corpus/$target findings=$build/findings/$target broken=$build/broken/$target log=$build/$target.log
  mkdir -p "$corpus" "$findings" "$broken"
  result=clean
  VDBMAP_KEEP_BROKEN=$broken ASAN_OPTIONS=allocator_may_return_null=0 LSAN_OPTIONS=suppressions=tests/leaks_of_others.txt:print_suppressions=0 \
    "$build/bin/${target}_fuzz" "$corpus" "$build/seeds/$target" -max_total_time="$seconds" -rss_limit_mb=2048 -timeout=10 \
    -artifact_prefix="$findings/" -print_final_stats=1 > "$log" 2>&1 || result="FINDING, see $log and $findings"
  [[ $result == clean ]] || has_finding=true
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  coverage=$(grep -o 'cov: [0-9]*' "$log" | tail -1)
  printf '%-12s %10s inputs, %s edges: %s\n' "$target" "${executions:-0}" "${coverage#cov: }" "$result"
done
[[ $has_finding == false ]]

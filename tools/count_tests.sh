#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# tools/count_tests.sh BUILD_FOLDER...: what became of the tests that CTest ran there (--output-junit tests.xml), as the line "N passed, N failed,
# N skipped"; fails where one failed or there were none. With CI=true a skip fails too, unless its reason stands in tests/may_skip.txt.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Rows "passed|failed|skipped NAME: REASON" of a result file of GoogleTest.
rows_of_program() {
  awk '
    function attribute(name,   text) {
      if (!match($0, " " name "=\"[^\"]*\"")) return ""
      text = substr($0, RSTART, RLENGTH)
      sub(/^[^"]*"/, "", text); sub(/"$/, "", text)
      return text
    }
    function flush() { if (name != "") print state, name ": " reason; name = "" }
    /<testcase / {
      flush()
      name = attribute("classname") "." attribute("name"); reason = ""
      state = attribute("status") == "run" ? (attribute("result") == "skipped" ? "skipped" : "passed") : "disabled"
    }
    /<failure/ { state = "failed" }
    /<skipped/ { reason = attribute("message") }
    END { flush() }' "$1"
}

# Rows of what CTest ran: a test program stands for the tests in its result file, or for one that failed where it left none.
rows_of_build() {
  local name status result
  awk '/<testcase / { match($0, /name="[^"]*"/); name = substr($0, RSTART + 6, RLENGTH - 7)
    match($0, /status="[^"]*"/); print name, substr($0, RSTART + 8, RLENGTH - 9) }' "$1/tests.xml" |
    while read -r name status; do
      result=$1/test_results/$name.xml
      if [[ -f $result ]]; then
        rows_of_program "$result"
        if [[ $status != run ]] && ! rows_of_program "$result" | grep -q ^failed; then
          echo "failed $name: ended with an error after its tests"
        fi
      elif [[ $status == run && $name != *_tests.[0-9] ]]; then
        echo "passed $name: "
      else
        echo "failed $name: no result"
      fi
    done
}

may_skip() {
  local reason
  while read -r reason; do
    reason=${reason%%#*}
    reason=${reason%"${reason##*[! ]}"}
    if [[ -n $reason && $1 == *"$reason"* ]]; then return; fi
  done < tests/may_skip.txt
  return 1
}

passed=0 failed=0 skipped=0
for build in "$@"; do
  if [[ ! -f $build/tests.xml ]]; then
    echo "$build: no results"
    failed=$((failed + 1))
    continue
  fi
  while read -r state text; do
    if [[ $state == skipped && ${CI:-} == true ]] && ! may_skip "$text"; then
      state=failed
      text+=" (no skip that tests/may_skip.txt knows)"
    fi
    case $state in
      passed) passed=$((passed + 1)) ;;
      skipped) skipped=$((skipped + 1)) ;;
      failed)
        failed=$((failed + 1))
        echo "failed in $build: $text"
        ;;
    esac
  done < <(rows_of_build "$build")
done
echo "$passed passed, $failed failed, $skipped skipped"
((failed == 0 && passed > 0))

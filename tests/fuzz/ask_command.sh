#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# tests/fuzz/ask_command.sh VDBMAP FOLDER: gives every file of a folder to `VDBMAP info` and `VDBMAP check`. Each must answer: exit code 0 or 1,
# or 3 with one line that names the file. Prints how often each came, and what is otherwise; the exit code is then 1.
set -uo pipefail
if (($# != 2)); then
  echo "usage: tests/fuzz/ask_command.sh VDBMAP FOLDER" >&2
  exit 2
fi
vdbmap=$1 folder=$2
declare -A times=()
is_wrong=false
for file in "$folder"/*; do
  for command in info check; do
    said=$(timeout 600 "$vdbmap" "$command" "$file" 2>&1 > /dev/null)
    code=$?
    times[$code]=$((${times[$code]:-0} + 1))
    if ((code == 0 || code == 1)); then continue; fi
    if ((code == 3)) && [[ $said == *"$file"* && $said != *$'\n'* ]]; then continue; fi
    is_wrong=true
    echo "$command $file: exit code $code: $said"
  done
done
for code in "${!times[@]}"; do echo "exit code $code: ${times[$code]} times"; done
[[ $is_wrong == false ]]

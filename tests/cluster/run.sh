#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# tests/cluster/run.sh VDBMAP FOLDER: builds a city on a Slurm cluster of three nodes while a node, tasks and the
# controller are killed, and compares it with that of `build`. FOLDER is made, and removed where all is well.
set -euo pipefail
vdbmap=$1
folder=$2
cluster=$(dirname "${BASH_SOURCE[0]}")/../../tools/cluster.sh
export SLURM_CONF=$folder/slurm/slurm.conf
"$cluster" stop "$folder/slurm" # of a run that was interrupted
rm -rf "$folder"
mkdir -p "$folder"/{survey,marks}

fail() {
  echo "cluster test: $*" >&2
  squeue >&2 || true
  tail -n 5 "$folder"/city.job/slurm/*.log >&2 || true
  exit 1
}

# Waits until a command succeeds.
wait_for() {
  for _ in {1..2000}; do
    if "$@" > /dev/null 2>&1; then return; fi
    sleep 0.1
  done
  fail "waited in vain: $*"
}

# Twelve stretches of a street of 30 m each, on ground and walls, one after the other.
make_survey() {
  local i
  for i in {0..11}; do
    awk -v seed="$i" 'BEGIN {
      srand(seed)
      for (n = 0; n < 200000; ++n) {
        x = 25 * seed + 30 * rand(); across = 20 * rand() - 10
        if (n % 3 == 0) print x, across < 0 ? -10 : 10, 12 * rand(); else print x, across, 0.02 * across
      }
    }' > "$folder/survey/$i.xyz"
  done
}

# Stands before the command on the nodes. The first task that maps stops in the middle of its work, until its node is
# killed; the second one, and the first that reduces, are killed in the middle; another that reduces waits for the
# controller to come back.
write_program() {
  cat > "$folder/vdbmap" << EOF
#!/bin/bash
marks=$folder/marks
echo "\$*" >> "\$marks/starts"
# Once it has worked for a twentieth of a second; a task that was done before leaves that to the next one.
in_the_middle() { # SIGNAL PLACE ARGUMENT...
  local signal=\$1 mark=\$marks/\$4.\$1 place=\$marks/\$2 stat status=0
  shift 2
  "$vdbmap" "\$@" &
  while kill -0 \$! 2> /dev/null; do
    if stat=(\$(cat "/proc/\$!/stat" 2> /dev/null)) && ((stat[13] + stat[14] >= 5)); then
      if kill "-\$signal" \$!; then echo "\$SLURMD_NODENAME" > "\$mark"; fi
      break
    fi
    sleep 0.005
  done
  wait \$! || status=\$?
  if ((status == 0)); then rm -rf "\$mark" "\$place"; fi
  return \$status
}
if [[ \$2 == map ]] && mkdir "\$marks/map.first" 2> /dev/null; then
  in_the_middle STOP map.first "\$@"
elif [[ \$2 == reduce ]] && mkdir "\$marks/reduce.first" 2> /dev/null; then
  in_the_middle KILL reduce.first "\$@"
elif [[ \$2 == map ]] && mkdir "\$marks/map.second" 2> /dev/null; then
  in_the_middle KILL map.second "\$@"
elif [[ \$2 == reduce ]] && mkdir "\$marks/reduce.second" 2> /dev/null; then
  until [[ -e \$marks/controller.back ]]; do sleep 0.1; done
  exec "$vdbmap" "\$@"
else
  exec "$vdbmap" "\$@"
fi
EOF
  chmod +x "$folder/vdbmap"
}

# A controller that was killed does not remember all that it started again.
was_done_again() { sort "$folder/marks/starts" | uniq -d | grep -q "^tile $1 "; }

make_survey
write_program
"$vdbmap" build "$folder/survey" -o "$folder/alone/" --quiet > /dev/null
"$vdbmap" tile plan "$folder/survey" -o "$folder/city/" --buckets 6 > /dev/null

"$cluster" start "$folder/slurm" > /dev/null
trap '"$cluster" stop "$folder/slurm"' EXIT
if ls -l "/proc/$(cat "$folder/slurm/n1.pid.ours")/fd" | grep -q "$folder/marks"; then fail "a node has our descriptors"; fi
"$vdbmap" tile submit "$folder/city.job" --slurm --memory 100M --task-size 5M --program "$folder/vdbmap" > /dev/null

wait_for test -s "$folder/marks/map.STOP"
node=$(cat "$folder/marks/map.STOP")
"$cluster" kill "$folder/slurm" "$node"
echo "killed node $node after $SECONDS s"

# What it has not saved yet, a controller forgets: then Slurm itself asks for a person.
wait_for test -d "$folder/marks/reduce.second"
wait_for test "$folder/slurm/state/job_state" -nt "$folder/marks/reduce.second"
"$cluster" kill "$folder/slurm" controller
echo "killed the controller after $SECONDS s"
"$cluster" revive "$folder/slurm" controller
wait_for scontrol ping
touch "$folder/marks/controller.back"

wait_for test -e "$folder/city/map.json"
echo "published after $SECONDS s"
for stage in map reduce; do
  [[ -e $folder/marks/$stage.KILL ]] || fail "no task of $stage was killed"
  was_done_again "$stage" || fail "nothing of $stage was done again"
done
[[ $("$vdbmap" tile status "$folder/city.job" --missing map) == "" ]] || fail "something is left to do"
diff -r --exclude=lock "$folder/alone" "$folder/city" || fail "the bytes are not those of one machine"
"$vdbmap" tile submit "$folder/city.job" --slurm | grep -q "nothing is left to do" || fail "a published job is submitted"
"$vdbmap" check "$folder/city"
"$cluster" stop "$folder/slurm"
is_gone() { ! pgrep -f -- "$folder/slurm/slurm.conf"; }
wait_for is_gone # the kernel ends what was on a node in its own time
rm -rf "$folder"

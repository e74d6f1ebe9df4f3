#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A real Slurm cluster on this machine alone, for tests: every node is a tree of processes of its own, and all of them
# talk over the loopback. No systemd, display, munge or cgroups are needed.
#
#   tools/cluster.sh start FOLDER [NODES]    starts a controller and NODES (3) nodes n1, n2, ... of one processor each;
#                                            commands of Slurm then find it by SLURM_CONF=FOLDER/slurm.conf
#   tools/cluster.sh kill FOLDER NAME        ends node NAME and all that runs on it at once, as a power cut would, or
#                                            the controller, whose NAME is controller
#   tools/cluster.sh revive FOLDER NAME      starts it again
#   tools/cluster.sh stop FOLDER             ends what was started, by its process numbers; logs stay in FOLDER/log
#
# Whoever reaches the ports may run jobs (auth/none): they are bound to 127.0.0.1.
set -euo pipefail

usage() {
  sed -n '/^#   tools/,/^#$/s/^#   //p' "${BASH_SOURCE[0]}" >&2
  exit 2
}

fail() {
  echo "cluster.sh: $*" >&2
  exit 1
}

# A run of free ports: one for the controller, one a node.
find_ports() {
  local base port is_free
  for _ in {1..50}; do
    base=$((20000 + RANDOM % 12000))
    is_free=true
    for ((port = base; port <= base + $1; ++port)); do
      if (exec 3<> "/dev/tcp/127.0.0.1/$port") 2> /dev/null; then is_free=false; fi
    done
    if $is_free; then
      echo "$base"
      return
    fi
  done
  fail "finds no free ports"
}

write_configuration() {
  local count=$1 user port i
  user=$(id -un)
  port=$(find_ports "$count")
  cat << EOF
ClusterName=local
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort=$port
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/none
CredType=cred/none
AuthInfo=cred_expire=5
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
StateSaveLocation=$folder/state
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd-%n.pid
SlurmdSpoolDir=$folder/spool-%n
SlurmctldLogFile=$folder/log/slurmctld.log
SlurmdLogFile=$folder/log/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,bf_interval=1,sched_min_interval=0
SlurmdParameters=config_overrides
ReturnToService=2
JobRequeue=1
SlurmdTimeout=3
MessageTimeout=2
SlurmctldTimeout=10
KillWait=2
MinJobAge=300
MaxArraySize=100001
MaxJobCount=100000
EOF
  for ((i = 1; i <= count; ++i)); do
    echo "NodeName=n$i NodeHostname=localhost NodeAddr=127.0.0.1 Port=$((port + i)) CPUs=1 RealMemory=16000"
  done
  echo "PartitionName=main Nodes=n[1-$count] Default=YES MaxTime=INFINITE State=UP"
}

# Runs a command in the background, with no descriptor of ours: it would hold our caller's locks and pipes.
start_detached() {
  local name=$1 descriptor
  shift
  (
    for descriptor in "/proc/$BASHPID/fd"/*; do
      descriptor=${descriptor##*/}
      if ((descriptor > 2)); then eval "exec $descriptor>&-"; fi
    done
    exec setsid "$@" < /dev/null > "$folder/log/$name.out" 2>&1
  ) &
  echo $! > "$folder/$name.pid.ours"
}

start_controller() { start_detached controller slurmctld -D -f "$configuration"; }

# In a namespace of its own, whose end is that of all processes in it; whoever is not root may have one as himself.
start_node() {
  local as_user=()
  if [[ $(id -u) != 0 ]]; then as_user=(--user --map-current-user); fi
  mkdir -p "$folder/spool-$1"
  start_detached "$1" unshare "${as_user[@]}" --pid --fork --mount-proc --kill-child \
    bash -c 'slurmd -D -N "$0" -f "$1"; sleep infinity' "$1" "$configuration"
}

start_part() {
  if [[ $1 == controller ]]; then start_controller; else start_node "$1"; fi
}

# By its number, where that is still a process of this cluster.
kill_part() {
  local pid file=$folder/$1.pid.ours
  [[ -e $file ]] || return 0
  pid=$(cat "$file")
  if tr '\0' ' ' < "/proc/$pid/cmdline" 2> /dev/null | grep -qF -- "$configuration"; then kill -KILL "$pid"; fi
  while tr '\0' ' ' < "/proc/$pid/cmdline" 2> /dev/null | grep -qF -- "$configuration"; do sleep 0.05; done
  rm -f "$file"
}

wait_until_idle() {
  for _ in {1..300}; do
    if [[ $(sinfo --noheader --Node --states=idle --format=%N 2> /dev/null | wc -l) == "$1" ]]; then return; fi
    sleep 0.1
  done
  fail "the nodes do not come up, see $folder/log"
}

start() {
  local count=$1 i program
  PATH=$PATH:/usr/sbin
  for program in slurmctld slurmd sbatch unshare; do
    command -v "$program" > /dev/null || fail "needs $program (Debian: slurmctld slurmd slurm-client util-linux)"
  done
  if compgen -G "$folder/*.pid.ours" > /dev/null; then fail "$folder: a cluster runs there already"; fi
  mkdir -p "$folder"/{state,log}
  write_configuration "$count" > "$configuration"
  start_controller
  for ((i = 1; i <= count; ++i)); do start_node "n$i"; done
  wait_until_idle "$count"
  echo "export SLURM_CONF=$configuration"
}

stop() {
  local file name
  for file in "$folder"/*.pid.ours; do
    [[ -e $file ]] || continue
    name=${file##*/}
    kill_part "${name%.pid.ours}"
  done
}

(($# >= 2 && $# <= 3)) || usage
folder=$(realpath --canonicalize-missing "$2")
configuration=$folder/slurm.conf
export SLURM_CONF=$configuration
PATH=$PATH:/usr/sbin
case $1 in
  start) start "${3:-3}" ;;
  kill) kill_part "${3:?the name of a node, or controller}" ;;
  revive) start_part "${3:?the name of a node, or controller}" ;;
  stop) stop ;;
  *) usage ;;
esac

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""compare.py BEFORE AFTER [DATA_FOLDER]: has anything become slower between two builds?

BEFORE and AFTER are the folders bin/ of two builds with VDBMAP_BUILD_BENCHMARKS=ON; DATA_FOLDER holds velodyne/ and poses.txt of a drive. In each of
seven rounds every benchmark, and every command on a simulated street, runs before, after and before again: what another program on the machine does
strikes all three alike. A row shows the median of after / before, and the spread of before / before: worse is only what lies beyond that. Ctrl-C
shows what has been measured so far.
"""

import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

ROUNDS = 7
BENCHMARKS = {
    "map_benchmark": "build_map/.*threads:2|build_from_scans/threads:2|load_cloud_map/street",
    "fine_benchmark": "align_scan/threads:2",
    "odometry_benchmark": "register_scan/threads:2",
    "coarse_benchmark": "^features/threads:2|find_batches/drive",
    "render_benchmark": "render_street/.*threads:2",
}


def run_benchmark(program, rows):
    """Times by name: one measurement of each row."""
    with tempfile.NamedTemporaryFile(suffix=".json") as result:
        command = [str(program), "--benchmark_filter=" + (rows or "."), "--benchmark_out=" + result.name, "--benchmark_out_format=json"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        benchmarks = json.load(open(result.name))["benchmarks"]
    times = {}
    for row in benchmarks:
        if row.get("run_type") == "iteration" and not row.get("error_occurred"):
            times.setdefault(row["run_name"], []).append(row["real_time"])
    return {name: statistics.median(values) for name, values in times.items()}


def commands_on(folder):
    """Whole commands on a simulated street in `folder`."""
    street, map_file = folder / "street", folder / "street.vdb"
    return {
        "vdbmap build": ["build", street / "epoch0/cloud.las", "-o", folder / "again.vdb"],
        "vdbmap info": ["info", map_file],
        "vdbmap render": ["render", map_file, "-o", folder / "street.png"],
        "vdbmap localize": ["localize", map_file, street / "epoch1/scans", "-o", folder / "street.txt"],
    }


def run_commands(programs, folder):
    times = {}
    for name, arguments in commands_on(folder).items():
        start = time.perf_counter()
        subprocess.run([str(programs / "vdbmap"), *map(str, arguments), "--quiet"], check=True, stdout=subprocess.DEVNULL)
        times[name] = time.perf_counter() - start
    return times


def measure(programs, folder):
    times = {}
    for program, rows in BENCHMARKS.items():
        for name, value in run_benchmark(programs / program, rows).items():
            times[program.removesuffix("_benchmark") + ": " + name.split("/iterations")[0].split("/min_time")[0]] = value
    times.update(run_commands(programs, folder))
    return times


def print_table(rounds):
    print(f"{'median of ' + str(len(rounds)) + ' rounds':52} {'after / before':>14}   before / before")
    for name in rounds[0][0]:
        ratios, spread = [], []
        for before, after, again in rounds:
            ratios.append(after[name] / (before[name] * again[name]) ** 0.5)
            spread.append(again[name] / before[name])
        ratio = statistics.median(ratios)
        verdict = "" if ratio <= max(spread) else "  SLOWER"
        print(f"{name:52} {ratio:14.3f}   {min(spread):.3f} to {max(spread):.3f}{verdict}")


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    before, after = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    if len(sys.argv) == 4:
        os.environ["VDBMAP_DRIVE"] = str(pathlib.Path(sys.argv[3]).resolve())
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for arguments in (["simulate", folder / "street", "--seed", "1"], ["build", folder / "street/epoch0/cloud.las", "-o", folder / "street.vdb"]):
            subprocess.run([str(before / "vdbmap"), *map(str, arguments), "--quiet"], check=True, stdout=subprocess.DEVNULL)
        rounds = []
        try:
            for number in range(ROUNDS):
                rounds.append([measure(programs, folder) for programs in (before, after, before)])
                print(f"round {number + 1} of {ROUNDS}", file=sys.stderr)
        except KeyboardInterrupt:
            print("stopped", file=sys.stderr)
    if rounds:
        print_table(rounds)


if __name__ == "__main__":
    main()

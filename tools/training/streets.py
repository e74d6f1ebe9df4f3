# SPDX-License-Identifier: GPL-3.0-or-later
"""Streets to learn from: `vdbmap simulate` with many seeds and scanners, several at once."""

import concurrent.futures
import json
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

from . import places

FIRST_SEED = 1001  # those of demo, experiment and tests lie below
SCANS = 20  # of each scanner in a street, twice as many in a quarter
SURVEY_STEP = 2  # of the mapper's points
QUARTERS = 0.3  # share of the places that are blocks with crossings, seen by the scanners alone


def random_lidar(choose):
    """A scanner with 16 to 128 beams."""
    beams = choose.choice([16, 16, 32, 32, 40, 64, 128])
    top, bottom = choose.uniform(1, 15), -choose.uniform(15, 31)
    bend = choose.uniform(0.7, 1.3)  # from 1 on denser below, before above
    return {
        "name": "random",
        "elevations_deg": [top + (bottom - top) * ((i + 0.5) / beams) ** bend for i in range(beams)],
        "rate": choose.choice([5, 10, 10, 20]),
        "firings": choose.choice([900, 1024, 1500, 1800, 2048]),
        "range": choose.uniform(50, 150),
        "noise": choose.uniform(0.004, 0.03),
        "height": choose.uniform(1.4, 2.4),
        "tilt_deg": choose.gauss(0, 1.5),
    }


def scanners(choose):
    """An HDL-64 of a real one's noise, and a VLP-16 or any other."""
    hdl64 = {"name": "hdl64", "model": "hdl64", "height": choose.uniform(1.55, 2.0), "tilt_deg": choose.gauss(0, 0.7)}
    hdl64["noise"] = choose.uniform(0.007, 0.025)
    vlp16 = {"name": "random", "model": "vlp16", "height": choose.uniform(1.4, 2.3), "tilt_deg": choose.gauss(0, 0.7)}
    return [hdl64, vlp16 if choose.random() < 0.45 else random_lidar(choose)]


def make_street(command, folder, seed):
    """Simulates a street and keeps what is learned from: FOLDER/SEED.npz, or None where that failed, which is said. A
    street that is there already stays."""
    path = pathlib.Path(folder) / f"{seed}.npz"
    if path.exists():
        return path
    choose = random.Random(seed)
    options = {
        "--seed": seed,
        "--epochs": 1,
        "--scans": SCANS,
        "--occupancy": round(choose.uniform(0.2, 0.95), 2),
        "--rain": round(choose.uniform(0, 8), 1) if choose.random() < 0.1 else 0,
        "--threads": 1,
    }
    sensors = scanners(choose)
    if choose.random() < QUARTERS:
        options |= {"--quarter": choose.choice(["1x1", "2x1"]), "--scans": 2 * SCANS}
    else:
        options["--length"] = round(choose.uniform(60, 130))
        sensors.append({"name": "mapper"})
    with tempfile.TemporaryDirectory(dir=folder) as work:
        sensor_file = pathlib.Path(work) / "sensors.json"
        sensor_file.write_text(json.dumps(sensors))
        street = pathlib.Path(work) / "street"
        arguments = [str(value) for option in options.items() for value in option]
        done = subprocess.run(
            [command, "simulate", street, *arguments, "--sensors", sensor_file, "--quiet"], stdout=subprocess.DEVNULL
        )
        if done.returncode != 0:
            print(f"no street of seed {seed}: {command} ended with {done.returncode}", file=sys.stderr, flush=True)
            return None
        places.of_street(street, SURVEY_STEP).save(path)
        shutil.rmtree(street)
    return path


def make_streets(command, folder, seeds, workers):
    """Paths of the streets of all seeds, in their order, without those that failed; `workers` are simulated at once."""
    pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        paths = pool.map(lambda seed: make_street(command, folder, seed), seeds)
        return [path for path in paths if path]

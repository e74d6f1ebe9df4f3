#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How often parking spaces of simulated streets are called what they are.

occupancy_accuracy.py VDBMAP FOLDER SEED...: simulates each street (with its two epochs) in FOLDER, unless it is there,
maps and segments the survey, finds the scans of the later drive in the map, and asks `vdbmap occupancy` for the state
of the spaces: the city's own (the simulator's outlines) and those that `vdbmap spaces` makes of the survey's vehicles.

A space counts as observed where the drive could see 60 % or more of it by the truth. Spaces that something else than a
vehicle blocks (skips, stacks of pallets) are counted apart: the truth calls them vacant.
"""

import json
import math
import pathlib
import subprocess
import sys

OBSERVED = 0.6


def run(program, *arguments):
    result = subprocess.run([program, *map(str, arguments), "--quiet"], capture_output=True, text=True)
    if result.returncode not in (0, 1):
        sys.exit(f"vdbmap {' '.join(map(str, arguments))}: {result.stderr}")


def prepare(program, folder, seed):
    """Street, map with classes and poses of a seed; what is there is used again."""
    street, place = folder / f"street{seed}", lambda name: folder / f"{name}{seed}"
    if not street.exists():
        run(program, "simulate", street, "--seed", seed)
    labelled, poses = place("labelled").with_suffix(".vdb"), place("poses").with_suffix(".txt")
    if not labelled.exists():
        built = place("map").with_suffix(".vdb")
        run(program, "build", street / "epoch0/cloud.las", "-o", built)
        run(program, "localize", built, street / "epoch1/scans", "-o", poses)
        run(program, "segment", built, "-o", labelled)
    return street, labelled, poses


def states_of(program, labelled, spaces, street, poses, *options):
    output = labelled.with_name("occupancy.json")
    run(program, "occupancy", labelled, spaces, street / "epoch1/scans", "--poses", poses, "-o", output, *options)
    return {space["id"]: space for space in json.loads(output.read_text())["spaces"]}


def truth_of(street):
    truth = {}
    for feature in json.loads((street / "spaces.geojson").read_text())["features"]:
        properties = feature["properties"]
        ring = feature["geometry"]["coordinates"][0][:4]
        truth[str(properties["id"])] = {
            "state": properties["states"][1],
            "is_blocked": properties["blocked_by"][1] is not None,
            "share": properties["visibility"][1]["share"],
            "middle": [sum(corner[axis] for corner in ring) / 4 for axis in (0, 1)],
        }
    return truth


class Count:
    """Answers beside the truth."""

    def __init__(self):
        self.observed = self.right = self.taken_called_vacant = self.vacant_called_taken = self.unknown = 0
        self.hidden = self.hidden_unknown = self.hidden_wrong = self.blocked = self.hidden_taken_called_vacant = 0

    def add(self, truth, state):
        is_wrong = state not in (truth["state"], "unknown")
        if truth["is_blocked"]:
            self.blocked += 1
        elif truth["share"] < OBSERVED:
            self.hidden += 1
            self.hidden_unknown += state == "unknown"
            self.hidden_wrong += is_wrong
            self.hidden_taken_called_vacant += is_wrong and state == "vacant"
        else:
            self.observed += 1
            self.right += state == truth["state"]
            self.unknown += state == "unknown"
            self.taken_called_vacant += is_wrong and state == "vacant"
            self.vacant_called_taken += is_wrong and state == "occupied"

    def line(self, name):
        share = 100 * self.right / self.observed if self.observed else math.nan
        return (
            f"{name:<22} {self.observed:8} {self.right:6} {share:7.1f} {self.taken_called_vacant:12} "
            f"{self.vacant_called_taken:12} {self.unknown:8} {self.hidden:7} {self.hidden_unknown:8} "
            f"{self.hidden_taken_called_vacant:12} {self.blocked:8}"
        )


def nearest_truth(truth, space, anchor_of):
    """The true space in which the middle of a space that was found lies, within 1.5 m."""
    x, y = anchor_of[space]
    best = min(truth, key=lambda i: math.hypot(truth[i]["middle"][0] - x, truth[i]["middle"][1] - y))
    return best if math.hypot(truth[best]["middle"][0] - x, truth[best]["middle"][1] - y) < 1.5 else None


def main(program, folder, seeds):
    folder = pathlib.Path(folder)
    folder.mkdir(exist_ok=True)
    print(
        f"{'':<22} {'observed':>8} {'right':>6} {'%':>7} {'taken->free':>12} {'free->taken':>12} {'unknown':>8} "
        f"{'hidden':>7} {'unknown':>8} {'taken->free':>12} {'blocked':>8}"
    )
    totals = {"city's, by rays": Count(), "city's, as paper": Count(), "own, by rays": Count()}
    confidences = []
    for seed in seeds:
        street, labelled, poses = prepare(program, folder, seed)
        truth = truth_of(street)
        counts = {name: Count() for name in totals}
        city = street / "spaces.geojson"
        for name, options in (("city's, by rays", []), ("city's, as paper", ["--as-paper"])):
            for number, space in states_of(program, labelled, city, street, poses, *options).items():
                for count in (counts[name], totals[name]):
                    count.add(truth[number], space["state"])
                if not options and space["state"] != "unknown" and not truth[number]["is_blocked"]:
                    confidences.append((space["confidence"], space["state"] == truth[number]["state"]))
        own = labelled.with_name("own.geojson")
        run(program, "spaces", labelled, "-o", own, "--map-coordinates")
        middles = {}
        for feature in json.loads(own.read_text())["features"]:
            ring = feature["geometry"]["coordinates"][0][:4]
            middles[feature["properties"]["id"]] = [sum(corner[axis] for corner in ring) / 4 for axis in (0, 1)]
        num_placed = 0
        for number, space in states_of(program, labelled, own, street, poses).items():
            place = None if space["candidate"] else nearest_truth(truth, number, middles)
            if place is None:
                continue
            num_placed += 1
            for count in (counts["own, by rays"], totals["own, by rays"]):
                count.add(truth[place], space["state"])
        for name, count in counts.items():
            print(f"{count.line(f'{seed} {name}')}", flush=True)
        print(f"{seed} own: {num_placed} of {sum(1 for i in middles)} found, candidates included, are true ones", flush=True)
    for name, count in totals.items():
        print(count.line("all " + name))
    for low, high in ((0, 0.8), (0.8, 0.95), (0.95, 1.01)):
        inside = [is_right for confidence, is_right in confidences if low <= confidence < high]
        if inside:
            print(f"confidence {low:.2f} to {min(high, 1):.2f}: {sum(inside)} of {len(inside)} right")


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], [int(seed) for seed in sys.argv[3:]])

# SPDX-License-Identifier: GPL-3.0-or-later
"""study.py VDBMAP WORK RESULTS SEED...: see study.sh. One thing is varied at a time; all else is as by default."""

import json
import pathlib
import statistics
import subprocess
import sys
import time
from dataclasses import dataclass, field

import matplotlib
import numpy

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

CAR, BUILDING = 10, 50  # classes of the .label files
LAS_OFFSET_TO_POINTS, LAS_RECORD_LENGTH, LAS_NUM_POINTS = 96, 105, 107  # [byte] in the header of LAS 1.2
WRONG = 0.5  # [m] a pose that is off by more in XY was found in the wrong place


@dataclass
class Variant:
    question: str
    name: str
    build: list = field(default_factory=list)
    localize: list = field(default_factory=list)
    scans: str = "scans"
    without_in_map: str = ""  # kinds of points: "cars", "half of the houses", "houses"
    without_in_scans: str = ""
    rings: int = 1  # each how many of the rings is kept


@dataclass
class Result:
    seed: str
    errors: list  # [m] XY of the scans found
    heights: list  # [m] Z of the scans found
    num_scans: int
    seconds: float  # localize as a whole


USUAL = "as usual"
VARIANTS = [
    Variant("", USUAL),
    *(Variant("scans a batch", str(n), localize=["--batch", str(n)]) for n in (5, 10, 50, 101)),
    *(Variant("levels [m]", levels, build=["--levels", levels]) for levels in ("0.05,1", "0.2,1", "0.1,0.5", "0.1,2")),
    Variant("facades", "half of the houses gone", without_in_map="half of the houses", without_in_scans="half of the houses"),
    Variant("facades", "all houses gone", without_in_map="houses", without_in_scans="houses"),
    Variant("sensor", "VLP-16, every second ring", rings=2),
    Variant("sensor", "VLP-16, every fourth ring", rings=4),
    Variant("sensor", "HDL-64", scans="scans_hdl64"),
    Variant("vehicles", "left out of the map", without_in_map="cars"),
    Variant("vehicles", "left out of map and scans", without_in_map="cars", without_in_scans="cars"),
]
USUAL_NAMES = {
    "scans a batch": "20 (as usual)",
    "levels [m]": "0.1,1 (as usual)",
    "facades": "all (as usual)",
    "sensor": "VLP-16 (as usual)",
    "vehicles": "parked cars of each day (as usual)",
}


def stays(labels, kind):
    """Which points are kept without those of a kind; labels: class in the low 16 bits, object in the high ones."""
    classes, objects = labels & 0xFFFF, labels >> 16
    if kind == "cars":
        return classes != CAR
    if kind == "houses":
        return classes != BUILDING
    if kind == "half of the houses":
        return (classes != BUILDING) | (objects % 2 == 0)
    return numpy.ones(len(labels), dtype=bool)


def filter_las(source, target, keep):
    data = source.read_bytes()
    start = int.from_bytes(data[LAS_OFFSET_TO_POINTS : LAS_OFFSET_TO_POINTS + 4], "little")
    length = int.from_bytes(data[LAS_RECORD_LENGTH : LAS_RECORD_LENGTH + 2], "little")
    records = numpy.frombuffer(data, dtype=numpy.dtype((numpy.void, length)), offset=start, count=len(keep))
    header = bytearray(data[:start])
    header[LAS_NUM_POINTS : LAS_NUM_POINTS + 4] = int(keep.sum()).to_bytes(4, "little")
    header[LAS_NUM_POINTS + 4 : LAS_NUM_POINTS + 8] = header[LAS_NUM_POINTS : LAS_NUM_POINTS + 4]  # all first returns
    target.write_bytes(bytes(header) + records[keep].tobytes())


def filter_pcd(source, target, keep_of):
    """keep_of(rings) tells which points stay."""
    data = source.read_bytes()
    end = data.index(b"DATA binary\n") + len(b"DATA binary\n")
    lines = {line.split()[0]: line.split()[1:] for line in data[:end].decode().splitlines() if not line.startswith("#")}
    kinds = {"F": "f", "U": "u", "I": "i"}
    fields = [(name, "<" + kinds[kind] + size) for name, kind, size in zip(lines["FIELDS"], lines["TYPE"], lines["SIZE"])]
    points = numpy.frombuffer(data, dtype=fields, offset=end)
    kept = points[keep_of(points["ring"])]
    header = data[:end].decode().replace(f"WIDTH {len(points)}", f"WIDTH {len(kept)}")
    header = header.replace(f"POINTS {len(points)}", f"POINTS {len(kept)}")
    target.write_bytes(header.encode() + kept.tobytes())


class Street:
    def __init__(self, vdbmap, folder, seed):
        self.vdbmap, self.folder, self.seed = vdbmap, folder, seed
        if not (folder / "street.json").exists():
            sensors = "mapper@0,vlp16@1,hdl64@1"
            self.call("simulate", folder, "--seed", seed, "--ideal", "--sensors", sensors)
        self.made = folder.parent / f"{folder.name}_made"
        self.made.mkdir(exist_ok=True)

    def call(self, *arguments, may_find_none=False):
        done = subprocess.run([self.vdbmap, *map(str, arguments), "--quiet"], stdout=subprocess.DEVNULL)
        if done.returncode != 0 and not (may_find_none and done.returncode == 1):
            sys.exit(f"vdbmap {arguments[0]} failed on {self.folder}")

    def cloud(self, without):
        source = self.folder / "epoch0" / "cloud.las"
        if not without:
            return source
        target = self.made / f"cloud without {without}.las"
        labels = numpy.fromfile(self.folder / "epoch0" / "labels" / "cloud.label", dtype="<u4")
        filter_las(source, target, stays(labels, without))
        return target

    def scans(self, variant):
        source = self.folder / "epoch1" / variant.scans
        if not variant.without_in_scans and variant.rings == 1:
            return source
        target = self.made / f"scans {variant.name}"
        target.mkdir(exist_ok=True)
        for scan in sorted(source.glob("*.pcd")):
            label_file = self.folder / "epoch1" / "labels" / variant.scans / f"{scan.stem}.label"
            keep = stays(numpy.fromfile(label_file, dtype="<u4"), variant.without_in_scans)
            filter_pcd(scan, target / scan.name, lambda rings: keep & (rings % variant.rings == 0))
        return target

    def run(self, variant):
        world_map, poses, figures = (self.made / name for name in ("map.vdb", "poses.txt", "figures.json"))
        self.call("build", self.cloud(variant.without_in_map), *variant.build, "-o", world_map)
        scans = self.scans(variant)
        start = time.perf_counter()
        self.call("localize", world_map, scans, *variant.localize, "-o", poses, may_find_none=True)
        seconds = time.perf_counter() - start
        truth = self.folder / "epoch1" / ("poses.txt" if variant.scans == "scans" else "poses_hdl64.txt")
        self.call("evaluate", poses, truth, "--json", figures, may_find_none=True)
        judged = json.loads(figures.read_text())["poses"]
        found = [pose for pose in judged if pose is not None]
        result = Result(self.seed, [p["xy_m"] for p in found], [p["z_m"] for p in found], len(judged), seconds)
        print(f"{variant.question} {variant.name}, seed {self.seed}: {len(found)} of {len(judged)}, {seconds:.1f} s", flush=True)
        return result


def centimetres(values, of=max):
    return f"{100 * of(values):.1f}" if values else ""


def row(question, name, results):
    errors = [error for result in results for error in result.errors]
    heights = [height for result in results for height in result.heights]
    cells = [
        question,
        name,
        f"{len(errors)} of {sum(result.num_scans for result in results)}",
        sum(error > WRONG for error in errors),
        centimetres(errors, statistics.median),
        centimetres(errors),
        centimetres(heights),
        f"{1000 * statistics.median(result.seconds / result.num_scans for result in results):.0f}",
    ]
    return "| " + " | ".join(map(str, cells)) + " |"


def rows_of(results):
    """(question, name, results), each question with the usual way first."""
    for question, usual in USUAL_NAMES.items():
        yield question, usual, results[("", USUAL)]
        for variant in VARIANTS:
            if variant.question == question:
                yield question, variant.name, results[(question, variant.name)]


def table(results):
    lines = [
        "| question | varied | scans found | wrong | XY median [cm] | XY maximum [cm] | Z maximum [cm] | time a scan [ms] |",
        "|---|---|---|---|---|---|---|---|",
    ]
    return "\n".join(lines + [row(*cells) for cells in rows_of(results)]) + "\n"


def draw(results, path):
    rows = list(rows_of(results))[::-1]
    positions, position, previous = [], 0.0, rows[0][0]
    for question, _, _ in rows:
        position += 1.0 if question == previous else 1.8
        previous = question
        positions.append(position)
    figure, (error_axis, share_axis, time_axis) = pyplot.subplots(
        1, 3, figsize=(14, 9), sharey=True, gridspec_kw={"width_ratios": [3, 1, 1]}, layout="constrained"
    )
    for (_, name, of_streets), y in zip(rows, positions):
        color = "#2b6cb0" if "as usual" in name else "#d9822b"
        errors = [100 * e for r in of_streets for e in r.errors if e <= WRONG]
        if errors:
            box = error_axis.boxplot(errors, positions=[y], vert=False, widths=0.6, whis=(0, 100), patch_artist=True)
            box["boxes"][0].set(facecolor=color, edgecolor=color, alpha=0.6)
            box["medians"][0].set(color="black")
        num_scans = sum(r.num_scans for r in of_streets)
        share_axis.barh(y, 100 * sum(len(r.errors) for r in of_streets) / num_scans, color=color, height=0.6)
        time_axis.barh(y, 1000 * statistics.median(r.seconds / r.num_scans for r in of_streets), color=color, height=0.6)
    error_axis.set_yticks(positions, [name for _, name, _ in rows])
    for question in USUAL_NAMES:
        top = max(y for (q, _, _), y in zip(rows, positions) if q == question)
        error_axis.text(0.02, top + 0.45, question, transform=error_axis.get_yaxis_transform(), weight="bold", va="bottom")
    error_axis.set_ylim(0.3, positions[-1] + 1.2)
    error_axis.set_xlim(left=0)
    error_axis.set_xlabel("error in XY [cm]: range, quartiles, median")
    share_axis.set_xlabel("scans found [%]")
    time_axis.set_xlabel("time a scan [ms]")
    for axis in (error_axis, share_axis, time_axis):
        axis.grid(axis="x", alpha=0.3)
        axis.spines[["top", "right"]].set_visible(False)
    figure.savefig(path, dpi=100)


def main():
    vdbmap, work, results_folder = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    work.mkdir(parents=True, exist_ok=True)
    streets = [Street(vdbmap, work / f"street{seed}", seed) for seed in sys.argv[4:]]
    results = {(v.question, v.name): [street.run(v) for street in streets] for v in VARIANTS}
    (results_folder / "study.md").write_text(table(results))
    draw(results, results_folder / "study.png")
    print(table(results), end="")


if __name__ == "__main__":
    main()

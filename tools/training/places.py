# SPDX-License-Identifier: GPL-3.0-or-later
"""Labelled scans of one place, in one frame: made of a simulated street, or of a folder laid out like SemanticKITTI's."""

import pathlib
from dataclasses import dataclass

import numpy

from . import classes

SURVEY = 0  # the cloud of a mobile mapper; turning scanners are 1, 2, ...

PCD_TYPES = {("F", 4): "<f4", ("F", 8): "<f8", ("U", 1): "u1", ("U", 2): "<u2", ("U", 4): "<u4", ("I", 4): "<i4"}
LAS_OFFSET_TO_POINTS, LAS_RECORD_LENGTH, LAS_NUM_POINTS, LAS_SCALES = 96, 105, 107, 131  # [byte] in the header of 1.2


class PlaceError(Exception):
    """What is wrong with which file."""


@dataclass
class Place:
    positions: object  # n x 3, float32 [m]
    labels: object  # n, uint8: classes.NAMES, or UNKNOWN
    rings: object  # n, uint8
    starts: object  # number of the first point of each scan, and n at the end
    sensors: object  # which sensor took each scan
    origins: object  # m x 3, float32 [m]: where the scanner was

    FIELDS = ("positions", "labels", "rings", "starts", "sensors", "origins")

    def save(self, path):
        """A reader sees the whole file or none."""
        unfinished = pathlib.Path(str(path) + ".unfinished")
        with open(unfinished, "wb") as file:
            numpy.savez(file, **{name: getattr(self, name) for name in self.FIELDS})
        unfinished.rename(path)

    @classmethod
    def load(cls, path):
        with numpy.load(path) as file:
            return cls(*(file[name] for name in cls.FIELDS))


def read_pcd(path):
    """Binary .pcd of single numbers, as the simulator writes it: a structured array."""
    data = path.read_bytes()
    end = data.find(b"DATA binary\n")
    if end < 0:
        raise PlaceError(f"{path}: is no binary .pcd")
    header = dict(line.split(maxsplit=1) for line in data[:end].decode().splitlines() if not line.startswith("#"))
    kinds = zip(header["TYPE"].split(), map(int, header["SIZE"].split()))
    types = numpy.dtype(list(zip(header["FIELDS"].split(), (PCD_TYPES[kind] for kind in kinds))))
    return numpy.frombuffer(data, types, int(header["POINTS"]), end + len(b"DATA binary\n"))


def read_las(path):
    """Positions of a LAS 1.2 file: n x 3, float64."""
    data = path.read_bytes()
    offset, length, number = (
        int(numpy.frombuffer(data, kind, 1, at)[0])
        for kind, at in (("<u4", LAS_OFFSET_TO_POINTS), ("<u2", LAS_RECORD_LENGTH), ("<u4", LAS_NUM_POINTS))
    )
    scale, shift = numpy.frombuffer(data, "<f8", 6, LAS_SCALES).reshape(2, 3)
    records = numpy.frombuffer(data, "u1", number * length, offset).reshape(number, length)
    return records[:, :12].copy().view("<i4") * scale + shift


def read_labels(path, number):
    labels = numpy.fromfile(path, "<u4")
    if len(labels) != number:
        raise PlaceError(f"{path}: {len(labels)} labels for {number} points")
    return classes.table().numpy()[labels & 0xFFFF]


def read_poses(path):
    """KITTI's: one row-major 3x4 matrix a line."""
    return numpy.loadtxt(path, ndmin=2).reshape(-1, 3, 4)


def rotation_of(x, y, z, w):
    return numpy.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def deskewed(points, times, poses):
    """Points of one turn in the frame of the poses: n x 3. Each was measured at its own time; poses (time, x, y, z and
    quaternion a row) are those of the first points of all turns. Rotation is taken to be even, and small in a turn."""
    index = numpy.clip(numpy.searchsorted(poses[:, 0], times[0], "right") - 1, 0, len(poses) - 2)
    before, after = poses[index], poses[index + 1]
    share = ((times - before[0]) / (after[0] - before[0]))[:, None]
    first, second = points @ rotation_of(*before[4:]).T, points @ rotation_of(*after[4:]).T
    return before[1:4] + share * (after[1:4] - before[1:4]) + first + share * (second - first)


def of_street(folder, survey_step=1):
    """The first epoch of a street that `vdbmap simulate` wrote: the mapper's cloud, every so manieth point of it, and the
    scans of all scanners."""
    epoch = pathlib.Path(folder) / "epoch0"
    positions, labels, rings, sensors, origins = [], [], [], [], []
    if (epoch / "cloud.las").exists():
        cloud = read_las(epoch / "cloud.las")
        positions.append(cloud[::survey_step])
        labels.append(read_labels(epoch / "labels" / "cloud.label", len(cloud))[::survey_step])
        rings.append(numpy.zeros(len(positions[-1]), numpy.uint8))
        sensors.append(SURVEY)
        origins.append(positions[-1].mean(0))
    for sensor, scans in enumerate(sorted(epoch.glob("scans*")), 1):
        poses = numpy.loadtxt(epoch / (scans.name.replace("scans", "poses") + ".tum"), ndmin=2)
        for index, path in enumerate(sorted(scans.glob("*.pcd"))):
            scan = read_pcd(path)
            points = numpy.stack([scan["x"], scan["y"], scan["z"]], 1)
            positions.append(deskewed(points, scan["time"], poses))
            labels.append(read_labels(epoch / "labels" / scans.name / (path.stem + ".label"), len(scan)))
            rings.append(scan["ring"].astype(numpy.uint8))
            sensors.append(sensor)
            origins.append(poses[index, 1:4])
    return joined(positions, labels, rings, sensors, origins)


def of_sequence(folder):
    """A sequence laid out like SemanticKITTI's: velodyne/*.bin, labels/*.label, poses.txt (scans to one frame)."""
    folder = pathlib.Path(folder)
    paths, poses = sorted((folder / "velodyne").glob("*.bin")), read_poses(folder / "poses.txt")
    if not paths or len(poses) != len(paths):
        raise PlaceError(f"{folder}: {len(paths)} scans in velodyne/ and {len(poses)} poses in poses.txt")
    positions, labels, rings = [], [], []
    for path, pose in zip(paths, poses):
        points = numpy.fromfile(path, "<f4").reshape(-1, 4)[:, :3]
        positions.append(points @ pose[:, :3].T + pose[:, 3])
        labels.append(read_labels(folder / "labels" / (path.stem + ".label"), len(points)))
        rings.append(numpy.zeros(len(points), numpy.uint8))
    return joined(positions, labels, rings, [1] * len(paths), list(poses[:, :, 3]))


def joined(positions, labels, rings, sensors, origins):
    middle = numpy.round(numpy.mean(origins, 0))
    return Place(
        numpy.concatenate([p - middle for p in positions]).astype(numpy.float32),
        numpy.concatenate(labels),
        numpy.concatenate(rings),
        numpy.cumsum([0] + [len(p) for p in positions]),
        numpy.array(sensors),
        (numpy.array(origins) - middle).astype(numpy.float32),
    )

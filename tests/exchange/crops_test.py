#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""crops_test.py: what the crops of tools/training hold, of a plane with walls that a scanner of 64 rings and one of 16 saw.
Exit code 77 without PyTorch."""

import pathlib
import sys
import unittest

try:
    import torch
except ImportError:
    sys.exit(77)
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
from tools.training import classes, crops, places  # noqa: E402

HEIGHT = 1.7  # [m] of the scanners


def scan(num_rings, origin):
    """Rays to the ground, and to a wall 20 m away around the scanner where they do not meet it nearer."""
    rings, angles = numpy.meshgrid(numpy.arange(num_rings), numpy.radians(numpy.arange(0, 360, 0.4)), indexing="ij")
    down = numpy.radians(-25 + 30 * rings / (num_rings - 1))
    directions = numpy.stack([numpy.cos(down) * numpy.cos(angles), numpy.cos(down) * numpy.sin(angles), numpy.sin(down)], -1)
    to_ground = numpy.where(down < 0, HEIGHT / numpy.maximum(-numpy.sin(down), 1e-9), numpy.inf)
    to_wall = 20 / numpy.cos(down)
    ranges = numpy.minimum(to_ground, to_wall)
    labels = numpy.where(to_ground < to_wall, classes.GROUND, classes.BUILDING)
    points = directions.reshape(-1, 3) * ranges.reshape(-1, 1) + origin
    return points, labels.ravel().astype(numpy.uint8), rings.ravel().astype(numpy.uint8)


def place():
    origins = [numpy.array([x, 0, HEIGHT]) for x in (0.0, 1.0, 2.0)]
    sensors = [1, 1, 1, 2, 2, 2]
    parts = [scan(64 if sensor == 1 else 16, origin) for sensor, origin in zip(sensors, origins * 2)]
    return places.joined([p[0] for p in parts], [p[1] for p in parts], [p[2] for p in parts], sensors, origins * 2)


class Crops(unittest.TestCase):
    def setUp(self):
        self.scene = crops.Scene(place())

    def some(self, seed, count=40):
        source = crops.Crops([self.scene], seed)
        return [crop for crop in (source.crop() for _ in range(count)) if crop is not None]

    def test_the_same_seed_gives_the_same_crops(self):
        for a, b in zip(self.some(5, 12), self.some(5, 12)):
            self.assertTrue(torch.equal(a.cells, b.cells) and torch.equal(a.features, b.features))

    def test_crops_are_neither_tiny_nor_huge_and_some_are_wide(self):
        found = self.some(1)
        self.assertGreater(len(found), 30)
        for crop in found:
            self.assertTrue(crops.FEWEST <= len(crop) <= crops.LARGEST_CROP)
        widest = max(float((c.means.max(0).values - c.means.min(0).values)[:2].max()) for c in found)
        self.assertGreater(widest, 35)  # most of the 40 m between the walls

    def test_wide_crops_are_of_one_sparse_scan(self):
        source = crops.Crops([self.scene], 1)
        for sensor in (1, 2):
            for _ in range(10):
                scans, step, _, _ = source._sparse_scan(self.scene, sensor)
                self.assertEqual(len(scans), 1)
                self.assertLessEqual(self.scene.num_rings[sensor] / step, crops.SPARSE)

    # What a beam's bias does: every point stays on its ray, those of a ring move by the same.
    def test_biases_move_points_along_their_rays(self):
        source, moved = crops.Crops([self.scene], 3), 0
        part = self.scene.points_of(0)
        away = self.scene.positions[part] - self.scene.origins[0]
        for _ in range(12):
            points, labels = source._part(self.scene, [0], 1, 1, False, torch.zeros(2), 100)
            self.assertTrue(torch.equal(labels, self.scene.labels[part]))
            biases = (points - self.scene.origins[0]).norm(dim=1) - away.norm(dim=1)
            aside = torch.linalg.cross(points - self.scene.origins[0], away / away.norm(dim=1, keepdim=True), dim=1).norm(dim=1)
            self.assertLess(float(aside.max()), 1e-4)
            for ring in (0, 20, 63):
                of_ring = biases[self.scene.rings[part] == ring]
                self.assertLess(float(of_ring.max() - of_ring.min()), 1e-4)
            self.assertLess(float(biases.abs().max()), 5 * crops.RING_BIAS)
            moved += float(biases.abs().max()) > 1e-3
        self.assertTrue(0 < moved < 12)


unittest.main()

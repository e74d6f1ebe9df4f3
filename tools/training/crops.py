# SPDX-License-Identifier: GPL-3.0-or-later
"""Crops of places, varied so that nothing of one scanner, one street or one day is learned by heart."""

import math
import random

import torch
import torch.nn.functional as functional

from . import classes, places, voxels

LARGEST_CROP = 140_000  # [voxels]
FEWEST = 40  # voxels of a crop: what a scanner of 16 beams has of a place 30 m away
WIDE = 0.2  # share of the crops that are most of one sparse scan, as those are labelled
SPARSE = 32  # rings at most of a sparse scan
RING_BIAS = 0.025  # [m] spread of the beams' ranges, at most
RARE = (classes.POLE, classes.PERSON, classes.OTHER)


class Scene:
    """A place on a device."""

    def __init__(self, place, device="cpu"):
        self.positions, self.labels, self.rings = (
            torch.from_numpy(array).to(device) for array in (place.positions, place.labels, place.rings)
        )
        self.origins = torch.from_numpy(place.origins).to(device)
        self.starts = place.starts.tolist()
        self.scans = {s: [i for i, t in enumerate(place.sensors) if t == s] for s in sorted(set(place.sensors.tolist()))}
        self.num_rings = {
            s: int(place.rings[self.starts[scans[0]] : self.starts[scans[0] + 1]].max()) + 1 for s, scans in self.scans.items()
        }

    def points_of(self, scan):
        return slice(self.starts[scan], self.starts[scan + 1])

    def cloud(self, scans, ring_step=1):
        """Points and labels of scans, every so manieth ring of them."""
        index = torch.cat([torch.arange(self.starts[s], self.starts[s + 1], device=self.positions.device) for s in scans])
        if ring_step > 1:
            index = index[self.rings[index] % ring_step == 0]
        return self.positions[index], self.labels[index]


def rotation(angle, device):
    c, s = math.cos(angle), math.sin(angle)
    return torch.tensor([[c, -s, 0], [s, c, 0], [0, 0, 1]], device=device)


class Batches(torch.utils.data.IterableDataset):
    """An endless stream of batches of some `num_voxels` each; every process that loads has a stream of its own."""

    def __init__(self, scenes, num_voxels, seed):
        self.scenes, self.num_voxels, self.seed = scenes, num_voxels, seed

    def __iter__(self):
        loader = torch.utils.data.get_worker_info()
        if loader:
            torch.set_num_threads(1)
        crops = Crops(self.scenes, 1000 * self.seed + (loader.id if loader else 0))
        while True:
            yield crops.batch(self.num_voxels)


class Crops:
    """An endless stream of crops and of batches of them. The same seed gives the same choices."""

    def __init__(self, scenes, seed, device="cpu"):
        self.scenes, self.device = scenes, torch.device(device)
        self.choose = random.Random(seed)
        self.numbers = torch.Generator(self.device).manual_seed(seed)

    def batch(self, num_voxels):
        crops, number = [], 0
        while number < num_voxels:
            crop = self.crop()
            if crop is not None:
                crops.append(crop)
                number += len(crop)
        return voxels.Batch(crops)

    def crop(self):
        """Voxels with features and labels, or None where there is too little or too much."""
        is_wide = self._chance(WIDE)
        radius = self.choose.uniform(*((26, 70) if is_wide else (8, 16) if self._chance(0.5) else (16, 26)))
        cloud = self._cut(radius, is_wide)
        if cloud is None:
            return None
        points, labels = cloud
        if not is_wide and self._chance(0.2):  # another scene over it
            other = self._cut(radius)
            if other is not None:
                turned = other[0] @ rotation(self.choose.uniform(0, 2 * math.pi), self.device).T
                points, labels = torch.cat([points, turned]), torch.cat([labels, other[1]])
        points, labels = self._with_gaps(points, labels, radius)
        if len(points) < 2 * FEWEST:
            return None
        points, labels = self._with_strays(self._moved(points), labels)
        crop = voxels.Voxels(points, labels)
        if not FEWEST <= len(crop) <= LARGEST_CROP:
            return None
        self._blur(crop.features)
        return crop

    def _chance(self, share):
        return self.choose.random() < share

    def _uniform(self, *shape):
        return torch.rand(*shape, generator=self.numbers, device=self.device)

    def _normal(self, *shape):
        return torch.randn(*shape, generator=self.numbers, device=self.device)

    def _cut(self, radius, is_wide=False):
        """Some scans of a place within a circle around (0, 0), ground near z = 0; None where there is next to nothing."""
        scene = self.choose.choice(self.scenes)
        scanners = [s for s in scene.scans if s != places.SURVEY]
        surveys = [s for s in scene.scans if s == places.SURVEY]
        if is_wide and scanners:
            parts = [self._sparse_scan(scene, self.choose.choice(scanners))]
        elif surveys and (not scanners or self._chance(0.18)):
            parts = [(scene.scans[places.SURVEY], 1, self.choose.choice([1, 0.5, 0.2, 0.1]) * self.choose.uniform(0.7, 1), False)]
            if scanners and self._chance(0.4):
                parts.append((self._some_scans(scene.scans[self.choose.choice(scanners)], 6), 1, 1, self._chance(0.5)))
        else:
            sensor = self.choose.choice(scanners)
            ring_step = self.choose.choice([2, 2, 3, 4]) if scene.num_rings[sensor] >= 32 and self._chance(0.45) else 1
            kept = 1 if self._chance(0.5) else self.choose.uniform(0.4, 1)
            parts = [(self._some_scans(scene.scans[sensor], 20), ring_step, kept, self._chance(0.5))]
        centre = self._centre(scene, parts[0][0])
        points, labels = zip(*(self._part(scene, *part, centre, radius) for part in parts))
        points, labels = torch.cat(points), torch.cat(labels)
        if len(points) < 2 * FEWEST:
            return None
        ground = torch.quantile(points[:: len(points) // 4096 + 1, 2], 0.05)
        return points - torch.stack([centre[0], centre[1], ground]), labels

    def _sparse_scan(self, scene, sensor):
        step = -(-scene.num_rings[sensor] // SPARSE)
        if scene.num_rings[sensor] // step >= SPARSE and self._chance(0.5):
            step *= 2
        kept = 1 if self._chance(0.7) else self.choose.uniform(0.6, 1)
        return [self.choose.choice(scene.scans[sensor])], step, kept, False

    def _some_scans(self, scans, most):
        draw = self.choose.random()
        number = 1 if draw < 0.4 else self.choose.randint(2, 4) if draw < 0.6 else self.choose.randint(5, most)
        number = min(number, len(scans))
        step = self.choose.randint(1, max(1, min(3, len(scans) // number)))
        first = self.choose.randint(0, len(scans) - 1 - (number - 1) * step)
        return scans[first : first + number * step : step]

    def _centre(self, scene, scans):
        """As often far from the scanner as near; at a vehicle, or at what is rare, more often than by chance."""
        scan = self.choose.choice(scans)
        part = scene.points_of(scan)
        index = part.start + (self._uniform(600) * (part.stop - part.start)).long()
        points, labels = scene.positions[index], scene.labels[index]
        draw = self.choose.random()
        wanted = (classes.VEHICLE,) if draw < 0.4 else RARE if draw < 0.6 else ()
        is_wanted = torch.isin(labels, torch.tensor(wanted, dtype=labels.dtype, device=self.device))
        if bool(is_wanted.any()):
            points = points[is_wanted]
        weights = torch.ones(len(points), device=self.device)
        if self._chance(0.6) and scan not in scene.scans.get(places.SURVEY, ()):
            weights = (points[:, :2] - scene.origins[scan, :2]).norm(dim=1).clamp(1, 60) ** 2
        return points[torch.multinomial(weights, 1, generator=self.numbers)[0], :2] + 3 * self._normal(2)

    def _part(self, scene, scans, ring_step, kept, is_blurred, centre, radius):
        points, labels = [], []
        height_noise, noise, turn = self.choose.uniform(0, 0.03), self.choose.uniform(0, 0.05), self.choose.uniform(0, 0.002)
        first_ring = self.choose.randrange(ring_step)
        biases = self._normal(256) * self.choose.uniform(0, RING_BIAS) if self._chance(0.5) else None  # of each ring
        for scan in scans:
            part = scene.points_of(scan)
            own = scene.positions[part]
            is_in = ((own[:, :2] - centre) ** 2).sum(1) < radius**2
            if ring_step > 1:
                is_in &= (scene.rings[part] + first_ring) % ring_step == 0
            if kept < 1:
                is_in &= self._uniform(len(own)) < kept
            own = own[is_in]
            if biases is not None:
                away = own - scene.origins[scan]
                own = own + functional.normalize(away) * biases[scene.rings[part][is_in].long()][:, None]
            if is_blurred:  # an error of the scan's pose
                origin = scene.origins[scan]
                shift = self._normal(3) * torch.tensor([noise, noise, height_noise], device=self.device)
                own = (own - origin) @ rotation(self.choose.gauss(0, turn), self.device).T + origin + shift
            points.append(own)
            labels.append(scene.labels[part][is_in])
        return torch.cat(points), torch.cat(labels)

    def _with_gaps(self, points, labels, radius):
        is_kept = torch.ones(len(points), dtype=torch.bool, device=self.device)
        if self._chance(0.4):
            for _ in range(self.choose.randint(1, 10)):
                middle = points[self.choose.randrange(len(points))]
                is_kept &= ((points - middle) ** 2).sum(1) > self.choose.uniform(0.2, 1.6) ** 2
        if self._chance(0.1):  # one side hidden
            angle = self.choose.uniform(0, 2 * math.pi)
            along = points[:, 0] * math.cos(angle) + points[:, 1] * math.sin(angle)
            is_kept &= along < self.choose.uniform(0, 0.7) * radius
        return points[is_kept], labels[is_kept]

    def _moved(self, points):
        """Turned, mirrored, stretched, tilted by a degree, and each point a little elsewhere."""
        size, tilts = self.choose.uniform(0.9, 1.1), (0.0, 0.0)
        if self._chance(0.6):
            tilts = (self.choose.gauss(0, 0.025), self.choose.gauss(0, 0.025))
        tilt = torch.tensor([[1, 0, tilts[0]], [0, 1, tilts[1]], [-tilts[0], -tilts[1], 1.0]], device=self.device)
        stretches = [size * self.choose.uniform(0.96, 1.04) for _ in range(3)]
        stretches[1] *= self.choose.choice([-1, 1])
        stretch = torch.diag(torch.tensor(stretches, device=self.device))
        points = points @ (tilt @ rotation(self.choose.uniform(0, 2 * math.pi), self.device) @ stretch).T
        points = points + voxels.FINEST * voxels.COARSEST * self._uniform(3)
        return points + self._normal(*points.shape) * self.choose.uniform(0, 0.025) if self._chance(0.6) else points

    def _with_strays(self, points, labels):
        if not self._chance(0.3):
            return points, labels
        number = int(len(points) * self.choose.uniform(0, 0.01)) + 1
        near = points[(self._uniform(number) * len(points)).long()]
        strays = near + self._normal(number, 3) * self.choose.uniform(0.2, 1.5)
        unknown = torch.full((number,), classes.UNKNOWN, dtype=labels.dtype, device=self.device)
        return torch.cat([points, strays]), torch.cat([labels, unknown])

    def _blur(self, features):
        """No single feature may be relied on."""
        draw = self.choose.random()
        if draw < 0.25:
            features[:, 1:3] = 0
        elif draw < 0.6:
            features[:, 1:3] += 0.2 * self._normal(2)
        elif draw < 0.68:
            features[:, 1] = features[:, 2]
        if self._chance(0.5):
            features[:, 3] = 0

# SPDX-License-Identifier: GPL-3.0-or-later
"""Voxels of a cloud, what the network is told of each, and the pyramid of levels. As parking/segmentation has it in C++: a
change here is one there, and a new version of the weights."""

import math

import torch
import torch.nn.functional as functional

from . import classes

FINEST = 0.1  # [m]
NUM_LEVELS = 5  # 0.1, 0.2, 0.4, 0.8, 1.6 m
COARSEST = 2 ** (NUM_LEVELS - 1)  # [voxels]
NUM_NEIGHBOURS = 28
NEIGHBOUR_RADIUS_SQUARED = 6.25  # [voxels^2], between indices
KERNEL_RADIUS = 1.5  # [voxels]
KERNEL_REACH = 1.2  # [voxels]: sigma of equation 3
COLUMN = 0.5  # [m], of the lowest points
NEAR_COLUMNS, FAR_COLUMNS = 5, 17
FEATURES = ("one", "height over 2.5 m", "height over 8.5 m", "points")

GAP = 64  # free voxels between the clouds of a batch: 4 on the coarsest level, more than neighbours reach
MARGIN = 4  # free voxels behind a cloud in y and z


def neighbour_offsets():
    """Nearest first; of equal distance x, then y, then z decides."""
    reach = range(-math.isqrt(int(NEIGHBOUR_RADIUS_SQUARED)), math.isqrt(int(NEIGHBOUR_RADIUS_SQUARED)) + 1)
    offsets = [(x * x + y * y + z * z, x, y, z) for x in reach for y in reach for z in reach]
    return torch.tensor([o[1:] for o in sorted(offsets) if o[0] <= NEIGHBOUR_RADIUS_SQUARED])


def kernel_points():
    """15 x 3 [voxels]: the middle, six on the axes (-x, +x, -y, ...), eight towards the corners of a cube."""
    axes = [[sign * (axis == i) for i in range(3)] for axis in range(3) for sign in (-1.0, 1.0)]
    corner = 1 / math.sqrt(3)
    corners = [[x * corner, y * corner, z * corner] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    return KERNEL_RADIUS * torch.tensor([[0.0, 0.0, 0.0]] + axes + corners)


def keys_of(cells, size):
    return (cells[:, 0] * size[1] + cells[:, 1]) * size[2] + cells[:, 2]


def cells_of(keys, size):
    plane = size[1] * size[2]
    return torch.stack([keys // plane, keys // size[2] % size[1], keys % size[2]], 1)


def means_by(index, number, values, weights):
    sums = torch.zeros(number, 3, device=values.device).index_add_(0, index, values * weights[:, None])
    return sums / torch.zeros(number, device=values.device).index_add_(0, index, weights)[:, None]


def heights(positions):
    """Over the lowest mean of 5 x 5 and of 17 x 17 columns of 0.5 m around: n x 2 [m]."""
    columns = torch.floor(positions[:, :2] / COLUMN).long()
    columns -= columns.min(0).values
    size = (columns.max(0).values + 1).tolist()
    flat = columns[:, 0] * size[1] + columns[:, 1]
    lowest = torch.full((size[0] * size[1],), math.inf, device=positions.device)
    lowest.scatter_reduce_(0, flat, positions[:, 2], "amin")
    lowest = lowest.view(1, 1, *size)
    windows = [-functional.max_pool2d(-lowest, w, 1, w // 2).view(-1)[flat] for w in (NEAR_COLUMNS, FAR_COLUMNS)]
    return positions[:, 2:] - torch.stack(windows, 1)


class Voxels:
    """Of one cloud: cells (n x 3, none negative), means (n x 3) [m], counts, features (n x 4); labels where the points have some."""

    def __init__(self, points, labels=None):
        cells = torch.floor(points / FINEST).long()
        cells -= cells.min(0).values // COARSEST * COARSEST
        size = cells.max(0).values + 1
        keys, self.of_point, counts = torch.unique(keys_of(cells, size), return_inverse=True, return_counts=True)
        self.cells = cells_of(keys, size)
        self.counts = counts.float()
        self.means = means_by(self.of_point, len(keys), points, torch.ones(len(points), device=points.device))
        self.features = torch.cat(
            [
                torch.ones(len(keys), 1, device=points.device),
                (heights(self.means) / 2).clamp(-1, 4),
                (torch.log2(self.counts)[:, None] / 6).clamp(0, 2),
            ],
            1,
        )
        self.labels = None if labels is None else self._commonest(labels.long(), len(keys))

    def _commonest(self, labels, number):
        known = labels != classes.UNKNOWN
        votes = torch.bincount(
            self.of_point[known] * classes.NUM_CLASSES + labels[known], minlength=number * classes.NUM_CLASSES
        ).view(number, classes.NUM_CLASSES)
        commonest = votes.argmax(1)
        commonest[votes.sum(1) == 0] = classes.UNKNOWN
        return commonest

    def __len__(self):
        return len(self.cells)


class Batch:
    """Clouds side by side in x, so far apart that none sees another; voxels in the order of their cells."""

    def __init__(self, clouds):
        shifts, shift = [], 0
        for cloud in clouds:
            shifts.append(shift)
            shift += (int(cloud.cells[:, 0].max()) // GAP + 2) * GAP
        cells = torch.cat([c.cells + torch.tensor([s, 0, 0], device=c.cells.device) for c, s in zip(clouds, shifts)])
        self.order = torch.argsort(keys_of(cells, cells.max(0).values + MARGIN))
        self.cells = cells[self.order]
        joined = lambda name: torch.cat([getattr(c, name) for c in clouds])[self.order]
        self.means, self.counts, self.features = joined("means"), joined("counts"), joined("features")
        self.labels = None if clouds[0].labels is None else joined("labels")

    def to(self, device):
        for name in ("cells", "means", "counts", "features", "labels"):
            setattr(self, name, getattr(self, name).to(device, non_blocking=True))
        return self


class Level:
    """neighbours (n x K, n where there are fewer), their influence on the kernel points (n x K x 15), their number (n x 1),
    and each voxel's parent (n) on the next level, which has num_parents."""

    num_parents = None
    parents = None


def neighbours_of(cells, chunk=1 << 19):
    size = cells.max(0).values + MARGIN
    keys, offsets = keys_of(cells, size), keys_of(neighbour_offsets().to(cells.device), size)
    found = torch.full((len(cells), NUM_NEIGHBOURS), len(cells), dtype=torch.int64, device=cells.device)
    for begin in range(0, len(cells), chunk):
        wanted = keys[begin : begin + chunk, None] + offsets
        index = torch.searchsorted(keys, wanted).clamp_max(len(keys) - 1)
        is_there = keys[index] == wanted
        rank = is_there.cumsum(1)
        row, column = (is_there & (rank <= NUM_NEIGHBOURS)).nonzero(as_tuple=True)
        found[begin + row, rank[row, column] - 1] = index[row, column]
    return found


def influences(means, neighbours, length, dtype, chunk=1 << 18):
    """Equation 3: 1 - distance / sigma, not below 0, of neighbours on kernel points."""
    kernel, parts = kernel_points().to(means.device), []
    padded = torch.cat([means, means[:1]])
    for begin in range(0, len(means), chunk):
        near = neighbours[begin : begin + chunk]
        away = (padded[near] - means[begin : begin + chunk, None]) / length
        squared = (away * away).sum(2, keepdim=True) - 2 * away @ kernel.T + (kernel * kernel).sum(1)
        influence = (1 - squared.clamp_min(0).sqrt() / KERNEL_REACH).clamp_min(0)
        influence[near == len(means)] = 0
        parts.append(influence.to(dtype))
    return torch.cat(parts)


def pyramid(batch, dtype):
    levels, cells, means, counts = [], batch.cells, batch.means, batch.counts
    for number in range(NUM_LEVELS):
        level = Level()
        level.neighbours = neighbours_of(cells)
        level.influences = influences(means, level.neighbours, FINEST * 2**number, dtype)
        level.num_neighbours = (level.neighbours < len(cells)).sum(1, keepdim=True).to(dtype)
        levels.append(level)
        if number + 1 == NUM_LEVELS:
            break
        coarse = cells // 2
        size = coarse.max(0).values + MARGIN
        keys, level.parents = torch.unique(keys_of(coarse, size), return_inverse=True)
        level.num_parents = len(keys)
        means = means_by(level.parents, len(keys), means, counts)
        counts = torch.zeros(len(keys), device=counts.device).index_add_(0, level.parents, counts)
        cells = cells_of(keys, size)
    return levels

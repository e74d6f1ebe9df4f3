#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""network_test.py FOLDER: makes a small network and a cloud, and writes weights.kpconv and scores.txt there: a line a point,
x y z and the scores of its voxel's classes by PyTorch. Exit code 77 without PyTorch."""

import pathlib
import sys

try:
    import torch
except ImportError:
    sys.exit(77)

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
from tools.training import network, voxels, weights  # noqa: E402

NUM_POINTS = 4000
STEP = voxels.FINEST / 16384  # of a map's means: points in the middle of a step keep their place in it


def cloud():
    numbers = torch.Generator().manual_seed(3)
    points = torch.rand(NUM_POINTS, 3, generator=numbers) * torch.tensor([6.0, 5.0, 2.0]) - torch.tensor([3.0, 2.0, 0.5])
    points[:, 2] *= torch.rand(NUM_POINTS, generator=numbers)
    return (torch.floor(points.double() / STEP) + 0.5) * STEP


def main(folder):
    torch.manual_seed(1)
    points, net = cloud(), network.Network(*network.SMALL)
    found = voxels.Voxels(points.float())
    batch = voxels.Batch([found])
    levels = voxels.pyramid(batch, torch.float32)
    net.train()
    for _ in range(60):  # so that norms have seen something
        net(batch.features, levels)
    weights.write(folder / "weights.kpconv", net.eval(), {})
    rounded, _ = weights.read(folder / "weights.kpconv")
    with torch.no_grad():
        sorted_scores = rounded(batch.features, levels)
    scores = torch.empty_like(sorted_scores)
    scores[batch.order] = sorted_scores
    with open(folder / "scores.txt", "w") as file:
        for point, row in zip(points.tolist(), scores[found.of_point].tolist()):
            file.write(" ".join(f"{value:.12g}" for value in [*point, *row]) + "\n")


main(pathlib.Path(sys.argv[1]))

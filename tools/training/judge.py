# SPDX-License-Identifier: GPL-3.0-or-later
"""How well a network tells classes apart: confusion matrices (a row a true class), intersection over union."""

import torch

from . import classes, places, voxels


def confusion(predicted, labels):
    known = labels != classes.UNKNOWN
    cells = labels[known].long() * classes.NUM_CLASSES + predicted[known]
    return torch.bincount(cells, minlength=classes.NUM_CLASSES**2).view(classes.NUM_CLASSES, -1).double().cpu()


def ious(matrix):
    return matrix.diag() / (matrix.sum(0) + matrix.sum(1) - matrix.diag()).clamp_min(1)


def predict(net, points, dtype=torch.float32):
    """Classes of the points of a whole cloud: that of the voxel that each lies in."""
    cloud = voxels.Voxels(points)
    batch = voxels.Batch([cloud])
    with torch.no_grad(), torch.autocast(points.device.type, dtype=torch.bfloat16, enabled=dtype == torch.bfloat16):
        scores = net(batch.features, voxels.pyramid(batch, dtype))
    of_voxel = torch.empty(len(cloud), dtype=torch.int64, device=points.device)
    of_voxel[batch.order] = scores.argmax(1)
    return of_voxel[cloud.of_point]


def judge(net, scenes, dtype):
    """Confusion matrix of points for each kind of cloud: surveys, single scans, scans together, sparse ones."""
    net.eval()
    matrices = {}

    def add(name, scene, scans, ring_step=1):
        points, labels = scene.cloud(scans, ring_step)
        found = confusion(predict(net, points, dtype), labels)
        matrices[name] = matrices.get(name, 0) + found

    for scene in scenes:
        for sensor, scans in scene.scans.items():
            if sensor == places.SURVEY:
                add("survey", scene, scans)
                continue
            name = f"scanner {sensor}"
            add(f"{name}, one scan", scene, scans[:1])
            add(f"{name}, one scan, every fourth ring", scene, scans[:1], 4)
            add(f"{name}, all scans", scene, scans)
    return matrices


def table(matrices):
    """Lines of a Markdown table."""
    yield "| clouds | " + " | ".join(classes.NAMES) + " | mean | false vehicles [%] |"
    yield "|---" * (classes.NUM_CLASSES + 3) + "|"
    for name, matrix in matrices.items():
        others = matrix.sum() - matrix[classes.VEHICLE].sum()
        false = 100 * (matrix[:, classes.VEHICLE].sum() - matrix[classes.VEHICLE, classes.VEHICLE]) / others
        values = ious(matrix)
        yield f"| {name} | " + " | ".join(f"{v:.3f}" for v in values) + f" | {values.mean():.3f} | {false:.2f} |"

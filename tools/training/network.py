# SPDX-License-Identifier: GPL-3.0-or-later
"""KPConv (Thomas et al., "KPConv: Flexible and Deformable Convolution for Point Clouds", ICCV 2019), rigid kernels."""

import math

import torch
import torch.nn.functional as functional
from torch import nn

from . import classes, voxels

NUM_KERNEL_POINTS = 15
SLOPE = 0.1  # of the leaky rectifier
NORM_EPSILON = 1e-4
NORM_MOMENTUM = 0.02
LARGE = ((32, 64, 128, 192, 256), (1, 2, 2, 2, 2))  # channels of each level, blocks of each level
SMALL = ((16, 32, 64, 96, 128), (1, 1, 1, 1, 1))
ROWS_AT_ONCE = 1 << 17  # without gradients, so that memory stays small


class Gather(torch.autograd.Function):
    """Rows by number. Its gradients are added in float32 and without sorting, which indexing's own do."""

    @staticmethod
    def forward(context, rows, index):
        context.save_for_backward(index)
        context.number, context.dtype = len(rows), rows.dtype
        return rows.index_select(0, index)

    @staticmethod
    def backward(context, gradient):
        (index,) = context.saved_tensors
        sums = torch.zeros(context.number, gradient.shape[1], device=gradient.device)
        return sums.index_add_(0, index, gradient.float()).to(context.dtype), None


def norm(channels):
    return nn.BatchNorm1d(channels, eps=NORM_EPSILON, momentum=NORM_MOMENTUM)


class Unary(nn.Module):
    def __init__(self, inputs, outputs, is_rectified=True):
        super().__init__()
        self.linear = nn.Linear(inputs, outputs, bias=False)
        self.norm = norm(outputs)
        self.is_rectified = is_rectified

    def forward(self, rows):
        rows = self.norm(self.linear(rows))
        return functional.leaky_relu(rows, SLOPE) if self.is_rectified else rows


class Convolution(nn.Module):
    """Equation 2, divided by the number of neighbours."""

    def __init__(self, inputs, outputs):
        super().__init__()
        self.weights = nn.Parameter(torch.randn(NUM_KERNEL_POINTS * inputs, outputs) * math.sqrt(2 / (3 * inputs)))
        self.norm = norm(outputs)

    def _rows(self, padded, neighbours, influences, num_neighbours):
        near = Gather.apply(padded, neighbours.reshape(-1)).view(*neighbours.shape, -1)
        sums = torch.bmm(influences.transpose(1, 2), near).reshape(len(neighbours), -1)
        return (sums / num_neighbours) @ self.weights.to(sums.dtype)

    def forward(self, rows, level):
        padded = torch.cat([rows, rows.new_zeros(1, rows.shape[1])]).to(level.influences.dtype)
        step = len(rows) if torch.is_grad_enabled() else ROWS_AT_ONCE
        parts = [
            self._rows(padded, level.neighbours[b : b + step], level.influences[b : b + step], level.num_neighbours[b : b + step])
            for b in range(0, len(rows), step)
        ]
        return functional.leaky_relu(self.norm(torch.cat(parts)), SLOPE)


class Bottleneck(nn.Module):
    def __init__(self, inputs, outputs):
        super().__init__()
        self.reduce = Unary(inputs, outputs // 2)
        self.convolution = Convolution(outputs // 2, outputs // 2)
        self.expand = Unary(outputs // 2, outputs, is_rectified=False)
        self.shortcut = Unary(inputs, outputs, is_rectified=False) if inputs != outputs else None

    def forward(self, rows, level):
        beside = rows if self.shortcut is None else self.shortcut(rows)
        return functional.leaky_relu(self.expand(self.convolution(self.reduce(rows), level)) + beside, SLOPE)


def largest_of_children(rows, level):
    lowest = torch.full((level.num_parents, rows.shape[1]), -1e4, device=rows.device, dtype=rows.dtype)
    return lowest.scatter_reduce(0, level.parents[:, None].expand_as(rows), rows, "amax")


class Network(nn.Module):
    """Scores of the classes for each voxel of the finest level."""

    def __init__(self, widths, blocks):
        super().__init__()
        self.widths, self.blocks = tuple(widths), tuple(blocks)
        self.first = Convolution(len(voxels.FEATURES), widths[0])
        self.encoder, inputs = nn.ModuleList(), widths[0]
        for width, number in zip(widths, blocks):
            self.encoder.append(nn.ModuleList(Bottleneck(inputs if i == 0 else width, width) for i in range(number)))
            inputs = width
        self.decoder = nn.ModuleList(Unary(above + width, width) for width, above in zip(widths, widths[1:]))
        self.head = Unary(widths[0], widths[0])
        self.scores = nn.Linear(widths[0], classes.NUM_CLASSES)

    def forward(self, features, levels):
        rows, beside = self.first(features, levels[0]), []
        for number, bottlenecks in enumerate(self.encoder):
            for bottleneck in bottlenecks:
                rows = bottleneck(rows, levels[number])
            beside.append(rows)
            if number + 1 < len(self.encoder):
                rows = largest_of_children(rows, levels[number])
        for number in reversed(range(len(self.decoder))):
            rows = self.decoder[number](torch.cat([Gather.apply(rows, levels[number].parents), beside[number]], 1))
        return self.scores(self.head(rows)).float()

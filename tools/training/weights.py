# SPDX-License-Identifier: GPL-3.0-or-later
"""The file of weights that parking/segmentation reads.

    "vdbmapkp", version (uint32), length of the header (uint32), the header (JSON: classes, features, widths, blocks, what it
    was trained on, and of each matrix name, rows, columns), the matrices (float16, row-major, in the header's order), CRC-32
    of all before it (uint32). Little endian.

Norms are folded: a layer is `rows @ NAME.weights + NAME.bias`."""

import json
import struct
import zlib

import numpy
import torch

from . import classes, network, voxels

MAGIC, VERSION = b"vdbmapkp", 1


def folded(weights, norm):
    """Inputs x outputs, and 1 x outputs."""
    scale = norm.weight / torch.sqrt(norm.running_var + norm.eps)
    return weights * scale, (norm.bias - norm.running_mean * scale)[None]


def layers(net):
    """Name and folded layer, in the order in which they are used."""

    def unary(name, layer):
        return name, folded(layer.linear.weight.T, layer.norm)

    def convolution(name, layer):
        return name, folded(layer.weights, layer.norm)

    yield convolution("first", net.first)
    for level, bottlenecks in enumerate(net.encoder):
        for number, block in enumerate(bottlenecks):
            name = f"encoder.{level}.{number}"
            yield unary(f"{name}.reduce", block.reduce)
            yield convolution(f"{name}.convolution", block.convolution)
            yield unary(f"{name}.expand", block.expand)
            if block.shortcut is not None:
                yield unary(f"{name}.shortcut", block.shortcut)
    for level, layer in enumerate(net.decoder):
        yield unary(f"decoder.{level}", layer)
    yield unary("head", net.head)
    yield "scores", (net.scores.weight.T, net.scores.bias[None])


def write(path, net, training):
    """`training`: what the header shall say of it."""
    matrices = [(f"{name}.{part}", matrix) for name, pair in layers(net) for part, matrix in zip(("weights", "bias"), pair)]
    header = {
        "classes": classes.NAMES,
        "features": voxels.FEATURES,
        "finest": voxels.FINEST,
        "neighbours": voxels.NUM_NEIGHBOURS,
        "widths": net.widths,
        "blocks": net.blocks,
        "training": training,
        "matrices": [[name, *matrix.shape] for name, matrix in matrices],
    }
    text = json.dumps(header).encode()
    data = MAGIC + struct.pack("<II", VERSION, len(text)) + text
    for _, matrix in matrices:
        data += matrix.detach().float().cpu().numpy().astype("<f2").tobytes()
    path.write_bytes(data + struct.pack("<I", zlib.crc32(data)))


def read(path):
    """A network for use, not for training: norms are folded into its weights."""
    data = path.read_bytes()
    version, length = struct.unpack_from("<II", data, len(MAGIC))
    if data[: len(MAGIC)] != MAGIC or version != VERSION or zlib.crc32(data[:-4]) != struct.unpack("<I", data[-4:])[0]:
        raise ValueError(f"{path}: is no file of weights of version {VERSION}, or damaged")
    begin = len(MAGIC) + 8
    header, at = json.loads(data[begin : begin + length]), begin + length
    net, matrices = network.Network(header["widths"], header["blocks"]), {}
    for name, rows, columns in header["matrices"]:
        values = numpy.frombuffer(data, "<f2", rows * columns, at).reshape(rows, columns)
        matrices[name], at = torch.from_numpy(values.astype(numpy.float32)), at + 2 * rows * columns
    for name, (weights, _) in list(layers(net)):
        layer = net
        for part in name.split("."):
            layer = layer[int(part)] if part.isdigit() else getattr(layer, part)
        set_layer(layer, matrices[f"{name}.weights"], matrices[f"{name}.bias"][0])
    return net.eval(), header


def set_layer(layer, weights, bias):
    with torch.no_grad():
        if isinstance(layer, torch.nn.Linear):
            layer.weight.copy_(weights.T)
            layer.bias.copy_(bias)
            return
        if isinstance(layer, network.Convolution):
            layer.weights.copy_(weights)
        else:
            layer.linear.weight.copy_(weights.T)
        layer.norm.running_mean.zero_()
        layer.norm.running_var.fill_(1 - layer.norm.eps)
        layer.norm.weight.fill_(1)
        layer.norm.bias.copy_(bias)

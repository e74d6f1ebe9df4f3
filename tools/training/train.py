# SPDX-License-Identifier: GPL-3.0-or-later
"""train.py OUT [options]: learns from simulated streets, and writes weights, confusion matrices and curves. See README.md."""

import argparse
import csv
import json
import math
import os
import pathlib
import sys
import time

import numpy
import torch
import torch.nn.functional as functional

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
from tools.training import classes, crops, judge, network, places, streets, voxels, weights  # noqa: E402

FIRST_VALIDATION_SEED = 9001
WARM_UP = 0.04  # share of the training
AVERAGE = 0.998  # moving average of the weights
LOVASZ = 0.5  # weight of the second loss


def lovasz(shares, labels):
    """Lovasz-softmax (Berman et al., CVPR 2018) over the classes that occur."""
    losses = []
    for index in range(classes.NUM_CLASSES):
        is_class = (labels == index).float()
        if not bool(is_class.any()):
            continue
        errors, order = torch.sort((is_class - shares[:, index]).abs(), descending=True)
        ranked = is_class[order]
        jaccard = 1 - (ranked.sum() - ranked.cumsum(0)) / (ranked.sum() + (1 - ranked).cumsum(0))
        steps = torch.cat([jaccard[:1], jaccard[1:] - jaccard[:-1]])
        losses.append((errors * steps).sum())
    return torch.stack(losses).mean()


class Average:
    """Exponential moving average of a network's state."""

    def __init__(self, net):
        self.state = {name: value.detach().clone() for name, value in net.state_dict().items()}
        self.steps = 0

    def update(self, net):
        self.steps += 1
        share = 1 - min(AVERAGE, 1 - 8 / (self.steps + 8))
        with torch.no_grad():
            for name, value in net.state_dict().items():
                if value.dtype.is_floating_point:
                    self.state[name].lerp_(value, share)


def state_of(path, device):
    """Of a former training's state.pt, or of finished weights: their norms are folded, which learns on as well."""
    return weights.read(path)[0].state_dict() if path.suffix == ".kpconv" else torch.load(path, map_location=device)


class Learner:
    def __init__(self, options, device):
        self.options, self.device = options, device
        self.dtype = torch.bfloat16 if device.type == "cuda" else torch.float32
        widths, blocks = network.LARGE if options.size == "large" else network.SMALL
        self.net = network.Network(widths, blocks).to(device)
        if options.resume:
            self.net.load_state_dict(state_of(options.resume, device))
        matrices = [p for p in self.net.parameters() if p.ndim > 1]
        others = [p for p in self.net.parameters() if p.ndim <= 1]
        groups = [{"params": matrices, "weight_decay": 0.02}, {"params": others, "weight_decay": 0}]
        self.optimizer = torch.optim.AdamW(groups, lr=options.rate, betas=(0.9, 0.99))
        self.average = Average(self.net)
        self.weights = torch.tensor(classes.WEIGHTS, device=device)
        self.confusion = torch.zeros(classes.NUM_CLASSES, classes.NUM_CLASSES)
        self.num_voxels = self.num_steps = 0

    def step(self, batch, progress):
        rate = self.options.rate * min(1, progress / WARM_UP + 0.02) * (0.5 * (1 + math.cos(math.pi * progress)) + 0.005)
        for group in self.optimizer.param_groups:
            group["lr"] = rate
        self.net.train()
        with torch.no_grad():
            levels = voxels.pyramid(batch, self.dtype)
        with torch.autocast(self.device.type, dtype=torch.bfloat16, enabled=self.dtype == torch.bfloat16):
            scores = self.net(batch.features, levels)
        known = batch.labels != classes.UNKNOWN
        scores, labels = scores[known], batch.labels[known]
        loss = functional.cross_entropy(scores, labels, self.weights) + LOVASZ * lovasz(scores.softmax(1), labels)
        self.optimizer.zero_grad(set_to_none=True)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(self.net.parameters(), 5.0)
        self.optimizer.step()
        self.average.update(self.net)
        self.num_voxels += len(batch.cells)
        self.num_steps += 1
        if self.num_steps % 8 == 0:  # reading it waits for the device
            self.confusion = 0.9 * self.confusion + judge.confusion(scores.argmax(1), labels)
        return loss.detach()

    def averaged(self):
        net = network.Network(self.net.widths, self.net.blocks).to(self.device)
        net.load_state_dict(self.average.state)
        return net.eval()


def load(paths, device):
    return [crops.Scene(places.Place.load(path), device) for path in paths]


def prepare(options):
    """Paths of the places to learn from, and of those to judge by."""
    own = []
    for number, folder in enumerate(options.own):
        own.append(options.out / "places" / f"own{number}.npz")
        own[-1].parent.mkdir(parents=True, exist_ok=True)
        places.of_sequence(folder).save(own[-1])
    seeds = range(options.first_street, options.first_street + options.streets)
    judged = range(FIRST_VALIDATION_SEED, FIRST_VALIDATION_SEED + options.validation)
    folder = options.out / "places"
    judged = streets.make_streets(options.vdbmap, folder, judged, options.workers)
    learned = own + streets.make_streets(options.vdbmap, folder, seeds, options.workers)
    if not learned:
        raise SystemExit("train.py: there is no place to learn from")
    return learned, judged


def learn(learner, scenes, options):
    stream = crops.Batches(scenes, options.batch, options.seed)
    batches = iter(
        torch.utils.data.DataLoader(
            stream, batch_size=None, num_workers=options.loaders, prefetch_factor=3 if options.loaders else 2
        )
    )
    waited = 0.0
    begin = reported = time.monotonic()
    with open(options.out / "curves.csv", "w", newline="") as file:
        curves = csv.writer(file)
        curves.writerow(["seconds", "steps", "voxels", "loss", *classes.NAMES])
        while True:
            elapsed = time.monotonic() - begin
            progress = max(learner.num_voxels / (options.voxels * 1e6), elapsed / (options.minutes * 60))
            if progress >= 1:
                break
            wanted = time.monotonic()
            batch = next(batches)
            waited += time.monotonic() - wanted
            loss = learner.step(batch.to(learner.device), progress)
            if time.monotonic() - reported > options.report:
                reported = time.monotonic()
                values = judge.ious(learner.confusion)
                row = [f"{reported - begin:.0f}", learner.num_steps, learner.num_voxels, f"{float(loss):.4f}"]
                curves.writerow(row + [f"{v:.4f}" for v in values])
                file.flush()
                speed = f"{learner.num_voxels / (reported - begin):.0f} voxels/s, {waited / (reported - begin):.0%} waiting for them"
                print(*row, speed, *(f"{v:.3f}" for v in values), flush=True)
                torch.save(learner.average.state, options.out / "state.pt")
    return time.monotonic() - begin


def plot_curves(folder):
    try:
        import matplotlib
    except ImportError:
        print("no curves.png: matplotlib is missing")
        return
    matplotlib.use("Agg")
    from matplotlib import pyplot

    rows = numpy.genfromtxt(folder / "curves.csv", delimiter=",", names=True, ndmin=1)
    if len(rows) == 0:
        return
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(11, 4), layout="constrained")
    left.plot(rows["voxels"] / 1e6, rows["loss"])
    left.set(xlabel="voxels seen [million]", ylabel="loss")
    for name in classes.NAMES:
        right.plot(rows["voxels"] / 1e6, rows[name], label=name)
    right.set(xlabel="voxels seen [million]", ylabel="IoU while learning", ylim=(0, 1))
    right.legend(ncols=2)
    figure.savefig(folder / "curves.png", dpi=110)


def report(net, scenes, learner, folder):
    matrices = judge.judge(net, scenes, learner.dtype)
    with open(folder / "confusion.csv", "w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["clouds", "true class", *classes.NAMES])
        for name, matrix in matrices.items():
            for true, row in zip(classes.NAMES, matrix):
                rows.writerow([name, true, *(int(v) for v in row)])
    lines = list(judge.table(matrices))
    (folder / "judgement.md").write_text("\n".join(lines) + "\n")
    print("\n".join(lines), flush=True)


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=pathlib.Path, help="folder to write; places made before are used again")
    parser.add_argument("--vdbmap", default="build/release/bin/vdbmap", help="the command that simulates (default: %(default)s)")
    parser.add_argument("--streets", type=int, default=128, help="simulated streets to learn from (default: %(default)s)")
    parser.add_argument("--first-street", type=int, default=streets.FIRST_SEED, help="seed of the first (default: %(default)s)")
    parser.add_argument("--validation", type=int, default=4, help="streets to judge by (default: %(default)s)")
    parser.add_argument("--own", nargs="*", default=[], help="folders of labelled scans, laid out like SemanticKITTI's")
    parser.add_argument("--size", choices=("large", "small"), default="large")
    parser.add_argument("--voxels", type=float, default=1354, help="to learn from, in millions (default: %(default)s)")
    parser.add_argument("--minutes", type=float, default=math.inf, help="ends the training sooner (default: no limit)")
    parser.add_argument("--batch", type=int, default=200_000, help="voxels a step (default: %(default)s)")
    parser.add_argument("--rate", type=float, default=3e-3, help="highest learning rate (default: %(default)s)")
    parser.add_argument("--resume", type=pathlib.Path, help="state.pt or .kpconv of a network of this size to begin with")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=os.cpu_count(), help="streets simulated at once (default: one a core)")
    parser.add_argument("--loaders", type=int, help="processes that make batches (default: two less than cores, 0 without GPU)")
    parser.add_argument("--report", type=float, default=15, help="seconds from line to line (default: %(default)s)")
    options = parser.parse_args(arguments)
    if options.loaders is None:
        options.loaders = max(os.cpu_count() - 2, 1) if torch.cuda.is_available() else 0
    return options


def main(arguments):
    options = parse(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    begin = time.monotonic()
    learned, judged = prepare(options)
    print(f"{len(learned)} places to learn from, {len(judged)} to judge by: {time.monotonic() - begin:.0f} s", flush=True)
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    torch.backends.cuda.matmul.allow_tf32 = True
    torch.manual_seed(options.seed)
    learner = Learner(options, device)
    seconds = learn(learner, load(learned, "cpu"), options)
    torch.save(learner.average.state, options.out / "state.pt")
    net = learner.averaged()
    said = {
        "streets": [options.first_street, options.streets],
        "own": len(options.own),
        "voxels": learner.num_voxels,
        "steps": learner.num_steps,
        "seed": options.seed,
    }
    weights.write(options.out / "weights.kpconv", net, said)
    print(json.dumps(said), f"{seconds:.0f} s of learning on {device.type}", flush=True)
    plot_curves(options.out)
    report(net, load(judged, device), learner, options.out)


if __name__ == "__main__":
    main(sys.argv[1:])

# SPDX-License-Identifier: GPL-3.0-or-later
"""The classes that the network tells apart, and how SemanticKITTI's numbers fall into them."""

import torch

NAMES = ("ground", "building", "vegetation", "vehicle", "pole", "person", "other")
GROUND, BUILDING, VEGETATION, VEHICLE, POLE, PERSON, OTHER = range(len(NAMES))
NUM_CLASSES = len(NAMES)
UNKNOWN = 255  # points without a class: neither learned nor judged

# SemanticKITTI's classes, those that move (252 and up) with those that stand. Riders are persons. What is not here has
# no class: 0 unlabelled, 1 outlier.
SEMANTIC_KITTI = {
    GROUND: (40, 44, 48, 49, 60, 72),
    BUILDING: (50,),
    VEGETATION: (70, 71),
    VEHICLE: (10, 13, 16, 18, 20, 252, 256, 257, 258, 259),
    POLE: (80, 81),
    PERSON: (30, 31, 32, 253, 254, 255),
    OTHER: (11, 15, 51, 52, 99),
}

# How much an error counts: what is rare counts more.
WEIGHTS = (0.6, 1.0, 1.2, 1.0, 2.0, 2.5, 1.5)


def table():
    """Class of each of SemanticKITTI's numbers (the lower 16 bits of a label), 0 to 65535."""
    classes = torch.full((1 << 16,), UNKNOWN, dtype=torch.uint8)
    for index, numbers in SEMANTIC_KITTI.items():
        classes[list(numbers)] = index
    return classes

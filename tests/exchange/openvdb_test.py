# SPDX-License-Identifier: GPL-3.0-or-later
"""What OpenVDB's Python module reads from a .vdb file, as JSON: openvdb_test.py FILE.vdb OUT.json [GRID ...]

Without names all grids at once.
"""

import json
import pathlib
import sys

import pyopenvdb


def describe(grid):
    return {
        "name": grid.name,
        "type": grid.valueTypeName,
        "class": str(grid.gridClass),
        "background": grid.background,
        "metadata": {name: value for name, value in grid.metadata.items() if isinstance(value, (int, float, str))},
        "origin": grid.transform.indexToWorld((0, 0, 0)),
        "voxel_size": grid.transform.voxelSize(),
        "voxels": [[item.min, item.value] for item in grid.citerOnValues()],
    }


def main(path, out, names):
    grids = [pyopenvdb.read(path, name) for name in names] if names else pyopenvdb.readAll(path)[0]
    pathlib.Path(out).write_text(json.dumps([describe(grid) for grid in grids]))


main(sys.argv[1], sys.argv[2], sys.argv[3:])

"""What the tests of gim.py share: the conformance vectors, and a way to skip where numpy is missing."""

import os
import sys
import unittest
from pathlib import Path

try:
    import numpy as np
except ImportError:
    print("skipped: this Python has no numpy")
    sys.exit(77)

import gim

ROOT = Path(__file__).resolve().parents[2]
VECTORS = ROOT / "spec" / "vectors"
PROGRAM = os.environ.get("GIM_PROGRAM")

needs_program = unittest.skipUnless(PROGRAM, "the program gim is not built")


def valid(name):
    return (VECTORS / "valid" / f"{name}.gim").read_bytes()


def torus(rows, columns):
    """A closed mesh with a hole: vertices n x 3, faces m x 3."""
    u, v = np.meshgrid(np.arange(rows) * 2 * np.pi / rows, np.arange(columns) * 2 * np.pi / columns, indexing="ij")
    vertices = np.stack([(2 + np.cos(v)) * np.cos(u), (2 + np.cos(v)) * np.sin(u), np.sin(v)], -1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    corner = lambda row, column: (row % rows * columns + column % columns).ravel()
    a, b, c, d = corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)
    return vertices, np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)])


def bounds_of(file):
    """Errors of levels, then boxes of images, as in the .bnd files; nothing if the file tells neither."""
    info, most = file.info, float(np.finfo(np.float32).max)
    if info.max_errors[0] == 0 and info.box is None:
        return []
    errors = [pair for level in zip(info.rms_errors, info.max_errors) for pair in level]
    boxes = [image.box or gim.Box((-most,) * 3, (most,) * 3) for image in file.images]
    return [np.array(errors + [x for box in boxes for corner in box for x in corner], np.float32)]


def decode_all(data):
    """Does what tests/decoder/vectors.h does: all levels of all images, then all planes, then labels, then the raster. Returns the arrays by kind."""
    file = gim.open(data)
    read = {"f32": [], "tri": [], "vtx": [], "pln": [], "bnd": bounds_of(file), "lbl": []}
    for image in file.images:
        level, last = 0, 0
        while level <= last:
            image.level(level)
            last = max(last, len(image.levels) - 1)
            grid = image.grid(level, normals=True, texcoords=True, faces=True)
            mesh = image.mesh(level, normals=True, texcoords=True)
            split = image.mesh(level, split_sharp=True)
            assert np.array_equal(split.vertices[split.faces], mesh.vertices[mesh.faces])
            read["f32"].append(grid.positions)
            read["tri"].append(mesh.faces)
            read["vtx"] += [mesh.normals, mesh.texcoords]
            level += 1
    for name in ("normals", "colors", "displacements"):
        for image in file.images:
            try:
                levels = image.plane_levels(name)
            except gim.Error as error:
                if error.status != gim.NO_SUCH_PLANE:
                    raise
                continue
            read["pln"] += [image.plane(name, plane.level) for plane in levels]
    for image in file.images:
        try:
            read["lbl"] += [image.labels(level) for level in range(len(image.levels))]
        except gim.Error as error:
            if error.status != gim.NO_SUCH_PLANE:
                raise
    try:
        file.array()
    except gim.Error as error:
        if error.status != gim.NO_SUCH_PLANE:
            raise
    return {kind: b"".join(array.tobytes() for array in arrays) for kind, arrays in read.items()}

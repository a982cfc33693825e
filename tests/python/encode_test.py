#!/usr/bin/env python3
"""gim.encode: round trips through the program, its warnings and its refusals."""

import os
import unittest
import warnings
from unittest import mock

from support import gim, needs_program, np, torus, PROGRAM

FAST = {"size": 33, "threads": 1, "program": PROGRAM}


def euler_characteristic(mesh):
    edges = np.sort(np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]]), axis=1)
    _, counts = np.unique(edges, axis=0, return_counts=True)
    return len(mesh.vertices) - len(counts) + len(mesh.faces), set(counts)


@needs_program
class Encode(unittest.TestCase):
    def test_round_trip(self):
        vertices, faces = torus(24, 16)
        data = gim.encode(vertices, faces, quality=80, **FAST)
        self.assertIsInstance(data, bytes)
        file = gim.open(data)
        self.assertEqual((file.info.layout, file.levels[0].width), ("gim", 33))
        mesh = file.mesh(0)
        self.assertEqual(euler_characteristic(mesh), (0, {2}))
        x, y, z = mesh.vertices.T
        off = np.hypot(np.hypot(x, y) - 2, z) - 1  # the mesh itself is up to 0.04 inside of the torus
        self.assertLess(np.abs(off).max(), 0.1)

    def test_types_of_arrays(self):
        vertices, faces = torus(12, 8)
        wide = gim.encode(vertices, faces, **FAST)
        for v, f in ((vertices, faces.astype(np.uint16)), (vertices.tolist(), faces.tolist()),
                     (np.asfortranarray(vertices), faces[:, ::1].astype(np.int64)),
                     (vertices.astype(">f8"), faces.astype(">i4"))):
            self.assertEqual(gim.encode(v, f, **FAST), wide)
        self.assertTrue(gim.encode(vertices.astype(np.float32), faces, **FAST))

    def test_coordinates_far_from_zero_stay_doubles(self):
        vertices, faces = torus(12, 8)
        file = gim.open(gim.encode(vertices * 0.5 + 4e6, faces, **FAST))
        self.assertTrue(file.info.is_relative)
        batch, frames = gim.decode_batch([file], frames=True)
        middle = (frames.offset[0] + frames.scale[0] * batch[0].astype(np.float64)).mean(axis=(0, 1))
        self.assertLess(np.abs(middle - 4e6).max(), 2)

    def test_quads_normals_and_colors(self):
        vertices, faces = torus(12, 8)
        i, j = np.meshgrid(np.arange(12), np.arange(8), indexing="ij")
        quads = np.stack([i * 8 + j, (i + 1) % 12 * 8 + j, (i + 1) % 12 * 8 + (j + 1) % 8, i * 8 + (j + 1) % 8], -1)
        colors = np.zeros((len(vertices), 3), np.uint8)
        colors[:, 1] = 200
        data = gim.encode(vertices, quads.reshape(-1, 4), vertex_colors=colors, vertex_normals=vertices, normals=17,
                          **FAST)
        file = gim.open(data)
        self.assertEqual(file.planes, ("normals", "colors"))
        self.assertEqual(file.plane("normals").shape, (17, 17, 3))
        mean = file.plane("colors").mean(axis=(0, 1))
        self.assertTrue(np.allclose(mean, (0, 200 / 255, 0), atol=0.05), mean)

    def test_options_are_those_of_the_program(self):
        vertices, faces = torus(12, 8)
        data = gim.encode(vertices, faces, lossless=True, bits=10, strict=False, weld=None, **FAST)
        self.assertEqual((gim.open(data).info.coding, gim.open(data).info.bits), ("lossless", 10))
        for options, exit_status in (({"no_such": 1}, 2), ({"psnr": "loud"}, 2), ({"quality": 5, "psnr": 70}, 2)):
            with self.assertRaises(gim.Error) as caught:
                gim.encode(vertices, faces, **options, **FAST)
            self.assertEqual((caught.exception.status, caught.exception.exit_status), (None, exit_status))
            self.assertNotEqual(str(caught.exception), "")
        for name in ("format", "quiet", "x;y"):
            with self.assertRaises(TypeError):
                gim.encode(vertices, faces, **{name: "obj"}, **FAST)

    def test_bad_surfaces(self):
        vertices, faces = torus(12, 8)
        finned = np.concatenate([faces, [[faces[0, 0], faces[0, 1], 50]]])  # three faces at one edge
        with self.assertRaises(gim.Error) as caught:
            gim.encode(vertices, finned, strict=True, **FAST)
        self.assertEqual(caught.exception.exit_status, 1)
        with warnings.catch_warnings(record=True) as raised:
            warnings.simplefilter("always")
            self.assertTrue(gim.encode(vertices, finned, **FAST))
        self.assertTrue(any(w.category is UserWarning for w in raised))

    def test_bad_arrays(self):
        vertices, faces = torus(12, 8)
        for v, f in ((vertices[:, :2], faces), (vertices, faces + len(vertices)), (vertices, faces - 1),
                     (vertices, faces.astype(float)), (vertices, faces[:, :2]), (vertices[0], faces)):
            with self.assertRaises(ValueError):
                gim.encode(v, f, **FAST)
        with self.assertRaises(ValueError):
            gim.encode(vertices, faces, vertex_colors=np.zeros((3, 3), np.uint8), **FAST)
        with self.assertRaises(ValueError):
            gim.encode(vertices, faces, vertex_colors=np.zeros((len(vertices), 3)), **FAST)
        with self.assertRaises(gim.Error):
            gim.encode(np.zeros((0, 3)), np.zeros((0, 3), int), **FAST)
        with self.assertRaises(gim.Error):
            gim.encode(np.full_like(vertices, np.nan), faces, **FAST)

    def test_finding_the_program(self):
        vertices, faces = torus(12, 8)
        with mock.patch.dict(os.environ, {"PATH": "/nowhere"}):
            os.environ.pop("GIM_PROGRAM", None)
            with self.assertRaises(FileNotFoundError):
                gim.encode(vertices, faces)
            os.environ["GIM_PROGRAM"] = PROGRAM
            self.assertTrue(gim.encode(vertices, faces, size=17, threads=1))


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""gim.encode_image and File.array: images of other programs, there and back."""

import pathlib
import tempfile
import unittest

from support import gim, needs_program, np, valid, PROGRAM

FAST = {"threads": 1, "program": PROGRAM}


def atlas(dtype, channels=3):
    """Two pieces with a hole: height x width x channels, and the mask."""
    row, column = np.meshgrid(np.arange(24), np.arange(31), indexing="ij")
    mask = (column % 16 < 13) & ~((row % 9 > 5) & (column % 7 > 4)) & (row > 0)
    base = [3 * column + row, 4 * row, 20 + (column - 15) ** 2 // 8 + (row - 12) ** 2 // 9]
    values = np.stack([base[k % 3] + 2 * (k // 3) for k in range(channels)], -1)
    return np.where(mask[..., None], values, 0).astype(dtype), mask


@needs_program
class EncodeImage(unittest.TestCase):
    def test_whole_numbers_come_back_bit_by_bit(self):
        for dtype in ("uint8", "uint16", "int16", "uint32", "int32", "float16", "float32", "float64"):
            for channels in (3, 5):
                with self.subTest(dtype=dtype, channels=channels):
                    array, mask = atlas(dtype, channels)
                    file = gim.open(gim.encode_image(array, mask, lossless=True, **FAST))
                    back, defined = file.array()
                    self.assertEqual((back.dtype, file.info.layout), (array.dtype, "mcgim"))
                    np.testing.assert_array_equal(back, array)
                    np.testing.assert_array_equal(defined, mask)

    def test_forms_of_the_mask(self):
        array, mask = atlas("uint16")
        joined = np.concatenate([array, mask[..., None].astype("uint16") * 255], -1)
        for given in (joined, np.ascontiguousarray(joined.transpose(2, 0, 1))):
            back, defined = gim.open(gim.encode_image(given, lossless=True, **FAST)).array()
            np.testing.assert_array_equal(back, given)
            np.testing.assert_array_equal(defined, mask)
        holes = np.where(mask[..., None], array, np.nan).astype("float32")
        np.testing.assert_array_equal(gim.open(gim.encode_image(holes, lossless=True, **FAST)).array()[0], holes)
        first = np.concatenate([mask[..., None].astype("uint16"), array], -1)
        back, defined = gim.open(gim.encode_image(first, lossless=True, mask_channel=0, **FAST)).array()
        np.testing.assert_array_equal(back, first)
        np.testing.assert_array_equal(defined, mask)

    def test_floats_are_as_near_as_the_bits(self):
        array, mask = atlas("float32")
        array = np.sin(array * np.float32(0.01))
        extent = np.ptp(array[mask], axis=0).max()
        file = gim.open(gim.encode_image(array, mask, lossless=True, bits=14, **FAST))
        self.assertLess(np.abs(file.array()[0] - array)[mask].max(), 0.51 * extent / (2 ** 14 - 1))
        grid = file.positions(0)
        np.testing.assert_array_equal(np.isnan(grid[..., 0]), ~mask)
        np.testing.assert_allclose(grid[mask], file.array()[0][mask], atol=1e-6)

    def test_a_target_makes_it_smaller(self):
        array, mask = atlas("uint16")
        array = array * np.uint16(20) + np.random.default_rng(1).integers(0, 9, array.shape, np.uint16)
        exact, coarse = gim.encode_image(array, mask, lossless=True, **FAST), gim.encode_image(array, mask, psnr=45, **FAST)
        self.assertLess(len(coarse), len(exact))

    def test_samples_are_fitted_to_a_mesh(self):
        row, column = np.meshgrid(np.arange(17.0), np.arange(17.0), indexing="ij")
        coarse = np.stack([column, row, np.zeros_like(row)], -1).astype("float32")
        flat = coarse.reshape(-1, 3) + np.float32([0, 0, 0.5])
        faces = [(i, i + 1, i + 18, i + 17) for r in range(16) for i in range(17 * r, 17 * r + 16)]
        back, _ = gim.open(gim.encode_image(coarse, refit=(flat, faces), lossless=True, bits=16, **FAST)).array()
        np.testing.assert_allclose(back[..., 2], 0.5, atol=1e-3)
        with tempfile.TemporaryDirectory() as folder:
            name = pathlib.Path(folder, "flat.obj")
            name.write_text("".join("v %g %g %g\n" % tuple(p) for p in flat) +
                            "".join("f %d %d %d %d\n" % tuple(i + 1 for i in f) for f in faces))
            data = gim.encode_image(coarse, refit=name, lossless=True, bits=16, **FAST)
            np.testing.assert_array_equal(gim.open(data).array()[0], back)
        with self.assertRaises(gim.Error) as caught:
            gim.encode_image(coarse, refit="nowhere.ply", lossless=True, **FAST)
        self.assertIn("nowhere.ply", str(caught.exception))

    def test_what_is_no_image_is_refused(self):
        for array, mask in ((np.zeros((4, 4)), None), (np.zeros((8, 8, 3)), np.zeros((8, 8), bool)),
                            (np.zeros((8, 8, 3)), np.ones((8, 7), bool)), (np.array([[["a"] * 3] * 8] * 8), None)):
            with self.assertRaises(gim.Error) as caught:
                gim.encode_image(array, mask, lossless=True, **FAST)
            self.assertEqual(caught.exception.exit_status, 1)

    def test_limits_hold(self):
        data = gim.encode_image(*atlas("uint16", 9), lossless=True, **FAST)
        with self.assertRaises(gim.Error) as caught:
            gim.open(data, gim.Limits(max_samples=24 * 31)).array()
        self.assertEqual(caught.exception.status, gim.LIMIT_EXCEEDED)
        with self.assertRaises(gim.Error) as caught:
            gim.open(data, gim.Limits(max_memory=5000)).array()
        self.assertEqual(caught.exception.status, gim.LIMIT_EXCEEDED)


class OtherFiles(unittest.TestCase):
    def test_have_no_array(self):
        for name in ("sphere-17-lossless", "charts-open-lossless"):
            with self.assertRaises(gim.Error) as caught:
                gim.open(valid(name)).array()
            self.assertEqual(caught.exception.status, gim.NO_SUCH_PLANE)


if __name__ == "__main__":
    unittest.main()

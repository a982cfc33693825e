#!/usr/bin/env python3
"""gim.decode_batch: every form of its array against Image.positions, threads, memory, errors."""

import itertools
import pickle
import tracemalloc
import unittest

from support import VECTORS, gim, np, valid

SQUARES = [valid(name) for name in ("sphere-33-lossy", "torus-33-lossy", "schema-33-lossy-2", "schema-33-lossy-3")]
FORMS = list(itertools.product((np.float32, np.float16, np.uint16), ("HWC", "CHW"), ("xyz", "xyzm")))


def in_rows(batch, layout):
    """n x height x width x channels, whatever the layout."""
    return batch if layout == "HWC" else np.moveaxis(batch, 1, -1)


class Forms(unittest.TestCase):
    def check(self, items, level, tolerances):
        exact = [gim.open(item).positions(level) for item in items]
        origins = [np.array(f.info.origin) * f.info.is_relative for f in map(gim.open, items)]
        for dtype, layout, channels in FORMS:
            with self.subTest(dtype=dtype.__name__, layout=layout, channels=channels):
                batch, frames = gim.decode_batch(items, level, dtype, layout, channels, frames=True)
                self.assertEqual(batch.dtype, dtype)
                self.assertTrue(batch.flags.c_contiguous)
                rows = in_rows(batch, layout)
                self.assertEqual(rows.shape, (len(items),) + exact[0].shape[:2] + (len(channels),))
                for index, positions in enumerate(exact):
                    self.check_item(rows[index], positions, origins[index], frames.offset[index], frames.scale[index],
                                    tolerances[dtype])

    def check_item(self, numbers, positions, origin, offset, scale, tolerance):
        here = ~np.isnan(positions[..., 0])
        restored = offset + scale * numbers[..., :3].astype(np.float64)
        wanted = positions.astype(np.float64) + origin
        side = np.ptp(wanted[here], axis=0).max()
        self.assertLessEqual(np.abs(restored[here] - wanted[here]).max(), tolerance * side)
        if numbers.dtype == np.float32:
            self.assertEqual(numbers[here][:, :3].tobytes(), positions[here].tobytes())
        elif numbers.dtype == np.float16:
            self.assertAlmostEqual(float(np.abs(numbers[here][:, :3]).max()), 1, places=2)
        else:
            self.assertEqual((numbers[here][:, :3].min(), numbers[here][:, :3].max()), (0, 65535))
        if numbers.shape[-1] == 4:
            full = 65535 if numbers.dtype == np.uint16 else 1
            self.assertTrue(np.array_equal(numbers[..., 3], np.where(here, full, 0)))
        if numbers.shape[-1] == 4 or numbers.dtype == np.uint16:
            self.assertTrue((numbers[~here][:, :3] == 0).all())
        else:
            self.assertTrue(np.isnan(numbers[~here]).all())

    TOLERANCES = {np.float32: 1e-12, np.float16: 2 ** -12 * 1.01, np.uint16: 0.51 / 65535}

    def test_squares(self):
        for level in (0, 1):
            self.check(SQUARES, level, self.TOLERANCES)

    def test_undefined_samples(self):
        for name in ("charts-unequal-lossy", "charts-open-lossy", "tiles-genus-2-sharp-lossy", "tiles-torus-lossy"):
            self.check([valid(name)] * 2, 0, self.TOLERANCES)
        positions = gim.open(valid("charts-unequal-lossy")).positions(0)
        self.assertTrue(np.isnan(positions).any())

    def test_origins_far_away(self):
        # Frames hold the origin in float64; values alone are relative to it.
        data = valid("wide-origin-lossless")
        self.assertTrue(gim.open(data).info.is_relative)
        self.check([data], 0, self.TOLERANCES)

    def test_a_flat_surface(self):
        data = valid("open-3-lossy")
        batch, frames = gim.decode_batch([data], 0, np.uint16, frames=True)
        positions = gim.open(data).positions(0)
        self.assertTrue(np.allclose(frames.offset[0] + frames.scale[0] * batch[0], positions, atol=frames.scale[0]))

    def test_items_of_every_kind(self):
        path = VECTORS / "valid" / "sphere-33-lossy.gim"
        data = path.read_bytes()
        file = gim.open(data)
        items = [path, str(path), data, bytearray(data), memoryview(data), file, file.images[0]]
        batch = gim.decode_batch(items)
        for item in batch:
            self.assertEqual(item.tobytes(), file.positions(0).tobytes())
        two = gim.open(valid("two-images-lossy"))
        same = [image for image in two.images if image.levels[0].width == two.images[0].levels[0].width]
        self.assertEqual(gim.decode_batch(same)[0].tobytes(), two.images[0].positions(0).tobytes())

    def test_the_callers_array(self):
        for dtype, layout, channels in FORMS:
            new = gim.decode_batch(SQUARES, 0, dtype, layout, channels)
            out = np.full_like(new, 3)
            self.assertIs(gim.decode_batch(SQUARES, 0, dtype, layout, channels, out=out), out)
            self.assertEqual(out.tobytes(), new.tobytes())
        with self.assertRaises(ValueError):
            gim.decode_batch(SQUARES, 0, out=np.empty((4, 33, 33, 3)))


class Threads(unittest.TestCase):
    def test_threads_give_the_same_array(self):
        items = SQUARES * 8
        for dtype, layout, channels in FORMS:
            one, of_one = gim.decode_batch(items, 0, dtype, layout, channels, frames=True)
            for threads in (2, 3, 8, 100, 0):
                many, of_many = gim.decode_batch(items, 0, dtype, layout, channels, threads, frames=True)
                self.assertEqual(many.tobytes(), one.tobytes())
                self.assertEqual(of_many.offset.tobytes(), of_one.offset.tobytes())
                self.assertEqual(of_many.scale.tobytes(), of_one.scale.tobytes())

    def test_a_broken_item_is_named(self):
        items = SQUARES * 2
        items[5] = items[5][:-1] + bytes([items[5][-1] ^ 1])
        for threads in (1, 2, 8):
            with self.assertRaises(gim.Error) as caught:
                gim.decode_batch(items, threads=threads)
            self.assertEqual((caught.exception.item, caught.exception.status_name), (5, "checksum"))
            self.assertTrue(str(caught.exception).startswith("item 5: "))

    def test_errors_travel_between_processes(self):
        with self.assertRaises(gim.Error) as caught:
            gim.decode_batch([b"nothing" * 10])
        again = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual((again.status, again.item, str(again)), (gim.NOT_GIM, 0, str(caught.exception)))


class Refusals(unittest.TestCase):
    def test_items_that_do_not_fit(self):
        for other, word in ((valid("sphere-17-lossless"), "17 x 17"), (valid("two-images-lossy"), "2 images")):
            with self.assertRaises(gim.Error) as caught:
                gim.decode_batch([SQUARES[0], other])
            self.assertEqual(caught.exception.item, 1)
            self.assertIn(word, str(caught.exception))

    def test_arguments(self):
        for arguments in ({"dtype": np.float64}, {"dtype": np.int32}, {"layout": "WHC"}, {"channels": "xy"},
                          {"threads": -1}):
            with self.assertRaises(ValueError):
                gim.decode_batch(SQUARES, **arguments)
        with self.assertRaises(ValueError):
            gim.decode_batch([])

    def test_memory_stays_below_the_limit(self):
        items, threads = SQUARES * 8, 2
        scratch = max(gim.open(item).levels[0].scratch_size for item in SQUARES)
        need = len(items) * 33 * 33 * 4 * 2 + threads * (scratch + 16 + 33 * 33 * 13)
        call = lambda most: gim.decode_batch(items, 0, np.float16, "CHW", "xyzm", threads,
                                             limits=gim.Limits(max_memory=most))
        call(need)
        tracemalloc.start()
        before = tracemalloc.get_traced_memory()[0]
        call(need)
        peak = tracemalloc.get_traced_memory()[1] - before
        tracemalloc.stop()
        self.assertLess(peak, need + 64 * 1024)  # objects of Python and numpy's temporaries of one row
        path = VECTORS / "valid" / "sphere-33-lossy.gim"
        size, need = path.stat().st_size, 2 * 33 * 33 * 12 + scratch + 16
        gim.decode_batch([path, path], limits=gim.Limits(max_memory=need + size))
        with self.assertRaises(gim.Error) as caught:
            gim.decode_batch([path, path], limits=gim.Limits(max_memory=2 * 33 * 33 * 12 + size))
        self.assertEqual((caught.exception.status, caught.exception.item), (gim.LIMIT_EXCEEDED, 0))
        for most in (0, 1000, len(items) * 33 * 33 * 4 * 2 + 1000):
            with self.assertRaises(gim.Error) as caught:
                call(most)
            self.assertEqual(caught.exception.status, gim.LIMIT_EXCEEDED)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""gim.open and what it returns: sources, levels, several images, limits, arrays that nobody copied."""

import copy
import mmap
import pickle
import tempfile
import threading
import tracemalloc
import unittest
from pathlib import Path

from support import VECTORS, gim, np, valid


class Sources(unittest.TestCase):
    def setUp(self):
        self.data = valid("sphere-33-lossy")
        self.expected = gim.open(self.data).positions(0)

    def check(self, source):
        self.assertEqual(gim.open(source).positions(0).tobytes(), self.expected.tobytes())

    def test_paths(self):
        path = VECTORS / "valid" / "sphere-33-lossy.gim"
        self.check(path)
        self.check(str(path))
        with self.assertRaises(FileNotFoundError):
            gim.open("no-such-file.gim")

    def test_buffers(self):
        array = np.frombuffer(self.data, np.uint8)
        for source in (self.data, bytearray(self.data), memoryview(self.data), array, memoryview(b"x" + self.data)[1:]):
            self.check(source)

    def test_mapped_file(self):
        with (VECTORS / "valid" / "sphere-33-lossy.gim").open("rb") as file:
            with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as mapped:
                self.check(mapped)

    def test_an_open_file_stays_itself(self):
        file = gim.open(self.data)
        self.assertIs(gim.open(file), file)

    def test_other_things_are_refused(self):
        for source in (None, 7, ["a"]):
            with self.assertRaises(TypeError):
                gim.open(source)
        with self.assertRaises((ValueError, BufferError)):
            gim.open(np.frombuffer(self.data * 2, np.uint8)[::2])

    def test_bytes_are_not_copied(self):
        array = np.frombuffer(bytearray(self.data), np.uint8)
        file = gim.open(array)
        self.assertTrue(np.shares_memory(file._data, array))
        self.assertEqual(file._arguments[1], array.__array_interface__["data"][0])

    def test_the_file_keeps_its_bytes_alive(self):
        file = gim.open(bytearray(self.data))
        self.assertEqual(file.positions(0).tobytes(), self.expected.tobytes())
        taken = bytearray(self.data)
        file = gim.open(taken)
        with self.assertRaises(BufferError):
            taken.clear()

    def test_copies_have_bytes_of_their_own(self):
        file = gim.open(self.data, gim.Limits(max_images=3))
        for again in (pickle.loads(pickle.dumps(file)), copy.copy(file), copy.deepcopy(file.images[0])):
            self.assertEqual(again.positions(0).tobytes(), self.expected.tobytes())
        self.assertEqual(copy.copy(file)._limits, file._limits)

    def test_empty_input_asks_for_more(self):
        for source in (b"", bytearray(), np.zeros(0, np.uint8)):
            with self.assertRaises(gim.Error) as caught:
                gim.open(source)
            self.assertEqual(caught.exception.status, gim.NEED_MORE_INPUT)


class Contents(unittest.TestCase):
    def test_info_and_levels(self):
        data = valid("bounds")
        file = gim.open(data)
        self.assertEqual((file.info.layout, file.info.image_count), ("gim", 1))
        self.assertEqual(file.info.file_size, len(data))
        self.assertEqual(len(file.levels), file.info.level_count)
        for level in file.levels:
            mesh = file.mesh(level.level)
            self.assertEqual(mesh.vertices.shape, (level.vertex_count, 3))
            self.assertEqual(mesh.faces.shape, (level.triangle_count, 3))
            self.assertIsNone(mesh.normals)
            self.assertLess(mesh.faces.max(), level.vertex_count)

    def test_boxes_hold_the_surface(self):
        file = gim.open(valid("bounds-two-images"))
        for image in file.images:
            for corners in (image.box, file.info.box):
                for level in image.levels:
                    vertices = image.mesh(level.level).vertices
                    self.assertTrue((vertices >= corners.low).all() and (vertices <= corners.high).all())
        without = gim.open(valid("bounds-without-boxes"))
        self.assertIsNone(without.info.box)
        self.assertIsNone(without.images[0].box)

    def test_errors_choose_the_level(self):
        file = gim.open(valid("bounds"))
        self.assertEqual([(level.rms_error, level.max_error) for level in file.levels],
                         list(zip(file.info.rms_errors, file.info.max_errors)))
        fov, height = 1.0, 1000
        one_pixel = lambda level: file.levels[level].max_error / (2 * np.tan(fov / 2) / height)  # at this distance
        told = [level.level for level in file.levels[1:] if level.max_error > 0]
        self.assertNotEqual(told, [])
        for level in told:
            self.assertEqual(file.choose_level(one_pixel(level) * 1.01, fov, height), level)
            self.assertEqual(file.choose_level(one_pixel(level) * 1.01 / 3, fov, height, pixel_error=3), level)
            # A coarser level has to earn it; a finer one comes at once.
            self.assertEqual(file.choose_level(one_pixel(level) * 1.01, fov, height, shown=level - 1), level - 1)
            self.assertEqual(file.choose_level(one_pixel(level) * 1.01, fov, height, shown=level), level)
            self.assertLess(file.choose_level(one_pixel(level) * 0.99, fov, height, shown=level), level)
        self.assertEqual(file.choose_level(0, fov, height), 0)
        self.assertEqual(file.choose_level(float("nan"), fov, height), 0)

    def test_a_prefix_holds_its_levels(self):
        data = valid("sphere-33-lossy")
        levels = gim.open(data).levels
        coarsest = levels[-1]
        self.assertLess(coarsest.prefix_size, len(data))
        prefix = gim.open(data[: coarsest.prefix_size])
        self.assertEqual(prefix.positions(coarsest.level).tobytes(), gim.open(data).positions(coarsest.level).tobytes())
        with self.assertRaises(gim.Error) as caught:
            prefix.positions(0)
        self.assertEqual(caught.exception.status, gim.NEED_MORE_INPUT)

    def test_levels_that_are_not_there(self):
        file = gim.open(valid("sphere-33-lossy"))
        self.assertEqual(file.positions(np.int64(1)).shape, file.positions(1).shape)
        with self.assertRaises(TypeError):
            file.positions(0.5)
        for level in (len(file.levels), -1, 2 ** 32, 2 ** 70):
            with self.assertRaises(gim.Error) as caught:
                file.positions(level)
            self.assertEqual((caught.exception.status, caught.exception.status_name),
                             (gim.NO_SUCH_LEVEL, "no-such-level"))

    def test_several_images_make_one_mesh(self):
        file = gim.open(valid("two-images-lossy"))
        self.assertEqual(len(file.images), 2)
        whole = file.mesh(0, normals=True, texcoords=True)
        parts = [image.mesh(0, normals=True, texcoords=True) for image in file.images]
        first = len(parts[0].vertices)
        self.assertEqual(whole.vertices.tobytes(), b"".join(part.vertices.tobytes() for part in parts))
        self.assertEqual(whole.normals.tobytes(), b"".join(part.normals.tobytes() for part in parts))
        self.assertEqual(whole.texcoords.tobytes(), b"".join(part.texcoords.tobytes() for part in parts))
        self.assertTrue(np.array_equal(whole.faces, np.concatenate([parts[0].faces, parts[1].faces + first])))
        self.assertIsNone(file.levels[0].width)
        self.assertEqual(file.levels[0].vertex_count, len(whole.vertices))

    def test_several_images_have_no_single_grid(self):
        file = gim.open(valid("two-images-lossy"))
        for call in (file.positions, file.grid, lambda: file.plane("normals")):
            with self.assertRaises(gim.Error) as caught:
                call()
            self.assertIn("2 images", str(caught.exception))

    def test_planes(self):
        file = gim.open(valid("planes-sphere-17"))
        self.assertIn("normals", file.planes)
        for name in file.planes:
            for level in file.images[0].plane_levels(name):
                self.assertEqual(file.plane(name, level.level).shape, (level.height, level.width, 3))
        with self.assertRaises(ValueError):
            file.plane("heights")
        with self.assertRaises(gim.Error) as caught:
            gim.open(valid("sphere-33-lossy")).plane("normals")
        self.assertEqual(caught.exception.status, gim.NO_SUCH_PLANE)

    def test_text(self):
        self.assertEqual(gim.open(valid("text-plain")).text, "a short text")
        self.assertTrue(gim.open(valid("text-zstd")).text.startswith("the same words again and again; "))
        self.assertEqual(gim.open(valid("sphere-33-lossy")).text, "")

    def test_sharp_edges_split(self):
        file = gim.open(valid("tiles-genus-2-sharp-lossy"))
        shared, split = file.mesh(0, normals=True), file.mesh(0, normals=True, texcoords=True, split_sharp=True)
        self.assertGreater(len(split.vertices), len(shared.vertices))
        self.assertEqual(len(split.texcoords), len(split.vertices))
        self.assertTrue(np.array_equal(split.vertices[split.faces], shared.vertices[shared.faces]))
        self.assertFalse(np.array_equal(split.normals[split.faces], shared.normals[shared.faces]))

    def test_normals_are_of_unit_length(self):
        mesh = gim.open(valid("sphere-33-lossy")).mesh(0, normals=True)
        lengths = np.linalg.norm(mesh.normals, axis=1)
        self.assertTrue(((abs(lengths - 1) < 1e-5) | (lengths == 0)).all())
        self.assertGreater((lengths > 0).mean(), 0.9)


class Arrays(unittest.TestCase):
    def setUp(self):
        self.file = gim.open(valid("sphere-33-lossy"))

    def test_results_are_written_into_the_callers_array(self):
        out = np.full((33, 33, 3), 7, np.float32)
        self.assertIs(self.file.positions(0, out=out), out)
        self.assertEqual(out.tobytes(), self.file.positions(0).tobytes())
        stack = np.empty((2, 33, 33, 3), np.float32)
        self.file.positions(0, out=stack[1])
        self.assertEqual(stack[1].tobytes(), out.tobytes())
        self.assertIs(self.file.grid(0, out=out).positions, out)

    def test_arrays_of_another_shape_are_refused(self):
        right = np.empty((33, 33, 3), np.float32)
        read_only = right.copy()
        read_only.flags.writeable = False
        for out in (np.empty((33, 33, 4), np.float32), np.empty((33, 33, 3)), right.transpose(1, 0, 2), read_only,
                    np.empty(33 * 33 * 12 + 1, np.uint8)[1:].view(np.float32).reshape(33, 33, 3), [1, 2]):
            with self.assertRaises(ValueError):
                self.file.positions(0, out=out)

    def test_decoding_takes_the_result_and_the_scratch_and_no_more(self):
        level = self.file.levels[0]
        self.file.positions(0)
        tracemalloc.start()
        before = tracemalloc.get_traced_memory()[0]
        tracemalloc.reset_peak()
        self.file.positions(0)
        peak = tracemalloc.get_traced_memory()[1] - before
        tracemalloc.stop()
        self.assertLess(peak, level.scratch_size + 33 * 33 * 12 + 4096)

    def test_threads_may_share_a_file(self):
        expected = self.file.mesh(0, normals=True)
        wrong = []

        def decode():
            for _ in range(50):
                mesh = self.file.mesh(0, normals=True)
                same = [a.tobytes() == b.tobytes() for a, b in zip(mesh[:3], expected[:3])]
                wrong.extend([1] * same.count(False))

        threads = [threading.Thread(target=decode) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(wrong, [])


class OfLimits(unittest.TestCase):
    def assert_refused(self, call):
        with self.assertRaises(gim.Error) as caught:
            call()
        self.assertEqual(caught.exception.status, gim.LIMIT_EXCEEDED)

    def test_samples_images_sides(self):
        data = valid("two-images-lossy")
        samples = gim.open(data).info.sample_count
        gim.open(data, gim.Limits(max_samples=samples, max_images=2))
        self.assert_refused(lambda: gim.open(data, gim.Limits(max_samples=samples - 1)))
        self.assert_refused(lambda: gim.open(data, gim.Limits(max_images=1)))
        self.assert_refused(lambda: gim.open(data, gim.Limits(max_side=16)))

    def test_memory(self):
        data = valid("sphere-33-lossy")
        level = gim.open(data).levels[0]
        need = 33 * 33 * 12 + level.scratch_size + 16
        gim.open(data, gim.Limits(max_memory=need)).positions(0)
        self.assert_refused(lambda: gim.open(data, gim.Limits(max_memory=need - 1)).positions(0))
        self.assert_refused(lambda: gim.open(data, gim.Limits(max_memory=10000)).mesh(0))
        self.assert_refused(lambda: gim.open(valid("two-images-lossy"), gim.Limits(max_memory=10000)).mesh(0))
        self.assert_refused(lambda: gim.open(valid("planes-sphere-17"), gim.Limits(max_memory=100)).plane("normals"))
        self.assert_refused(lambda: gim.open(valid("text-zstd"), gim.Limits(max_memory=1)).text)

    def test_a_file_larger_than_the_memory_is_not_read(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "large.gim"
            path.write_bytes(valid("sphere-33-lossy") + bytes(100000))
            self.assert_refused(lambda: gim.open(path, gim.Limits(max_memory=50000)))

    def test_limits_out_of_range(self):
        for limits in (gim.Limits(max_samples=-1), gim.Limits(max_side=2 ** 40), gim.Limits(max_memory=-1)):
            with self.assertRaises(ValueError):
                gim.open(valid("sphere-33-lossy"), limits)


class OfErrors(unittest.TestCase):
    def test_an_error_says_what_is_wrong(self):
        with self.assertRaises(gim.Error) as caught:
            gim.open(b"not a gim file at all, whatever it may be")
        error = caught.exception
        self.assertEqual((error.status, error.status_name, error.item), (gim.NOT_GIM, "not-gim", None))
        self.assertEqual(str(error), "not a .gim file (not-gim)")


if __name__ == "__main__":
    unittest.main()

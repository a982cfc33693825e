#!/usr/bin/env python3
"""gim.py on every vector of spec/vectors, and on spoiled copies of the valid ones."""

import random
import unittest

from support import VECTORS, decode_all, gim, np

VALID = sorted((VECTORS / "valid").glob("*.gim"))
INVALID = sorted((VECTORS / "invalid").glob("*.gim"))
STATUSES = ("need-more-input", "not-gim", "unsupported-version", "malformed", "limit-exceeded", "checksum")


def status_of(data):
    """The name of the status with which a file is refused, or "ok"."""
    try:
        decode_all(data)
    except gim.Error as error:
        return error.status_name
    return "ok"


class Conformance(unittest.TestCase):
    def test_both_folders_hold_vectors(self):
        self.assertGreaterEqual(len(VALID), 8)
        self.assertGreaterEqual(len(INVALID), 20)

    def test_valid_files_decode_to_the_expected_bits(self):
        for path in VALID:
            for kind, data in decode_all(path.read_bytes()).items():
                with self.subTest(path.stem, kind=kind):
                    expected = path.with_suffix("." + kind)
                    self.assertEqual(data, expected.read_bytes() if expected.exists() else b"")

    def test_positions_are_those_of_the_grid(self):
        for path in VALID:
            for image in gim.open(path).images:
                for level in image.levels:
                    with self.subTest(path.stem, level=level.level):
                        positions = image.positions(level.level)
                        self.assertEqual(positions.shape, (level.height, level.width, 3))
                        self.assertEqual(positions.tobytes(), image.grid(level.level).positions.tobytes())

    def test_invalid_files_are_refused_for_the_right_reason(self):
        for path in INVALID:
            with self.subTest(path.name):
                expected = path.name.split(".")[0]
                self.assertIn(expected, STATUSES)
                self.assertEqual(status_of(path.read_bytes()), expected)

    def test_truncated_files_ask_for_more(self):
        for path in VALID:
            data = path.read_bytes()
            for size in {0, 1, 8, *range(0, len(data), max(1, len(data) // 20))}:
                with self.subTest(path.stem, size=size):
                    self.assertIn(status_of(data[:size]), ("need-more-input", "ok"))
            self.assertEqual(status_of(data[: len(data) // 3]), "need-more-input")

    def test_damaged_files_are_refused_or_give_the_same(self):
        rng = random.Random(1)
        for path in VALID:
            data = path.read_bytes()
            whole = decode_all(data)
            refused = 0
            for _ in range(60):
                damaged = bytearray(data)
                for _ in range(rng.choice((1, 1, 4))):
                    damaged[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
                with self.subTest(path.stem, damaged=damaged.hex() if len(data) < 300 else len(data)):
                    try:
                        self.assertEqual(decode_all(damaged), whole)
                    except gim.Error as error:
                        refused += 1
                        self.assertNotEqual(error.status, gim.BAD_ARGUMENT)
            self.assertGreater(refused, 30, path.stem)

    def test_noise_is_refused(self):
        rng = random.Random(2)
        for size in (1, 7, 64, 1000):
            noise = bytes(rng.randrange(256) for _ in range(size))
            for data in (noise, b"\x89GIM" + noise, VALID[0].read_bytes()[:40] + noise):
                with self.assertRaises(gim.Error):
                    decode_all(data)


if __name__ == "__main__":
    unittest.main()

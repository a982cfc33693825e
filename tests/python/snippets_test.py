#!/usr/bin/env python3
"""The examples of decoder/bindings/python/README.md run as they are printed, one after the other."""

import re
import sys
import types
import unittest

from support import PROGRAM, ROOT, gim, needs_program, np

README = ROOT / "decoder/bindings/python/README.md"


def torch_or_stand_in():
    """torch, or where it is not installed a module whose from_numpy returns the array."""
    try:
        import torch
    except ImportError:
        print("no torch: the example runs with numpy only", file=sys.stderr)
        torch = types.ModuleType("torch")
        torch.from_numpy = lambda array: array
        sys.modules["torch"] = torch
    return torch


@needs_program
class Snippets(unittest.TestCase):
    def test_examples_run(self):
        examples = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.S)
        self.assertGreaterEqual(len(examples), 4)
        torch_or_stand_in()
        names = {}
        for example in examples:
            exec(compile(example, str(README), "exec"), names)
        self.assertEqual(names["image"].shape, (65, 65, 3))
        self.check_shape(names["decode_shape"], names["data"], names["image"])
        wanted = gim.open(names["data"]).positions(1)
        for positions in names["positions"]:
            self.assertLess(np.abs(positions - wanted).max(), 6 / 65535)
        self.assertTrue(names["mask"].all())

    def check_shape(self, decode_shape, data, image):
        self.assertIsNone(decode_shape("a/shape.json", data))
        shape = np.asarray(decode_shape("a/shape.gim", data)).astype(np.float64)
        self.assertEqual(shape.shape, (3, 65, 65))
        lower, upper = image.min(axis=(0, 1)), image.max(axis=(0, 1))
        wanted = (image - (lower + upper) / 2) / ((upper - lower).max() / 2)
        self.assertLess(np.abs(shape - np.moveaxis(wanted, -1, 0)).max(), 1e-3)


if __name__ == "__main__":
    unittest.main()

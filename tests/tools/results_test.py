#!/usr/bin/env python3
"""tools/results.py: marks, tables and the check, on a small tree of its own."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HEAD = (ROOT / "corpus" / "results.csv").read_text(encoding="utf-8").splitlines()[0]


def row(model, setting, coder, size):
    cells = dict.fromkeys(HEAD.split(","), "")
    cells.update(model=model, setting=setting, coder=str(coder), bytes=str(size))
    return ",".join(cells.values())


class Script(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name)
        for folder in ("tools", "corpus", "spec", "encoder/include/gim"):
            (self.root / folder).mkdir(parents=True)
        self.write("tools/results.py", (ROOT / "tools" / "results.py").read_text(encoding="utf-8"))
        self.write("encoder/include/gim/encoder.h", "inline constexpr uint32_t kCoderVersion = 2;\n")
        self.write("corpus/rivals.csv", "# how\nmodel,bytes_at_60dB,bytes_at_65dB,bytes_at_70dB,bytes_at_75dB\nbunny,1000,2000,,\n")
        self.write("corpus/single-runs.csv", "input,command,coder,measured\nball,encode,1,\"1,000 bytes\"\n")
        self.write("README.md", "before\n<!-- sizes:begin -->\nold\n<!-- sizes:end -->\nafter\n")
        self.write_results(row("bunny", "file-60-db", 2, 500), row("bunny", "file-65-db", 1, 1500))

    def tearDown(self):
        self.folder.cleanup()

    def write(self, path, text):
        (self.root / path).write_text(text, encoding="utf-8")

    def write_results(self, *rows):
        self.write("corpus/results.csv", "\n".join([HEAD, *rows]) + "\n")

    def run_script(self, *arguments):
        return subprocess.run([sys.executable, self.root / "tools" / "results.py", *arguments], capture_output=True,
                              text=True).returncode

    def test_the_table_has_both_sizes_the_quotient_and_a_mark_on_older_coders_only(self):
        self.assertEqual(self.run_script("--no-plot"), 0)
        readme = (self.root / "README.md").read_text(encoding="utf-8")
        self.assertIn("| bunny | 500 / 1,000 = 0.50 | 1,500 † / 2,000 = 0.75 | - | - |", readme)
        page = (self.root / "corpus" / "RESULTS.md").read_text(encoding="utf-8")
        self.assertIn("| ball | `gim encode` | 1,000 bytes † |", page)
        self.assertTrue(readme.startswith("before\n") and readme.endswith("after\n"))

    def test_the_check_passes_on_what_was_written(self):
        self.assertEqual(self.run_script("--no-plot"), 0)
        self.assertEqual(self.run_script("--check"), 0)

    def test_the_check_fails_after_a_change_and_writes_nothing(self):
        self.assertNotEqual(self.run_script("--check"), 0)
        self.assertFalse((self.root / "corpus" / "RESULTS.md").exists())
        self.assertEqual(self.run_script("--no-plot"), 0)
        for rows in ([row("bunny", "file-60-db", 2, 501)], [row("bunny", "file-60-db", 1, 500)]):
            self.write_results(*rows)
            self.assertEqual(self.run_script("--check"), 1)


if __name__ == "__main__":
    unittest.main()

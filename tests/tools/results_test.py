#!/usr/bin/env python3
"""tools/results.py: marks, tables and the check, on a small tree of its own."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HEAD = (ROOT / "corpus" / "results.csv").read_text(encoding="utf-8").splitlines()[0]


# Two points of the rival. Half way between them in dB lies 65, half way in the logarithm of the bytes 2,000.
RIVAL_DEFECTS = """model,simplifier,ratio,bits,bytes,psnr,folded_faces,folded_area,over20,over45,normal_mean,normal_p95,normal_p99,p999_over_rms,max_over_rms,folded_back_edges
bunny,lt,0.1,8,1000,60,2,0.001,0.2,0.02,9,20,30,4,9,1
bunny,lt,0.2,9,4000,70,6,0.003,0.1,0.01,7,10,20,4,9,3
"""


def row(model, setting, coder, size, **figures):
    cells = dict.fromkeys(HEAD.split(","), "")
    cells.update(model=model, setting=setting, coder=str(coder), bytes=str(size))
    cells.update({column: str(value) for column, value in figures.items()})
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
        self.write("corpus/rival-defects.csv", "# how\n" + RIVAL_DEFECTS)
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

    def page(self):
        self.assertEqual(self.run_script("--no-plot"), 0)
        return (self.root / "corpus" / "RESULTS.md").read_text(encoding="utf-8")

    def test_defects_stand_beside_those_of_the_rival_at_equal_psnr_and_bytes(self):
        self.assertIn("No row has these figures yet.", self.page())
        self.write_results(row("bunny", "file-65-db", 2, 2000, psnr_db=65, folded_faces=9, folded_area=0.0001, off_by_20=0.3,
                               off_by_45=0.005, normals_p95=12.25, normals_p99=18, p999_over_rms=4.5, max_over_rms=8,
                               folded_back_edges=7, folded_back_edges_of_reference=1, level1_folded_faces=5,
                               level1_folded_area=0.002))
        page = self.page()
        self.assertIn("| bunny | 65 dB | 9 / 4 | 0.010 % / 0.200 % | 7 / 2 | 18.0 / 25.0 | 0.50 % / 1.50 % |", page)
        self.assertIn("| bunny | file-65-db | 2,000 | 9 | 0.010 % | 7 | 1 | 30.00 % | 0.50 % | 12.2 | 18.0 | 4.5 | 8.0 | 5 | "
                      "0.200 % |", page)

    def test_where_the_rival_was_not_measured_there_is_no_figure_of_it(self):
        self.write_results(row("bunny", "file-75-db", 1, 4200, psnr_db=75, folded_faces=9, normals_p99=18, off_by_45=0.005))
        self.assertIn("| bunny | 75 dB † | 9 / - | - / - | - / - | 18.0 / 20.0 | 0.50 % / 1.00 % |", self.page())

    def test_the_plot_is_drawn_with_and_without_defects(self):
        try:
            import matplotlib  # noqa: F401  pylint: disable=unused-import,import-outside-toplevel
        except ImportError:
            self.skipTest("no matplotlib")
        sizes = []
        for figures in ({}, {"folded_faces": 9, "normals_p99": 18}):
            self.write_results(row("bunny", "file-65-db", 2, 2000, psnr_db=65, **figures))
            self.assertEqual(self.run_script(), 0)
            sizes.append((self.root / "spec" / "rate-distortion.png").stat().st_size)
        self.assertGreater(sizes[1], sizes[0])

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

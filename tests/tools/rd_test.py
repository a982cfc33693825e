#!/usr/bin/env python3
"""tools/rd: the arithmetic of its curves, and a small run from mesh to pictures.

rd_test.py GIM GIM_CORPUS GIM_RIVALS|-    Exit status 77 (skipped): no matplotlib.
"""

import csv
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

RD = Path(__file__).resolve().parents[2] / "tools" / "rd"
sys.path.insert(0, str(RD))
import curves  # noqa: E402
import measure  # noqa: E402

PROGRAMS = []


class Curves(unittest.TestCase):
    def test_front_keeps_what_no_smaller_file_beats(self):
        points = [(300, 61), (100, 50), (200, 60), (250, 55), (200, 58), (400, 61)]
        self.assertEqual(curves.front(points), [(100, 50), (200, 60), (300, 61)])
        self.assertEqual(curves.front([(100, 5), (200, 6), (300, 2)], better=-1), [(100, 5), (300, 2)])

    def test_dents_between_near_points_are_no_part_of_a_curve(self):
        self.assertEqual(curves.psnr_curve([(100, 50), (200, 50.1), (300, 60)]), [(100, 50), (300, 60)])
        near, far = [(100, 60), (200, 60.5), (400, 62)], [(100, 60), (200, 62), (400, 68)]
        self.assertEqual(curves.psnr_curve(near), [(100, 60), (400, 62)])
        self.assertEqual(curves.psnr_curve(far), far)

    def test_bytes_are_interpolated_in_their_logarithm(self):
        points = [(1000, 60), (4000, 70)]
        self.assertAlmostEqual(curves.bytes_at(points, 65), 2000)
        self.assertEqual(curves.bytes_at(points, 60), 1000)

    def test_a_curve_ends_little_beyond_its_points(self):
        points = [(1000, 60.2), (4000, 70)]
        self.assertLess(curves.bytes_at(points, 60), 1000)
        self.assertIsNone(curves.bytes_at(points, 59))
        self.assertIsNone(curves.bytes_at(points, 71))
        self.assertIsNone(curves.bytes_at([], 60))

    def test_values_between_sizes_are_interpolated_and_kept_beyond_the_largest(self):
        curve = [(4000, 4.0), (1000, 8.0)]
        self.assertAlmostEqual(curves.value_at(curve, 2000), 6.0)
        self.assertEqual(curves.value_at(curve, 9000), 4.0)
        self.assertIsNone(curves.value_at(curve, 999))

    def test_recorded_rivals_are_read_and_empty_cells_left_out(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "rivals.csv"
            path.write_text("# how it was measured\nmodel,bytes_at_60dB,bytes_at_65dB\nball,,900\n", encoding="utf-8")
            self.assertEqual(curves.read_recorded_rivals(path), {"ball": [(900.0, 65.0)]})
            self.assertEqual(curves.read_recorded_rivals(Path(folder) / "none.csv"), {})


class Rows(unittest.TestCase):
    def test_a_torn_line_is_dropped_and_the_rest_kept(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "results.csv"
            row = dict.fromkeys(measure.COLUMNS, "1") | {"status": 'failed: a "comma", or two'}
            measure.Results(path).append(row)
            with open(path, "a", encoding="utf-8") as file:
                file.write("1,2,3,ok,17")
            self.assertEqual(list(measure.Results(path).rows.values()), [row])
            self.assertEqual(list(measure.Results(path).rows.values()), [row])


    def test_rows_of_a_file_with_fewer_columns_are_kept(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "results.csv"
            old = [column for column in measure.COLUMNS if column != "normals_p99"]
            path.write_text(",".join(old) + "\n" + ",".join("1" for _ in old) + "\n", encoding="utf-8")
            (row,) = measure.Results(path).rows.values()
            self.assertEqual(row, dict.fromkeys(measure.COLUMNS, "1") | {"normals_p99": ""})
            self.assertEqual(path.read_text(encoding="utf-8").splitlines()[0], ",".join(measure.COLUMNS))


class Run(unittest.TestCase):
    def run_on(self, folder, *more):
        gim, corpus, rivals = PROGRAMS
        mesh = folder / "ball.ply"
        subprocess.run([corpus, "torus-rough-4096", mesh], check=True)
        command = [sys.executable, RD / "run.py", "--models", mesh, "--out", folder / "out", "--gim", gim, "--sizes", "33",
                   "--quality", "50", "60", "--ratios", "0.2", "--full-bits", "9", "--simplified-bits", "8", "9",
                   "--samples", "2000", "--recorded-rivals", folder / "none.csv", *more]
        if rivals != "-":
            command += ["--gim-rivals", rivals]
        return subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)

    def test_from_mesh_to_pictures_and_again_without_measuring(self):
        tools = ["gim"] if PROGRAMS[2] == "-" else ["gim", "draco", "quadric+meshopt"]
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            first = self.run_on(folder, "--tools", *tools)
            self.assertEqual(first.returncode, 0, first.stderr)
            with open(folder / "out" / "results.csv", newline="", encoding="utf-8") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual({row["tool"] for row in rows}, set(tools))
            for row in rows:
                self.assertEqual(row["status"], "ok", row)
                self.assertGreater(float(row["psnr"]), 20, row)
                self.assertLess(float(row["normal_degrees"]), 90, row)
                self.assertGreater(float(row["normals_p99"]), float(row["normal_degrees"]), row)
                self.assertGreaterEqual(int(row["folded_faces"]), 0, row)
                self.assertGreater(int(row["bytes"]), 100, row)
            if "draco" in tools:
                self.assertTrue(all(float(r["decode_ms"]) > 0 for r in rows if r["tool"] == "draco"))
            for picture in ("ball-psnr.png", "ball-decode.png", "ball-normals.png", "summary.png"):
                self.assertGreater((folder / "out" / picture).stat().st_size, 1000, picture)
            self.assertIn("gim, one square", (folder / "out" / "tables.md").read_text(encoding="utf-8"))

            before = (folder / "out" / "results.csv").read_bytes()
            again = self.run_on(folder, "--no-plots", "--tools", *tools)
            self.assertEqual(again.returncode, 0, again.stderr)
            self.assertNotIn("ball gim size", again.stderr)
            self.assertEqual((folder / "out" / "results.csv").read_bytes(), before)

    def test_a_missing_program_is_told(self):
        with tempfile.TemporaryDirectory() as name:
            missing = self.run_on(Path(name), "--gim", "no-such-gim")
            self.assertEqual(missing.returncode, 2)
            self.assertIn("no-such-gim", missing.stderr)


if __name__ == "__main__":
    try:
        import matplotlib  # noqa: F401  pylint: disable=unused-import
    except ImportError:
        print(f"skipped: {sys.executable} has no matplotlib (Debian: apt-get install python3-matplotlib)")
        sys.exit(77)
    PROGRAMS = sys.argv[1:4]
    unittest.main(argv=sys.argv[:1], verbosity=2)

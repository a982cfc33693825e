"""Encodes, decodes and compares: one row per model, tool and setting. A CSV file keeps the rows for later runs."""

import csv
import hashlib
import io
import json
import os
import shutil
import subprocess
import threading
import time
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from pathlib import Path

import curves

COLUMNS = ["model", "tool", "setting", "status", "bytes", "psnr", "rms_to_test", "rms_to_reference", "hausdorff",
           "diagonal", "normal_degrees", "normals_p99", "off_by_45", "folded_faces", "folded_area", "folded_back_edges",
           "vertices", "triangles", "watertight", "encode_s", "decode_ms", "mtri_per_s",
           "program"]
KEY = COLUMNS[:3]

RATIOS = (0.7, 0.5, 0.35, 0.25, 0.17, 0.12, 0.085, 0.06, 0.04, 0.028, 0.02, 0.014, 0.01, 0.006, 0.003)
FULL_BITS = tuple(range(8, 17))
SIMPLIFIED_BITS = tuple(range(7, 15))
SATURATED_DB = 0.05  # if one more bit gains less, still more bits are not tried
SUFFIX = {"draco": ".drc", "meshopt": ".mzs"}


class Failure(Exception):
    """A program failed. Holds its own words."""


class Stopped(Exception):
    """The run stops."""


class Results:
    """Keeps the rows in memory and on disk. Appending is one write. Reading drops a line that an interruption tore, and
    leaves cells empty whose column an older file lacks."""

    def __init__(self, path):
        self.path = Path(path)
        self.lock = threading.Lock()
        self.rows = {}
        if self.path.exists():
            with open(self.path, newline="", encoding="utf-8") as file:
                for row in csv.DictReader(file):
                    if None not in row and None not in row.values():
                        self.rows[tuple(row[k] for k in KEY)] = {c: row.get(c, "") for c in COLUMNS}
        self.rewrite()

    def __contains__(self, key):
        return key in self.rows

    def get(self, key):
        return self.rows.get(key)

    def append(self, row):
        with self.lock:
            self.rows[tuple(row[k] for k in KEY)] = row
            with open(self.path, "a", newline="", encoding="utf-8") as file:
                file.write(self._text([row]))

    def drop(self, wanted):
        with self.lock:
            self.rows = {key: row for key, row in self.rows.items() if not wanted(row)}
        self.rewrite()

    def rewrite(self):
        with self.lock:
            fresh = self.path.with_suffix(".tmp")
            fresh.write_text(",".join(COLUMNS) + "\n" + self._text(self.rows.values()), encoding="utf-8")
            os.replace(fresh, self.path)

    def of_model(self, model):
        return [row for row in self.rows.values() if row["model"] == model]

    @staticmethod
    def _text(rows):
        out = io.StringIO()
        csv.DictWriter(out, COLUMNS, lineterminator="\n").writerows(rows)
        return out.getvalue()


class Programs:
    """Runs the programs. `paths` holds a path or None for each name."""

    def __init__(self, paths, timeout):
        self.paths = paths
        self.timeout = timeout
        self.lock, self.running, self.stopped = threading.Lock(), set(), False
        self.versions = {name: self._version(path) for name, path in paths.items()}

    @staticmethod
    def _version(path):
        return hashlib.sha256(Path(path).read_bytes()).hexdigest()[:8] if path else ""

    def run(self, name, *arguments):
        command = [str(self.paths[name]), *map(str, arguments)]
        # Runs in a session of its own, so that Ctrl-C reaches only this script, which then ends all programs.
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              start_new_session=True) as process:
            with self.lock:
                self.running.add(process)
                if self.stopped:
                    process.kill()
            try:
                out, errors = process.communicate(timeout=self.timeout)
            except subprocess.TimeoutExpired as error:
                process.kill()
                raise Failure(f"took more than {self.timeout:g} s") from error
            finally:
                with self.lock:
                    self.running.discard(process)
        if self.stopped:
            raise Stopped
        if process.returncode != 0:
            words = errors.strip().splitlines()
            raise Failure(words[-1] if words else f"exit status {process.returncode}")
        return out

    def stop(self):
        """Ends the running programs. Whoever waits for one gets Stopped."""
        with self.lock:
            self.stopped = True
            for process in self.running:
                process.kill()


def slug(tool, setting):
    return f"{tool}-{setting}".replace(" ", "-").replace("=", "")


class Laboratory:
    """Measures one point at a time. Its methods may run on several threads."""

    def __init__(self, programs, results, folder, samples, threads):
        self.programs, self.results, self.folder = programs, results, Path(folder)
        self.samples, self.threads = samples, threads
        self.locks, self.guard = {}, threading.Lock()

    def place(self, model):
        folder = self.folder / "work" / model.stem
        folder.mkdir(parents=True, exist_ok=True)
        return folder

    def payload(self, model, tool, setting):
        suffix = ".gim" if curves.is_own(tool) else SUFFIX[tool.split("+")[-1]]
        return self.place(model) / (slug(tool, setting) + suffix)

    def simplified(self, model, simplifier, ratio, ratios):
        """Returns the simplified mesh. The first call makes the meshes of all ratios."""
        prefix = self.place(model) / f"{simplifier}-"
        wanted = Path(f"{prefix}{ratio:g}.off")
        with self.guard:
            lock = self.locks.setdefault((model, simplifier), threading.Lock())
        with lock:
            if not wanted.exists():
                missing = [f"{r:g}" for r in ratios if not Path(f"{prefix}{r:g}.off").exists()]
                if simplifier == "lt":
                    self.programs.run("gim_lindstrom_turk", model, prefix, *missing)
                else:
                    self.programs.run("gim_rivals", "simplify", model, prefix, *missing)
        return wanted

    def measure(self, point):
        """Encodes, compares and records one point. A failure becomes a row too."""
        row = dict.fromkeys(COLUMNS, "")
        row.update(model=point.model.stem, tool=point.tool, setting=point.setting, status="ok",
                   program=self.programs.versions["gim" if curves.is_own(point.tool) else "gim_rivals"])
        try:
            file = self.payload(point.model, point.tool, point.setting)
            begin = time.monotonic()
            point.encode(self, file)
            row["encode_s"] = f"{time.monotonic() - begin:.2f}"
            row["bytes"] = file.stat().st_size
            row.update(self.compare(point, file))
        except Failure as failure:
            row["status"] = f"failed: {failure}"
        self.results.append({column: str(value) for column, value in row.items()})
        return row

    def compare(self, point, file):
        surface = file
        if not curves.is_own(point.tool):
            surface = file.with_suffix(file.suffix + ".off")
            self.programs.run("gim_rivals", "decode", file, surface)
        try:
            text = self.programs.run("gim", "compare", point.model, surface, "--json", "--samples", self.samples,
                                     "--threads", self.threads)
        finally:
            if surface != file:
                surface.unlink(missing_ok=True)
        found = json.loads(text)
        distances, topology = found["comparison"], found["test"]["topology"]
        row = {key: f"{distances[key]:.7g}" for key in ("rms_to_test", "rms_to_reference", "hausdorff", "diagonal")}
        row["psnr"] = "" if distances["psnr"] is None else f"{distances['psnr']:.4f}"
        row["normal_degrees"] = f"{distances['normal_error']['mean']:.4f}"
        defects = distances["defects"]
        row.update({key: f"{defects[key]:.5g}" for key in ("normals_p99", "off_by_45", "folded_area")})
        row.update({key: defects[key] for key in ("folded_faces", "folded_back_edges")})
        row.update({key: topology[key] for key in ("vertices", "triangles")})
        row["watertight"] = int(topology["watertight"])
        return row

    def time_decoders(self, model):
        """Measures the decode times of the rows that matter, in one run, so that their ratios are fair. Returns the
        number of rows."""
        rows = [r for of_tool in curves.by_tool(self.results.of_model(model.stem)).values()
                for r in curves.curve_rows(of_tool)]
        rows += [r for r in curves.usable(self.results.of_model(model.stem))
                 if curves.is_usual_full_mesh(r) and r not in rows]
        rows = [r for r in rows if self.payload(model, r["tool"], r["setting"]).exists()]
        if not rows or all(r["decode_ms"] for r in rows):
            return 0
        for row in self.results.of_model(model.stem):
            row["decode_ms"] = row["mtri_per_s"] = ""  # drops the times of an earlier run
        files = [self.payload(model, r["tool"], r["setting"]) for r in rows]
        for row, line in zip(rows, csv.DictReader(io.StringIO(self.programs.run("gim_rivals", "time", *files)))):
            row["decode_ms"], row["mtri_per_s"] = line["decode_ms"], line["mtri_per_s"]
        self.results.rewrite()
        return len(rows)


class Point:
    """One setting of one tool on one model. `encode(laboratory, file)` writes the file."""

    def __init__(self, model, tool, setting, encode):
        self.model, self.tool, self.setting, self.encode = model, tool, setting, encode

    @property
    def key(self):
        return (self.model.stem, self.tool, self.setting)


def gim_point(model, layout, side, target, value):
    def encode(laboratory, file):
        size = ["--size", side] if layout == "gim" else ["--samples", side * side]
        laboratory.programs.run("gim", "encode", model, file, "--layout", layout, *size, f"--{target}", f"{value:g}",
                                "--colors", 0, "--threads", laboratory.threads, "--quiet")

    return Point(model, layout, f"size={side} {target}={value:g}", encode)


def full_point(model, codec, bits):
    def encode(laboratory, file):
        laboratory.programs.run("gim_rivals", codec, model, file, "--bits", bits)

    return Point(model, codec, f"bits={bits}", encode)


def simplified_point(model, simplifier, codec, ratio, bits, ratios):
    def encode(laboratory, file):
        mesh = laboratory.simplified(model, simplifier, ratio, ratios)
        laboratory.programs.run("gim_rivals", codec, mesh, file, "--bits", bits)

    return Point(model, f"{simplifier}+{codec}", f"ratio={ratio:g} bits={bits}", encode)


def plan(models, tools, sizes, targets, ratios, full_bits, simplified_bits):
    """Returns chains of points: [(points, whether to stop when the PSNR saturates)]. Chains may run side by side."""
    chains = []
    for model in models:
        for tool in tools:
            if curves.is_own(tool):
                chains += [([gim_point(model, tool, side, *target)], False) for side in sizes for target in targets]
            elif "+" not in tool:
                chains += [([full_point(model, tool, bits)], False) for bits in full_bits]
            else:
                simplifier, codec = tool.split("+")
                chains += [([simplified_point(model, simplifier, codec, ratio, bits, ratios)
                             for bits in simplified_bits], True) for ratio in ratios]
    return chains


def run_chain(laboratory, points, may_stop, progress):
    before = None
    for i, point in enumerate(points):
        row = laboratory.results.get(point.key)
        if row is None:
            progress.begin(point)
            begin = time.monotonic()
            row = laboratory.measure(point)
            progress.end(point, row, time.monotonic() - begin)
        else:
            progress.skip([point])
        psnr = float(row["psnr"]) if row["status"] == "ok" and row["psnr"] else None
        if may_stop and before is not None and psnr is not None and psnr - before < SATURATED_DB:
            progress.skip(points[i + 1:])
            return
        before = psnr


def run_chains(laboratory, chains, jobs, progress):
    with ThreadPoolExecutor(max_workers=jobs) as pool:
        pending = {pool.submit(run_chain, laboratory, points, may_stop, progress) for points, may_stop in chains}
        try:
            while pending:
                done, pending = wait(pending, timeout=0.5, return_when=FIRST_COMPLETED)
                for future in done:
                    future.result()
        except BaseException:
            laboratory.programs.stop()
            pool.shutdown(wait=True, cancel_futures=True)
            raise


def find_program(name, given, root):
    """Returns the given path, else the newest build of this tree, else what the shell would find. None if missing."""
    if given:
        return Path(given).resolve() if Path(given).is_file() else None
    folders = [root / "build", *sorted((root / "build").glob("*"))]
    built = [f / part / name for f in folders for part in ("tools", "tools/rd")]
    built = [path for path in built if path.is_file() and os.access(path, os.X_OK)]
    if built:
        return max(built, key=lambda path: path.stat().st_mtime)
    found = shutil.which(name)
    return Path(found) if found else None

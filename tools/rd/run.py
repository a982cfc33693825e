#!/usr/bin/env python3
"""Rate-distortion curves of gim and of what people use instead.

gim codes each model as one square and as charts. Draco and meshoptimizer + zstd code it as it is and after
simplification (meshopt_simplify, or Lindstrom-Turk if CGAL is installed). Each program runs at many settings.
`gim compare` measures each decoded result against the model: symmetric PSNR, RMS distance both ways, Hausdorff
distance, the angle between shading normals (mean and 99th percentile) and visible defects. Samples are uniform by
area, on both surfaces. Each is compared with the nearest point of the other surface. The decoders are timed in memory,
on one thread, in turns. The folder --out receives:

  results.csv      one row per model, tool and setting; a later run keeps the rows and measures what is missing
  MODEL-psnr.png   PSNR over bytes;  MODEL-decode.png decode time over PSNR;  MODEL-normals.png normal error over bytes
  summary.png      PSNR over bytes of all models
  tables.md        bytes at 60, 65, 70, 75 dB, their ratio to the best rival, normals, decode speed; also printed
  work/            the coded files

Programs (once, in the root of the repository, on Debian 12):

  apt-get install libdraco-dev libmeshoptimizer-dev libcgal-dev python3-matplotlib
  cmake --preset release -DGIM_BUILD_RD=ON && cmake --build --preset release

The run leaves out missing programs, with a note. The rivals are for evaluation only: they are never installed and never
linked to gim. gim_lindstrom_turk is the only one that includes GPL headers (CGAL's). Example:

  python3 tools/rd/run.py --models bunny.ply horse.ply --out out/rd
"""

import argparse
import fcntl
import os
import signal
import sys
import threading
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import curves  # noqa: E402
import measure  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = {"gim": "cmake --preset release && cmake --build --preset release",
            "gim_rivals": "apt-get install libdraco-dev libmeshoptimizer-dev; build with -DGIM_BUILD_RD=ON",
            "gim_lindstrom_turk": "apt-get install libcgal-dev; build with -DGIM_BUILD_RD=ON"}
MEASURED_TOOLS = [tool for tool in curves.TOOLS if tool != "rivals.csv"]


def say(text):
    print(text, file=sys.stderr, flush=True)


def die(text):
    say(f"error: {text}")
    sys.exit(2)


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--models", nargs="+", required=True, type=Path, metavar="MESH", help="meshes, in a format that gim reads")
    add("--out", required=True, type=Path, metavar="DIR", help="folder for all results; made if missing")
    add("--tools", nargs="+", choices=MEASURED_TOOLS, default=MEASURED_TOOLS, metavar="TOOL",
        help="measure only these tools, of: " + ", ".join(MEASURED_TOOLS))
    add("--sizes", nargs="+", type=int, default=[129, 257, 513], metavar="N",
        help="gim: sides of the square; charts get N*N samples (default 129 257 513)")
    for name, what in (("psnr", "dB to reach"), ("bytes", "bytes not to exceed"), ("quality", "qualities, 0..100")):
        add(f"--{name}", nargs="+", type=float, default=[], metavar="X", help=f"gim: {what}")
    add("--ratios", nargs="+", type=float, default=measure.RATIOS, metavar="R",
        help="simplification: parts of the mesh to keep, 0..1")
    add("--full-bits", nargs="+", type=int, default=measure.FULL_BITS, metavar="B",
        help="bits per coordinate of unsimplified meshes (default 8..16)")
    add("--simplified-bits", nargs="+", type=int, default=measure.SIMPLIFIED_BITS, metavar="B",
        help="bits per coordinate of simplified meshes (default 7..14; stops when one more bit gains less than "
             f"{measure.SATURATED_DB} dB)")
    add("--recorded-rivals", type=Path, default=ROOT / "corpus" / "rivals.csv", metavar="CSV",
        help="one more rival: a table with columns model, bytes_at_60dB, ...; left out if the file is missing")
    add("--redo", nargs="+", choices=MEASURED_TOOLS, default=[], metavar="TOOL",
        help="drop the rows of these tools for the models, and measure them again")
    add("--retry-failed", action="store_true", help="measure failed settings again")
    add("--plots-only", action="store_true", help="measure nothing; write tables and pictures of the recorded rows")
    add("--no-plots", action="store_true", help="draw no pictures; needs no matplotlib")
    add("--samples", type=int, default=500000, help="samples on each surface of a comparison (default %(default)s)")
    add("--jobs", type=int, default=1,
        help="points to measure side by side; decoders are always timed alone (default %(default)s)")
    add("--timeout", type=float, default=1800, metavar="S",
        help="seconds that a program may take (default %(default)s)")
    for name in PROGRAMS:
        add("--" + name.replace("_", "-"), metavar="PATH",
            help=f"path of the program {name}; default: search build/ and PATH")
    arguments = parser.parse_args()
    if not (arguments.psnr or arguments.bytes or arguments.quality):
        arguments.psnr = [55, 60, 65, 70, 75, 80]
    return arguments


def lock(folder):
    """Allows one run at a time in a folder. The lock ends with the process."""
    file = open(folder / "lock", "w", encoding="utf-8")  # pylint: disable=consider-using-with
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        die(f"{folder}: another run uses this folder; wait for it or choose another --out")
    return file


def import_plots(unwanted):
    """Returns the module plots. None, with a note, if matplotlib is missing."""
    if unwanted:
        return None
    try:
        import plots  # pylint: disable=import-outside-toplevel
        return plots
    except ImportError as error:
        say(f"note: no pictures: {error} in {sys.executable}. Install matplotlib (Debian: apt-get install "
            "python3-matplotlib, then /usr/bin/python3), and run again with --plots-only")
        return None


class Progress:
    """Prints counts and a guess of the time left, on stderr. Assumes that all points of one tool take equally long."""

    FIRST_GUESS = {True: 20, False: 1}  # seconds; True: gim, False: others

    def __init__(self, chains, jobs):
        self.lock = threading.Lock()
        self.jobs = jobs
        self.left, self.seconds = {}, {}
        for points, _ in chains:
            for point in points:
                self.left[point.tool] = self.left.get(point.tool, 0) + 1
        self.total, self.done = sum(self.left.values()), 0

    def skip(self, points):
        with self.lock:
            for point in points:
                self._count(point)

    def begin(self, point):
        if sys.stderr.isatty():
            with self.lock:
                print(f"\r\033[K[{self.done}/{self.total}] {' '.join(point.key)} ...", end="", file=sys.stderr, flush=True)

    def end(self, point, row, seconds):
        with self.lock:
            self._count(point)
            self.seconds.setdefault(point.tool, []).append(seconds)
            words = f"{int(row['bytes']):,} bytes, {row['psnr'] or 'infinite'} dB" if row["status"] == "ok" else row["status"]
            clear = "\r\033[K" if sys.stderr.isatty() else ""
            say(f"{clear}[{self.done}/{self.total}] {' '.join(point.key)}: {words} ({self._left()})")

    def _count(self, point):
        self.done += 1
        self.left[point.tool] -= 1

    def _left(self):
        guess = 0
        for tool, count in self.left.items():
            times = self.seconds.get(tool) or [self.FIRST_GUESS[curves.is_own(tool)]]
            guess += count * sum(times) / len(times)
        guess /= self.jobs
        return f"at most {guess / 60:.0f} min left" if guess > 90 else f"at most {guess:.0f} s left"


def check_models(models):
    names = set()
    for model in models:
        if not model.is_file():
            die(f"{model}: no such file")
        if model.stem in names:
            die(f"{model}: two models are called {model.stem}, and results are kept by that name; rename one")
        names.add(model.stem)


def available_tools(wanted, paths):
    """Leaves out, with a note, each tool whose program is missing."""
    def needed(tool):
        if curves.is_own(tool):
            return ["gim"]
        return ["gim_rivals", "gim_lindstrom_turk"] if tool.startswith("lt+") else ["gim_rivals"]

    kept = []
    for tool in wanted:
        missing = [name for name in needed(tool) if not paths[name]]
        if missing:
            say(f"note: LEFT OUT: {curves.label(tool)}: the program {missing[0]} is missing ({PROGRAMS[missing[0]]})")
        else:
            kept.append(tool)
    return kept


def readable_models(models, programs):
    kept = []
    for model in models:
        try:
            programs.run("gim", "compare", model, model, "--samples", 1000)
            kept.append(model)
        except measure.Failure as failure:
            say(f"note: LEFT OUT: {failure}")
    return kept


def measure_all(arguments, models, results):
    given = {"gim": arguments.gim, "gim_rivals": arguments.gim_rivals, "gim_lindstrom_turk": arguments.gim_lindstrom_turk}
    paths = {name: measure.find_program(name, given[name], ROOT) for name in PROGRAMS}
    for name, path in paths.items():
        if given[name] and not path:
            die(f"{given[name]}: no such program")
    if not paths["gim"]:
        die(f"the program gim is missing. It measures everything. Build it: {PROGRAMS['gim']}; or name it with --gim")
    tools = available_tools(arguments.tools, paths)

    programs = measure.Programs(paths, arguments.timeout)
    models = readable_models(models, programs)
    names = {model.stem for model in models}
    results.drop(lambda row: row["model"] in names and
                 (row["tool"] in arguments.redo or (arguments.retry_failed and row["status"] != "ok")))
    old = {row["tool"] for row in results.rows.values() if row["model"] in names and row["tool"] in tools
           and curves.is_own(row["tool"]) and row["program"] != programs.versions["gim"]}
    if old:
        say(f"note: kept rows of another build of gim. To measure them again: --redo {' '.join(sorted(old))}")

    threads = 0 if arguments.jobs == 1 else max(1, (os.cpu_count() or 1) // arguments.jobs)
    laboratory = measure.Laboratory(programs, results, arguments.out, arguments.samples, threads)
    targets = [(name, value) for name in ("psnr", "bytes", "quality") for value in getattr(arguments, name)]
    chains = measure.plan(models, tools, arguments.sizes, targets, arguments.ratios, arguments.full_bits,
                          arguments.simplified_bits)
    progress = Progress(chains, arguments.jobs)
    measure.run_chains(laboratory, chains, arguments.jobs, progress)
    if not paths["gim_rivals"]:
        say("note: no decode times: gim_rivals is missing")
        return
    for i, model in enumerate(models):
        try:
            count = laboratory.time_decoders(model)
            if count:
                say(f"[{i + 1}/{len(models)}] {model.stem}: timed {count} files")
        except measure.Failure as failure:
            say(f"note: {model.stem}: decoders not timed: {failure}")


def write_results(arguments, models, results, plots):
    rows = {model.stem: results.of_model(model.stem) for model in models}
    rows = {name: of_model for name, of_model in rows.items() if of_model}
    recorded = curves.read_recorded_rivals(arguments.recorded_rivals)
    failed = [row for of_model in rows.values() for row in of_model if row["status"] != "ok"]
    text = "\n\n".join([curves.size_table(rows, recorded), curves.normal_table(rows, "normal_degrees", "mean normal error"),
                        curves.normal_table(rows, "normals_p99", "normal error, 99th percentile"), curves.decode_table(rows)])
    if failed:
        text += f"\n\n{len(failed)} settings failed:\n" + "\n".join(
            f"- {r['model']}, {r['tool']}, {r['setting']}: {r['status'][len('failed: '):]}" for r in failed)
    (arguments.out / "tables.md").write_text(text + "\n", encoding="utf-8")
    print(text)
    if plots and rows:
        plots.draw_all(arguments.out, rows, recorded)
        say(f"pictures, tables.md and results.csv are in {arguments.out}")


def interrupt(*_):
    raise KeyboardInterrupt


def main():
    arguments = parse_arguments()
    signal.signal(signal.SIGTERM, interrupt)
    signal.signal(signal.SIGINT, interrupt)  # a shell that starts this in the background ignores it
    check_models(arguments.models)
    plots = import_plots(arguments.no_plots)
    arguments.out.mkdir(parents=True, exist_ok=True)
    locked = lock(arguments.out)  # held until the end
    results = measure.Results(arguments.out / "results.csv")
    try:
        if not arguments.plots_only:
            measure_all(arguments, arguments.models, results)
    except KeyboardInterrupt:
        say("\ninterrupted; the measured rows are kept. Run the same command again to go on")
        return 130
    write_results(arguments, arguments.models, results, plots)
    return 0


if __name__ == "__main__":
    sys.exit(main())

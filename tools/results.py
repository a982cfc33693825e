#!/usr/bin/env python3
"""Writes the tables and the plot of what gim reaches, from the CSV files in corpus/.

  python3 tools/results.py           writes corpus/RESULTS.md, the table of sizes in README.md, spec/rate-distortion.png
  python3 tools/results.py --check   fails if RESULTS.md or README.md differ from what the command above would write

The plot needs matplotlib. Without it the old plot stays, and a note says so.
"""

import argparse
import csv
import math
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
RESULTS_CSV = ROOT / "corpus" / "results.csv"
RIVALS_CSV = ROOT / "corpus" / "rivals.csv"
RIVAL_DEFECTS_CSV = ROOT / "corpus" / "rival-defects.csv"
SINGLE_RUNS_CSV = ROOT / "corpus" / "single-runs.csv"
RESULTS_MD = ROOT / "corpus" / "RESULTS.md"
README = ROOT / "README.md"
PLOT = ROOT / "spec" / "rate-distortion.png"
ENCODER_H = ROOT / "encoder" / "include" / "gim" / "encoder.h"

BEGIN, END = "<!-- sizes:begin -->", "<!-- sizes:end -->"
TARGETS_DB = (60, 65, 70, 75)
COMPARED = ("bunny", "horse", "feline", "venus", "igea", "hand", "dragon", "gargoyle", "david", "rocker-arm")
OLD = "†"
SAME_CODE_SINCE = 5  # coder version; later ones gave files the same bytes
HEADER_NOTE = ("Version 5 fits squares of side 257 and more from coarse to fine. At the default quality, seven models take 1.3 % fewer\n"
               "bytes in the mean, from 7.6 % fewer to 1.1 % more. It codes borders of charts by those of the coarser level.\n"
               "Files of version 3 lack the errors and boxes of the header: as many bytes fewer as they have levels, and 7 for\n"
               "each image. That is 12 for a square of five levels.")
TILES = "▦"
REACH_DB = 0.5     # the rival's curve counts this far beyond its ends, with the values of the ends
REACH_BYTES = 1.1  # likewise, as a factor
PAPER_PSNR = {"horse": 84.6, "feline": 79.5, "dragon": 77.9, "gargoyle": 83.8}  # charts of Sander et al. 2003


def coder_version():
    found = re.search(r"kCoderVersion = (\d+);", ENCODER_H.read_text(encoding="utf-8"))
    if not found:
        sys.exit(f"error: {ENCODER_H} has no kCoderVersion")
    return int(found.group(1))


class Row:
    """One row of results.csv. A value that was not measured is None."""

    def __init__(self, cells, coder):
        self.cells = cells
        self.is_old = int(cells["coder"]) < min(coder, SAME_CODE_SINCE)
        self.failure = cells["bytes"] if cells["bytes"].startswith("failed") else None

    def number(self, column):
        text = self.cells[column]
        return float(text) if text and not self.failure else None

    def text(self, column, form=",.0f", unit=""):
        value = self.number(column)
        return "-" if value is None else format(value, form) + unit

    def percent(self, column, digits=2):
        value = self.number(column)
        return "-" if value is None else f"{100 * value:.{digits}f} %"

    def bytes(self):
        """Returns the bytes, with a mark if an older coder made the file."""
        return self.failure or self.text("bytes") + (f" {OLD}" if self.is_old else "")


def read_table(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def read_results(coder):
    """Returns {(model, setting): Row} in the order of the file."""
    return {(cells["model"], cells["setting"]): Row(cells, coder) for cells in read_table(RESULTS_CSV)}


def read_rivals():
    """Returns {model: {dB: bytes}}."""
    rivals = {}
    for cells in read_table(RIVALS_CSV):
        sizes = {db: cells[f"bytes_at_{db}dB"] for db in TARGETS_DB}
        rivals[cells["model"]] = {db: float(size) for db, size in sizes.items() if size}
    return rivals


def read_rival_defects():
    """Returns {model: [{column: value}]}."""
    rivals = {}
    for cells in read_table(RIVAL_DEFECTS_CSV):
        numbers = {key: float(text) for key, text in cells.items() if key not in ("model", "simplifier")}
        rivals.setdefault(cells["model"], []).append(numbers)
    return rivals


def markdown(head, lines):
    out = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    return "\n".join(out + ["| " + " | ".join(line) + " |" for line in lines])


def of_setting(results, setting):
    return [row for (_, name), row in results.items() if name == setting]


# ---- the table against rivals ----------------------------------------------------------------------------------------

def raced(results, model, db):
    """Returns the row of the layout that won, else that of the square."""
    return results.get((model, f"auto-{db}-db")) or results.get((model, f"file-{db}-db"))


def square(results, model, db):
    return results.get((model, f"file-{db}-db"))


def size_cell(row, rival):
    """Returns the bytes of gim, the bytes of the rival and their quotient."""
    if row is None or row.failure:
        return "-"
    size = row.bytes() + (f" {TILES}" if row.cells["layout"] == "tiles" else "")
    if rival is None:
        return size
    return f"{size} / {rival:,.0f} = {row.number('bytes') / rival:.2f}"


def size_lines(results, rivals, models, find):
    lines = []
    for model in models:
        found = [find(results, model, db) for db in TARGETS_DB]
        if any(found):
            sizes = rivals.get(model, {})
            lines.append([model] + [size_cell(row, sizes.get(db)) for row, db in zip(found, TARGETS_DB)])
    return lines


def size_table(results, rivals, models, find=raced):
    lines = size_lines(results, rivals, models, find)
    notes = [f"{TILES} Tiles. The others are squares."] if TILES in str(lines) else []
    if any(OLD in cell for line in lines for cell in line):
        notes.append(f"{OLD} An older coder made this file. It was not measured again.")
    return "\n\n".join([markdown(["model"] + [f"{db} dB" for db in TARGETS_DB], lines), " ".join(notes)]).rstrip()


def with_size_table(text, table):
    begin, end = text.find(BEGIN), text.find(END)
    if begin < 0 or end < begin:
        sys.exit(f"error: {README} lacks the markers {BEGIN} and {END}")
    return text[:begin + len(BEGIN)] + "\n" + table + "\n" + text[end:]


# ---- RESULTS.md ------------------------------------------------------------------------------------------------------

def intro(coder, results):
    old = sum(row.is_old for row in results.values())
    stale = (f"An older coder made {old} of {len(results)} rows. They are marked {OLD}.\n"
             "Their bytes and distances may not be what the program gives today." if old else "No row is marked as made by an older coder.")
    return f"""# Results

`tools/results.py` writes this page from [`results.csv`](results.csv), [`rivals.csv`](rivals.csv),
[`rival-defects.csv`](rival-defects.csv) and [`single-runs.csv`](single-runs.csv). Do not edit it.
`gim_results` writes `results.csv`. `CONTRIBUTING.md` says how.

The coder has version {coder}. {stale}
{HEADER_NOTE}

How the figures were measured:

- One run for each row: Release build, GCC 12, two cores. Positions and connectivity only, no colours and no normal map.
- PSNR is 20 log10(bounding-box diagonal / RMS distance) of the decoded surface against the input mesh. The RMS distance is weighted
  by area. It is taken both ways and the larger one counts. `gim compare` prints the same figure.
- Folded triangles look away from the input. "Visible defects" below says how that and the other defects are measured.
- Bytes, distances and defects do not depend on the machine. Times do.
- Decoding time is the best of 20 runs of `gim_decode_mesh` with normals, on one thread, at full resolution.
- Encoding time is processor time of all threads, in seconds.
- The machine was shared with other programs while it measured. Times are upper bounds.
- "-" means not measured.
"""


def rival_section(results, rivals):
    others = [model for model in rivals if model not in COMPARED and raced(results, model, 70)]
    text = f"""## Whole files against the best rival

`gim encode MESH OUT --psnr DB`, with `DB` as in the head of the column. The encoder chooses between a square of at most 257 x 257 and
tiles. Each cell is: bytes of gim / bytes of the rival = quotient. The head of `rivals.csv` says how the rival was measured.

{size_table(results, rivals, COMPARED)}

One square alone, `--layout gim`:

{size_table(results, rivals, COMPARED, square)}
"""
    if others:
        text += f"""
Machined parts and other models that are small or smooth:

{size_table(results, rivals, others)}
"""
    lines = []
    for model in [*COMPARED, *others]:
        for db in TARGETS_DB:
            for row in (results.get((model, f"{kind}-{db}-db")) for kind in ("auto", "file")):
                if row and row.number("psnr_db") is not None:
                    size = f"{row.text('tiles')} tiles" if row.cells["layout"] == "tiles" else row.text("width", ".0f")
                    lines.append([model, f"{db} dB", row.cells["setting"].split("-")[0].replace("file", "square"), row.bytes(),
                                  row.text("psnr_db", ".2f", " dB"), size, row.text("decode_ms", ".2f", " ms"),
                                  row.text("encode_cpu_s", ".0f", " s")])
    if lines:
        text += f"""
The same files in detail. "Size" is the number of samples a side that the encoder chose, or the number of tiles.

{markdown(["model", "target", "layouts", "bytes", "PSNR", "size", "decoding", "encoding"], lines)}
"""
    return text


def between(points, x, reach):
    """Returns the value at x, linear between neighbours. None if x is farther than `reach` beyond the ends."""
    points = sorted(points)
    if not points or x < points[0][0] - reach or x > points[-1][0] + reach:
        return None
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        if x0 <= x <= x1:
            return y0 if x1 == x0 else y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    return points[0][1] if x < points[0][0] else points[-1][1]


def rival_at_psnr(rival, column, psnr):
    return between([(r["psnr"], r[column]) for r in rival], psnr, REACH_DB)


def rival_at_bytes(rival, column, size):
    return between([(math.log(r["bytes"]), r[column]) for r in rival], math.log(size), math.log(REACH_BYTES))


def defect_line(row, rival):
    """Returns one cell for each figure: gim / rival. Counts and areas of folds are compared at equal PSNR, normals at
    equal bytes."""
    psnr, size = row.number("psnr_db"), row.number("bytes")

    def cell(own, other, form):
        return f"{own} / " + ("-" if other is None else form(other))

    def percent(digits):
        return lambda x: f"{100 * x:.{digits}f} %"

    return [cell(row.text("folded_faces"), rival_at_psnr(rival, "folded_faces", psnr), "{:.0f}".format),
            cell(row.percent("folded_area", 3), rival_at_psnr(rival, "folded_area", psnr), percent(3)),
            cell(row.text("folded_back_edges"), rival_at_psnr(rival, "folded_back_edges", psnr), "{:.0f}".format),
            cell(row.text("normals_p99", ".1f"), rival_at_bytes(rival, "normal_p99", size), "{:.1f}".format),
            cell(row.percent("off_by_45"), rival_at_bytes(rival, "over45", size), percent(2))]


def defect_details(row):
    return [row.cells["model"], row.cells["setting"], row.bytes(), row.text("folded_faces"), row.percent("folded_area", 3),
            row.text("folded_back_edges"), row.text("folded_back_edges_of_reference"), row.percent("off_by_20"),
            row.percent("off_by_45"), row.text("normals_p95", ".1f"), row.text("normals_p99", ".1f"),
            row.text("p999_over_rms", ".1f"), row.text("max_over_rms", ".1f"), row.text("level1_folded_faces"),
            row.percent("level1_folded_area", 3)]


def has_defects(row):
    return row is not None and row.number("folded_faces") is not None


def defect_section(results, rival_defects):
    text = """## Visible defects

What a person sees of a surface whose distances are small. `gim compare` prints these figures and `gim render --defects` shows them.

- *Folded triangles*: triangles of the decoded surface that look away from the triangle of the input nearest to their centroid.
- *Folded area*: the share of the decoded surface's area that looks away from the input.
- *Edges folded back*: edges of the decoded surface whose two triangles' normals differ by more than 150 degrees. The input has such
  edges too.
- *Off by more than 20, 45 degrees*: the share of the decoded surface's area whose shading normal differs by more from that of the
  nearest point of the input. Shading normals are interpolated between angle-weighted vertex normals.
- *Normals, 95 %, 99 %*: percentiles of that angle, in degrees, over samples of both surfaces.
- *Distance / RMS, 99.9 %, largest*: this percentile and the maximum of the distance, over the RMS distance; the worse way.
- *Level 1*: the same of the surface at half resolution.
"""
    measured = [row for row in results.values() if has_defects(row)]
    if not measured:
        return text + "\nNo row has these figures yet.\n"
    models = [*COMPARED, *(model for model in rival_defects if model not in COMPARED)]
    lines = [[model, f"{db} dB{f' {OLD}' if row.is_old else ''}"] + defect_line(row, rival_defects.get(model, []))
             for model in models for db in TARGETS_DB if has_defects(row := raced(results, model, db))]
    if lines:
        head = ["model", "target", "folded triangles", "folded area", "edges folded back", "normals, 99 %", "off by > 45"]
        text += f"""
The files of the first table against the best rival: gim / rival. Folds and edges are compared at equal PSNR, interpolated in dB. Normals
are compared at equal bytes, interpolated in their logarithm. "-": the rival was not measured there.

{markdown(head, lines)}
"""
    head = ["model", "setting", "bytes", "folded triangles", "folded area", "edges folded back", "of the input", "off by > 20",
            "off by > 45", "normals, 95 %", "99 %", "distance / RMS, 99.9 %", "largest", "level 1: folded triangles",
            "level 1: folded area"]
    return text + f"""
All measured rows:

{markdown(head, [defect_details(row) for row in measured])}
"""


def lossy_section(results):
    lines = []
    for row in of_setting(results, "quality-75"):
        other = results.get((row.cells["model"], "psnr-70"))
        line = [row.cells["model"]]
        for r in (row, other):
            line += [r.bytes(), r.text("psnr_db", ".2f", " dB"), r.text("folded_faces"), r.text("decode_ms", ".2f", " ms"),
                     r.text("encode_cpu_s", ".0f", " s")] if r else ["-"] * 5
        lines.append(line)
    head = ["bytes", "PSNR", "folded triangles", "decoding", "encoding"]
    return f"""## One square, lossy

`--size 257 --quality 75` (left) and `--size 257 --psnr 70` (right).

{markdown(["model"] + [f"Q 75: {h}" for h in head] + [f"70 dB: {h}" for h in head], lines)}
"""


def levels_down_to(row):
    side, levels = row.number("width"), row.number("levels")
    return "-" if side is None else f"{int((side - 1) / 2 ** (levels - 1)) + 1}"


def lossless_section(results):
    lines = [[row.cells["model"], row.bytes(), row.text("psnr_db", ".2f", " dB"), row.text("folded_faces"),
              row.text("stretch_efficiency", ".3f"), levels_down_to(row), row.text("decode_ms", ".2f", " ms"),
              row.text("encode_cpu_s", ".0f", " s")] for row in of_setting(results, "lossless-16")]
    head = ["model", "bytes", "PSNR", "folded triangles", "stretch efficiency", "coarsest side", "decoding", "encoding"]
    return f"""## One square, lossless

`--size 257 --lossless --bits 16`. "Lossless" means that the decoded image equals the 16-bit image. PSNR tells how near the image is
to the mesh. The coarsest side is that of the last level that closes.

{markdown(head, lines)}
"""


def chart_section(results):
    lines = []
    for row in of_setting(results, "mcgim-lossless-16"):
        model = row.cells["model"]
        square = results.get((model, "lossless-16"))
        lines.append([model, row.text("charts"), f"{row.text('width')} x {row.text('height')}",
                      row.text("packing", ".1%"), row.text("stretch_efficiency", ".3f"), row.bytes(),
                      row.text("psnr_db", ".2f", " dB"), square.text("psnr_db", ".2f", " dB") if square else "-",
                      f"{PAPER_PSNR[model]} dB" if model in PAPER_PSNR else "-", row.text("levels"),
                      row.text("decode_ms", ".2f", " ms"), row.text("encode_cpu_s", ".0f", " s")])
    paper = []
    for row in of_setting(results, "mcgim-2-bits-a-sample"):
        model = row.cells["model"]
        paper.append([model, row.text("charts"), row.bytes(), row.text("psnr_db", ".2f", " dB"),
                      row.text("encode_cpu_s", ".0f", " s")])
    head = ["model", "charts", "rectangle", "defined", "stretch efficiency", "bytes", "PSNR", "PSNR of one square",
            "PSNR in the paper", "levels", "decoding", "encoding"]
    return f"""## Charts

`--layout mcgim --lossless --bits 16 --samples 65536`. The encoder chooses the number of charts. "Defined" is the part of the rectangle
that the charts cover. The paper is Sander et al. 2003; its charts cover 73 to 76 % of the rectangle. The encoder
checks that each level has the components, boundary loops and genus of the mesh.

{markdown(head, lines)}

`--layout mcgim --bytes 16384 --samples 65536`, which is 2 bits for each sample of the rectangle:

{markdown(["model", "charts", "bytes", "PSNR", "encoding"], paper)}
"""


def single_run_section(coder):
    lines = [[cells["input"], f"`gim {cells['command']}`",
              cells["measured"] + (f" {OLD}" if int(cells["coder"]) < min(coder, SAME_CODE_SINCE) else "")] for cells in read_table(SINGLE_RUNS_CSV)]
    return f"""## Single runs

Angles are means over the surface. The dB of colours are those of the sRGB values. Both compare the decoded plane on the decoded surface
with the input.

{markdown(["input", "command", "measured"], lines)}
"""


def results_page(coder, results, rivals, rival_defects):
    return "\n".join([intro(coder, results), rival_section(results, rivals), defect_section(results, rival_defects),
                      lossy_section(results), lossless_section(results), chart_section(results), single_run_section(coder)])


# ---- the plot --------------------------------------------------------------------------------------------------------

def plot_points(axes, points, **style):
    """Plots gim's points (x, y, whether an older coder made it)."""
    axes.plot([p[0] for p in points], [p[1] for p in points], color="black", marker="o", markersize=5, label="gim", **style)
    old = [p for p in points if p[2]]
    if old:
        axes.plot([p[0] for p in old], [p[1] for p in old], linestyle="none", marker="o", markersize=5, color="black",
                  markerfacecolor="white", label="gim, older coder")


def plot_rival(axes, points):
    axes.plot([x for x, _ in points], [y for _, y in points], color="#E69F00", marker="s", markersize=4, label="best rival")


def name_bytes(axis, ticker):
    axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter(ticker.FuncFormatter(lambda n, _: f"{n / 1000:g}k" if n >= 1000 else f"{n:g}"))
    axis.set_minor_formatter(ticker.FuncFormatter(lambda *_: ""))


def draw_size(axes, rows, rival, ticker):
    """Draws the bytes of the file over the PSNR."""
    plot_rival(axes, sorted(rival.items()))
    plot_points(axes, [(row.number("psnr_db") or db, row.number("bytes"), row.is_old) for db, row in rows])
    axes.set_yscale("log")
    name_bytes(axes.yaxis, ticker)
    axes.set_xticks(TARGETS_DB)


def draw_normals(axes, rows, rival, ticker):
    """Draws the 99th percentile of the normals' angles over the bytes of the file."""
    plot_rival(axes, sorted((r["bytes"], r["normal_p99"]) for r in rival))
    plot_points(axes, [(row.number("bytes"), row.number("normals_p99"), row.is_old) for _, row in rows if has_defects(row)])
    axes.set_xscale("log")
    name_bytes(axes.xaxis, ticker)
    axes.set_ylim(bottom=0)


def draw(results, rivals, rival_defects):
    try:
        import matplotlib
    except ImportError:
        print(f"note: no matplotlib, {PLOT.name} stays as it is", file=sys.stderr)
        return
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib import ticker

    rows = {model: [(db, row) for db in TARGETS_DB
                    if (row := raced(results, model, db)) and row.number("bytes") is not None] for model in COMPARED}
    lines = 4 if any(has_defects(row) for found in rows.values() for _, row in found) else 2
    figure, grid = plt.subplots(lines, 5, figsize=(15, 3 * lines))
    for i, model in enumerate(COMPARED):
        draw_size(grid.flat[i], rows[model], rivals.get(model, {}), ticker)
        if lines == 4:
            draw_normals(grid.flat[10 + i], rows[model], rival_defects.get(model, []), ticker)
    for i, axes in enumerate(grid.flat):
        axes.set_title(COMPARED[i % 10], fontsize=10)
        axes.grid(True, which="major", linewidth=0.3)
    for i, axes in enumerate(grid[:, 0]):
        axes.set_ylabel("bytes of the file" if i < 2 else "normals, 99 %, degrees")
    for i, line in enumerate(grid[1::2]):
        for axes in line:
            axes.set_xlabel("bytes of the file" if i else "PSNR, dB")
    labels = {}
    for axes in grid.flat:
        labels.update(dict(zip(*reversed(axes.get_legend_handles_labels()))))
    figure.tight_layout()
    figure.legend(labels.values(), labels.keys(), loc="upper center", ncol=3, bbox_to_anchor=(0.5, 0.0), frameon=False)
    figure.savefig(PLOT, dpi=90, bbox_inches="tight", metadata={"Software": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="write nothing; exit status 1 if a file is not up to date")
    parser.add_argument("--no-plot", action="store_true", help="leave the plot as it is")
    arguments = parser.parse_args()

    coder = coder_version()
    results, rivals, rival_defects = read_results(coder), read_rivals(), read_rival_defects()
    readme = README.read_text(encoding="utf-8")
    wanted = {RESULTS_MD: results_page(coder, results, rivals, rival_defects),
              README: with_size_table(readme, size_table(results, rivals, COMPARED))}
    if arguments.check:
        stale = [path.relative_to(ROOT) for path, text in wanted.items()
                 if not path.is_file() or path.read_text(encoding="utf-8") != text]
        for path in stale:
            print(f"{path} is not up to date; run: python3 tools/results.py", file=sys.stderr)
        return 1 if stale else 0
    for path, text in wanted.items():
        path.write_text(text, encoding="utf-8")
    if not arguments.no_plot:
        draw(results, rivals, rival_defects)
    return 0


if __name__ == "__main__":
    sys.exit(main())

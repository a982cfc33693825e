"""Curves through measured points: fronts, interpolation, and the tables made of them."""

import csv
import math
from pathlib import Path

TARGETS_DB = (60, 65, 70, 75)
NORMAL_BYTES = (4000, 8000)
STEP_DB = 0.2   # a larger file must gain more than this, because two sizes that aim at 60 dB land at 60.1 and 60.2
TIMED_BITS = 12  # full meshes with these bits, the usual setting, are always timed
CHORD_DB = 3.0  # no point of a curve lies below a line between two others that are at most this far apart
REACH_DB = 0.5  # a curve counts this far beyond its ends: an encoder that aims at 60 dB may land at 60.2

# key: (label, colour, whether it is gim's own). The colours of Okabe and Ito also suit colour-blind people.
TOOLS = {
    "gim": ("gim, one square", "#000000", True),
    "mcgim": ("gim, charts", "#D55E00", True),
    "draco": ("Draco, full mesh", "#999999", False),
    "meshopt": ("meshoptimizer + zstd, full mesh", "#F0E442", False),
    "quadric+draco": ("meshopt_simplify + Draco", "#56B4E9", False),
    "quadric+meshopt": ("meshopt_simplify + meshoptimizer + zstd", "#CC79A7", False),
    "lt+draco": ("Lindstrom-Turk + Draco", "#0072B2", False),
    "lt+meshopt": ("Lindstrom-Turk + meshoptimizer + zstd", "#009E73", False),
    "rivals.csv": ("best rival, recorded", "#E69F00", False),
}


def label(tool):
    return TOOLS[tool][0]


def is_own(tool):
    return TOOLS[tool][2]


def front(points, better=1, step=0.0):
    """Returns the points (bytes, value) that are better than all smaller files by more than `step`. `better` is 1 if
    more is better, -1 if less is."""
    kept = []
    for size, value in sorted(points, key=lambda p: (p[0], -better * p[1])):
        if not kept or better * (value - kept[-1][1]) > step:
            kept.append((size, value))
    return kept


def psnr_curve(points):
    """Returns what a tool reaches: the front without its dents. Settings come in steps. Between two files of about the
    same PSNR, a finer step would reach the line between them, in (logarithm of bytes, PSNR). Longer lines would be
    guesses."""
    kept = front(points, step=STEP_DB)
    line = [(math.log(size), value) for size, value in kept]

    def is_dent(k):
        for x0, y0 in line[:k]:
            for x1, y1 in line[k + 1:]:
                if y1 - y0 <= CHORD_DB and line[k][1] < y0 + (y1 - y0) * (line[k][0] - x0) / (x1 - x0):
                    return True
        return False

    return [point for k, point in enumerate(kept) if not is_dent(k)]


def bytes_at(curve, psnr):
    """Returns the bytes that reach `psnr`, linear in their logarithm between neighbours. None if it is out of reach."""
    for size, value in curve:
        if abs(value - psnr) < 1e-9:
            return size
    if len(curve) < 2 or psnr < curve[0][1] - REACH_DB or psnr > curve[-1][1] + REACH_DB:
        return None
    upper = next((i for i, (_, value) in enumerate(curve) if value > psnr), len(curve) - 1)
    (low_size, low), (high_size, high) = curve[max(upper, 1) - 1], curve[max(upper, 1)]
    share = (psnr - low) / (high - low)
    return math.exp(math.log(low_size) + share * (math.log(high_size) - math.log(low_size)))


def value_at(curve, size):
    """Returns the value at `size` bytes, linear in their logarithm. None if there is no smaller file."""
    curve = sorted(curve)
    if not curve or size < curve[0][0]:
        return None
    for (low_size, low), (high_size, high) in zip(curve, curve[1:]):
        if low_size <= size <= high_size:
            share = math.log(size / low_size) / math.log(high_size / low_size)
            return low + share * (high - low)
    return curve[-1][1]


def usable(rows):
    """Rows that hold a measured surface. An exact copy has no PSNR."""
    return [r for r in rows if r["status"] == "ok" and r["psnr"] and r["bytes"]]


def points_of(rows, value="psnr"):
    return [(float(r["bytes"]), float(r[value])) for r in usable(rows) if r[value] != ""]


def by_tool(rows):
    """Groups the rows of one model by tool, in the order of TOOLS."""
    return {tool: [r for r in rows if r["tool"] == tool] for tool in TOOLS if any(r["tool"] == tool for r in rows)}


def curve_rows(rows):
    """Returns the rows on a tool's curve."""
    wanted = set(psnr_curve(points_of(rows)))
    return [r for r in usable(rows) if (float(r["bytes"]), float(r["psnr"])) in wanted]


def read_recorded_rivals(path):
    """Reads {model: [(bytes, dB)]} from a table with columns model, bytes_at_60dB, ... Lines that begin with # are
    comments."""
    curves = {}
    if not Path(path).is_file():
        return curves
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            cells = ((key, row[key]) for key in row if key and key.startswith("bytes_at_") and row[key])
            curves[row["model"]] = [(float(n), float(key[len("bytes_at_"):-len("dB")])) for key, n in cells]
    return curves


def psnr_curves(rows, recorded):
    """Returns {tool: its curve} of one model, and the curve of the recorded rival if there is one."""
    curves = {tool: points_of(of_tool) for tool, of_tool in by_tool(rows).items()}
    if recorded:
        curves["rivals.csv"] = recorded
    return {tool: psnr_curve(points) for tool, points in curves.items()}


def cell(value, form):
    return "-" if value is None else format(value, form)


def markdown(head, lines):
    out = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    return "\n".join(out + ["| " + " | ".join(line) + " |" for line in lines])


def size_table(models, recorded):
    """Writes the bytes at each target: every tool, then the best of gim's layouts over the best rival."""
    lines = []
    for model, rows in models.items():
        curves = psnr_curves(rows, recorded.get(model))
        sizes = {tool: [bytes_at(curve, db) for db in TARGETS_DB] for tool, curve in curves.items()}
        for tool, found in sizes.items():
            lines.append([model, label(tool)] + [cell(n, ",.0f") for n in found])
        ratios = []
        for i in range(len(TARGETS_DB)):
            own = [s[i] for tool, s in sizes.items() if is_own(tool) and s[i] is not None]
            rival = [s[i] for tool, s in sizes.items() if not is_own(tool) and s[i] is not None]
            ratios.append(min(own) / min(rival) if own and rival else None)
        lines.append([model, "**gim / best rival**"] + [f"**{cell(r, '.3f')}**" for r in ratios])
    return markdown(["model", "bytes at"] + [f"{db} dB" for db in TARGETS_DB], lines)


def normal_table(models, column, what):
    """Writes the normal error of the files on the PSNR curve, and the least error of any setting at these bytes."""
    lines = []
    for model, rows in models.items():
        for tool, of_tool in by_tool(rows).items():
            chosen = points_of(curve_rows(of_tool), column)
            least = front(points_of(of_tool, column), better=-1)
            found = [value_at(curve, size) for curve in (chosen, least) for size in NORMAL_BYTES]
            if any(f is not None for f in found):
                lines.append([model, label(tool)] + [cell(f, ".2f") for f in found])
    sizes = [f"{n:,} bytes" for n in NORMAL_BYTES]
    return markdown(["model", f"{what}, degrees, at"] + sizes + [f"{n}, best setting for it" for n in sizes], lines)


def is_usual_full_mesh(row):
    return row["tool"] in ("draco", "meshopt") and row["setting"] == f"bits={TIMED_BITS}"


def decode_table(models, psnr=70):
    """Writes the smallest timed file of each tool that reaches `psnr`, and the usual full meshes. Speeds are relative
    to Draco's at `psnr`."""
    lines = []
    for model, rows in models.items():
        chosen = {}
        for tool, of_tool in by_tool(rows).items():
            timed = [r for r in usable(of_tool) if r["decode_ms"] and float(r["psnr"]) >= psnr - 0.05]
            if timed:
                chosen[tool] = min(timed, key=lambda r: float(r["bytes"]))
        draco = next((chosen[t] for t in ("lt+draco", "quadric+draco", "draco") if t in chosen), None)
        usual = [r for r in usable(rows) if r["decode_ms"] and is_usual_full_mesh(r)]
        for row in [*chosen.values(), *usual]:
            times = float(row["mtri_per_s"]) / float(draco["mtri_per_s"]) if draco else None
            lines.append([model, label(row["tool"]), row["setting"], f"{float(row['psnr']):.1f}",
                          f"{int(row['triangles']):,}", f"{float(row['decode_ms']):.3f}",
                          f"{float(row['mtri_per_s']):.1f}", cell(times, ".1f")])
    return markdown(["model", f"decoding at {psnr} dB", "setting", "dB", "triangles", "ms", "Mtri/s",
                     "times Draco's speed"], lines)

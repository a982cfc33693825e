"""Draws the results. Needs matplotlib."""

import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.ticker import FuncFormatter  # noqa: E402

import curves  # noqa: E402

PLOT_DB = (50, 90)  # range that the pictures show


def style(tool):
    own = curves.is_own(tool)
    return {"color": curves.TOOLS[tool][1], "linewidth": 2.2 if own else 1.4, "zorder": 3 if own else 2,
            "linestyle": "--" if tool == "rivals.csv" else "-"}


def byte_axis(axes):
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter(FuncFormatter(lambda n, _: f"{n / 1000:g}k" if n >= 1000 else f"{n:g}"))
    axes.set_xlabel("bytes of the file")


def finish(figure, axes, path):
    axes.grid(True, which="both", linewidth=0.3)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize=7)
    figure.savefig(path, dpi=130, bbox_inches="tight")
    plt.close(figure)


def draw_psnr(axes, rows, recorded):
    for tool, curve in curves.psnr_curves(rows, recorded).items():
        shown = [p for p in curve if PLOT_DB[0] <= p[1] <= PLOT_DB[1]]
        if not shown:
            continue
        axes.plot(*zip(*shown), marker=".", markersize=4, label=curves.label(tool), **style(tool))
    byte_axis(axes)
    axes.set_ylabel("PSNR, dB")


def psnr_picture(path, model, rows, recorded):
    figure, axes = plt.subplots(figsize=(6.4, 4.6))
    draw_psnr(axes, rows, recorded)
    axes.set_title(model)
    finish(figure, axes, path)


def decode_picture(path, model, rows):
    figure, axes = plt.subplots(figsize=(6.4, 4.6))
    for tool, of_tool in curves.by_tool(rows).items():
        points = sorted((float(r["psnr"]), float(r["decode_ms"])) for r in curves.curve_rows(of_tool) if r["decode_ms"])
        points = [p for p in points if PLOT_DB[0] <= p[0] <= PLOT_DB[1]]
        if points:
            axes.plot(*zip(*points), marker=".", markersize=4, label=curves.label(tool), **style(tool))
    axes.set_yscale("log")
    axes.yaxis.set_major_formatter(FuncFormatter(lambda ms, _: f"{ms:g}"))
    axes.set_xlabel("PSNR, dB")
    axes.set_ylabel("decoding in memory, one thread, ms")
    axes.set_title(model)
    finish(figure, axes, path)


def draw_normals(axes, rows, column, what, top):
    for tool, of_tool in curves.by_tool(rows).items():
        shown = sorted(curves.points_of(curves.curve_rows(of_tool), column))  # the files of the PSNR curve
        if shown:
            axes.plot(*zip(*shown), marker=".", markersize=4, label=curves.label(tool), **style(tool))
    byte_axis(axes)
    axes.set_ylabel(f"shading-normal error, {what}, degrees")
    axes.set_ylim(bottom=0, top=top)
    axes.grid(True, which="both", linewidth=0.3)


def normal_picture(path, model, rows):
    figure, (left, right) = plt.subplots(1, 2, figsize=(12.8, 4.6))
    draw_normals(left, rows, "normal_degrees", "mean", top=25)
    draw_normals(right, rows, "normals_p99", "99th percentile", top=90)
    figure.suptitle(model)
    finish(figure, left, path)


def summary_picture(path, models, recorded):
    """Draws PSNR over bytes for all models, one panel each."""
    columns = min(4, len(models))
    lines = math.ceil(len(models) / columns)
    figure, grid = plt.subplots(lines, columns, figsize=(3.6 * columns, 2.9 * lines), squeeze=False)
    handles = {}
    for axes, (model, rows) in zip(grid.flat, models.items()):
        draw_psnr(axes, rows, recorded.get(model))
        axes.set_title(model, fontsize=9)
        axes.grid(True, which="both", linewidth=0.3)
        handles.update(dict(zip(*reversed(axes.get_legend_handles_labels()))))
    for i, axes in enumerate(grid.flat):
        axes.label_outer() if i % columns else None
        if i >= len(models):
            axes.axis("off")
    figure.tight_layout()
    if handles:
        figure.legend(handles.values(), handles.keys(), loc="upper center", ncol=min(3, len(handles)), fontsize=8,
                      bbox_to_anchor=(0.5, 0.0), frameon=False)
    figure.savefig(path, dpi=110, bbox_inches="tight")
    plt.close(figure)


def draw_all(folder, models, recorded):
    for model, rows in models.items():
        psnr_picture(folder / f"{model}-psnr.png", model, rows, recorded.get(model))
        decode_picture(folder / f"{model}-decode.png", model, rows)
        normal_picture(folder / f"{model}-normals.png", model, rows)
    summary_picture(folder / "summary.png", models, recorded)

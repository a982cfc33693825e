#!/usr/bin/env python3
"""Imported images: makes sets of small multi-chart images from meshes, and measures what coders make of them.

    python3 tools/rd/import_set.py --models MODEL.ply ... --out FOLDER [--build build/release] [--side 64] [--each 5]

Each mesh becomes charts, by `gim encode --layout mcgim` with several numbers of charts, unfitted, in 18 bits. Each of these
becomes several images of SIDE x SIDE samples, uint16 with 12 bits and a mask as fourth channel, turned in space:

  packed   the charts, turned and packed anew; both sides of a seam have the same positions
  atlas    the whole rectangle of finer charts, turned and sampled again; borders do not meet, and there are gaps

FOLDER receives packed.u16 and atlas.u16, all images of a set one after the other, and prints a table: bytes an image of gim
(`gim encode --lossless`, the whole file), zstd -19, PNG with 16 bits, EXR with PIZ, and gim over the best of these.
Needs numpy, and the programs gim and gim_rival_images (-DGIM_BUILD_RD=ON).
"""

import argparse
import os
import subprocess
import sys
from collections import deque
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
BITS = 12
CHARTS = (8, 4, 20, 40, 1)
FINE_CHARTS = 12
LEAST_DEFINED = 0.25  # of all samples


def charts_of(gim, program, model, charts, samples, folder):
    """The rectangle of positions, NaN where undefined; None if the mesh gives none."""
    path = folder / f"{model.stem}-{charts}-{samples}.gim"
    if not path.exists():
        run = subprocess.run([program, "encode", model, path, "--layout", "mcgim", "--samples", str(samples), "--charts",
                              str(charts), "--lossless", "--bits", "18", "--fit", "none", "--quiet"],
                             stderr=subprocess.DEVNULL, check=False)
        if run.returncode != 0:
            return None
    return gim.open(path).positions(0).astype(np.float64)


def pieces(mask):
    """For each piece of the mask, connected by sides and corners: a mask of it."""
    left = mask.copy()
    while left.any():
        start = tuple(np.argwhere(left)[0])
        piece, queue = np.zeros_like(mask), deque([start])
        left[start] = False
        while queue:
            row, column = queue.popleft()
            piece[row, column] = True
            for r in range(max(row - 1, 0), min(row + 2, mask.shape[0])):
                for c in range(max(column - 1, 0), min(column + 2, mask.shape[1])):
                    if left[r, c]:
                        left[r, c] = False
                        queue.append((r, c))
        yield piece


def turned(image, random):
    return np.rot90(image, random.integers(4))


def packed(image, side, random):
    """Its pieces, turned, each at the first place with a free sample all around. What does not fit is left out."""
    boxes = []
    for piece in pieces(~np.isnan(image[..., 0])):
        rows, columns = np.nonzero(piece)
        box = np.s_[rows.min():rows.max() + 1, columns.min():columns.max() + 1]
        boxes.append(turned(np.where(piece[box][..., None], image[box], np.nan), random)[:side, :side])
    out, taken = np.full((side, side, 3), np.nan), np.zeros((side + 2, side + 2), bool)
    for box in sorted(boxes, key=lambda b: -b.shape[0] * b.shape[1]):
        mask = ~np.isnan(box[..., 0])
        height, width = mask.shape
        places = ((r, c) for r in range(side - height + 1) for c in range(side - width + 1))
        place = next((p for p in places if not (taken[p[0] + 1:, p[1] + 1:][:height, :width] & mask).any()), None)
        if place is None:
            continue
        out[place[0]:, place[1]:][:height, :width][mask] = box[mask]
        rows, columns = np.nonzero(mask)
        for r in range(3):
            for c in range(3):
                taken[place[0] + rows + r, place[1] + columns + c] = True
    return out


def sampled(image, side, random):
    """The whole rectangle, turned by any angle, bilinear between four defined samples."""
    height, width = image.shape[:2]
    angle, step = random.uniform(0, 2 * np.pi), max(height, width) * random.uniform(1, 1.25) / side
    y, x = (np.mgrid[:side, :side] - (side - 1) / 2) * step
    u, v = np.cos(angle) * x - np.sin(angle) * y + width / 2, np.sin(angle) * x + np.cos(angle) * y + height / 2
    row, column = np.floor(v).astype(int), np.floor(u).astype(int)
    is_inside = (row >= 0) & (column >= 0) & (row < height - 1) & (column < width - 1)
    row, column = np.clip(row, 0, height - 2), np.clip(column, 0, width - 2)
    s, t = (v - row)[..., None], (u - column)[..., None]
    out = ((image[row, column] * (1 - t) + image[row, column + 1] * t) * (1 - s)
           + (image[row + 1, column] * (1 - t) + image[row + 1, column + 1] * t) * s)
    out[~is_inside] = np.nan
    return out


def quantised(image, random):
    """Turned in space, 12 bits, with the mask; None if too little is defined."""
    mask = ~np.isnan(image).any(2)
    if mask.mean() < LEAST_DEFINED:
        return None
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    points = image[mask] @ turn.T
    low = points.min(0)
    out = np.zeros(mask.shape + (4,), "<u2")
    out[mask, :3] = np.rint((points - low) / (points - low).max() * (2 ** BITS - 1))
    out[mask, 3] = 1
    return out


def make_sets(gim, program, args, random):
    folder = args.out / "charts"
    folder.mkdir(parents=True, exist_ok=True)
    sets = {"packed": [], "atlas": []}
    area = args.side * args.side
    for model in args.models:
        for charts in CHARTS:
            image = charts_of(gim, program, model, charts, int(0.9 * area), folder)
            for _ in range(args.each if image is not None else 0):
                sets["packed"].append(quantised(packed(image, args.side, random), random))
        image = charts_of(gim, program, model, FINE_CHARTS, 4 * area, folder)
        for _ in range(args.each if image is not None else 0):
            sets["atlas"].append(quantised(sampled(image, args.side, random), random))
    return {name: [image for image in images if image is not None] for name, images in sets.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--models", nargs="+", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--build", type=Path, default=ROOT / "build/release")
    parser.add_argument("--side", type=int, default=64)
    parser.add_argument("--each", type=int, default=5, help="images from each rectangle of charts")
    args = parser.parse_args()
    os.environ.setdefault("GIM_LIBRARY", str(args.build / "decoder/libgim-decoder.so.0"))
    sys.path.insert(0, str(ROOT / "decoder/bindings/python"))
    import gim
    program = args.build / "tools/gim"
    sets = make_sets(gim, program, args, np.random.default_rng(7))
    print("| set | images | gim | zstd -19 | PNG, 16 bits | EXR, PIZ | gim / the best |\n|---|---|---|---|---|---|---|")
    for name, images in sets.items():
        if not images:
            continue
        data = np.stack(images).tobytes()
        (args.out / f"{name}.u16").write_bytes(data)
        run = subprocess.run([args.build / "tools/rd/gim_rival_images", str(args.side)], input=data, check=True,
                             stdout=subprocess.PIPE)
        rivals = np.array(run.stdout.split(), float).reshape(-1, 3).mean(0)
        sizes = []
        for image in images:
            file = gim.encode_image(image, lossless=True, program=program)
            assert np.array_equal(gim.open(file).array()[0], image), name
            sizes.append(len(file))
        own = np.mean(sizes)
        print("| " + " | ".join([name, str(len(images))] + [f"{x:,.0f}" for x in (own, *rivals)]
                                + [f"{own / rivals.min():.3f}"]) + " |", flush=True)


if __name__ == "__main__":
    main()

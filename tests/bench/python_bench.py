#!/usr/bin/env python3
"""Images per second of gim.decode_batch, of files that all have one size. GIM_LIBRARY and PYTHONPATH as in
decoder/bindings/python/README.md.

Usage: python_bench.py [--threads N] [--level L] FILE...
One thread: per second of processor time, which other programs disturb least. More: per second. Nine runs: median, range."""

import argparse
import statistics
import time
from pathlib import Path

import gim
import numpy as np

BATCH = 64
RUNS = 9


def rates(items, level, threads, form):
    clock = time.process_time if threads == 1 else time.perf_counter
    out = np.empty_like(gim.decode_batch(items, level, threads=threads, **form))
    found = []
    for _ in range(RUNS):
        begin = clock()
        gim.decode_batch(items, level, threads=threads, out=out, **form)
        found.append(len(items) / (clock() - begin))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=Path, metavar="FILE")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--level", type=int, default=0)
    arguments = parser.parse_args()
    files = [path.read_bytes() for path in arguments.files]
    items = [files[i % len(files)] for i in range(max(BATCH, len(files)) // len(files) * len(files))]
    print(f"{len(files)} files, mean {sum(map(len, files)) / len(files):.0f} bytes, shape "
          f"{gim.open(files[0]).positions(arguments.level).shape}, {arguments.threads} threads")
    for dtype in ("float32", "float16", "uint16"):
        for layout, channels in (("HWC", "xyz"), ("CHW", "xyz"), ("CHW", "xyzm")):
            found = rates(items, arguments.level, arguments.threads,
                          {"dtype": dtype, "layout": layout, "channels": channels})
            print(f"{dtype:8} {layout} {channels:5} {statistics.median(found):6.0f} images/s "
                  f"({min(found):.0f} to {max(found):.0f})")


if __name__ == "__main__":
    main()

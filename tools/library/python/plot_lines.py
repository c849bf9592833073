#!/usr/bin/python3
"""Plots one scan with its lines and corners.

    plot_lines.py SCAN.txt [--out F.png]

SCAN.txt holds numbers: bearing of the first beam and step in degrees, then the ranges in metres
(tools/library/examples/room.txt is one). Needs matplotlib.
"""
import argparse
import math
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from ale_lines import Extractor  # noqa: E402


def read_scan(path):
    """Bearing of the first beam and step in radians, ranges in metres."""
    try:
        first, step, *ranges = map(float, path.read_text(encoding="ascii").split())
    except OSError as error:
        sys.exit(f"plot_lines.py: {path}: {error.strerror}")
    except ValueError:
        sys.exit(f"plot_lines.py: {path}: not numbers: first bearing, step, ranges")
    return math.radians(first), math.radians(step), ranges


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scan", type=pathlib.Path)
    parser.add_argument("--out", default="lines.png")
    parser.add_argument("--library", help="libale.so (default: found)")
    options = parser.parse_args()
    first, step, ranges = read_scan(options.scan)
    features = Extractor(options.library).extract(ranges, first, step)

    seen = [(r * math.cos(first + k * step), r * math.sin(first + k * step)) for k, r in enumerate(ranges) if r > 0]
    figure, axes = plt.subplots(figsize=(6, 6))
    axes.plot(*zip(*seen), ".", color="0.6", markersize=3)
    for line in features.lines:
        axes.plot(*zip(line.start, line.end), color="k", linewidth=1.5)
    for corner in features.corners:
        axes.plot(corner.x, corner.y, "o", color="C1", markersize=6,
                  fillstyle="full" if corner.kind == "convex" else "none")
    axes.plot(0, 0, "k+", markersize=10)
    axes.set_aspect("equal")
    axes.set_xlabel("x, m")
    axes.set_ylabel("y, m")
    axes.set_title(f"{len(features.lines)} lines, {len(features.corners)} corners")
    figure.savefig(options.out, dpi=100, bbox_inches="tight")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Recordings in saved maps: each is driven again in the map that it made itself, and some in that of another drive.

    saved_map_table.py SHARED [--build build] [--only NAME]...

The robot is told nothing of where it is. Lost: scans until it has found itself, all of them if only the whole drive has
told. Off: mean and largest distance between this trajectory and that which made the map, of the same scans; only where
they are in one frame, the map's. Pieces: maps that are not joined in the end, the saved one and those of the drive.
"""
import argparse
import json
import pathlib
import sys
import tempfile

import numpy as np

from slam_table import Bench, read_tum, titled_table

RECORDINGS = {"exp1": "urg04lx/exp1.dat", "exp3": "urg04lx/exp3.dat", "test_lab": "urg04lx/test_lab.dat",
              "intel_every5th": "intel/intel_every5th.clf.gz", "aces": "corrected/aces.clf.gz",
              "belgioioso": "corrected/belgioioso.clf.gz", "freiburg-101": "corrected/freiburg-101.clf.gz"}
# The rover drove through one room three times; the others are other buildings.
OF_OTHERS = (("exp3", "exp1"), ("exp1", "exp3"), ("test_lab", "exp1"), ("aces", "exp1"), ("freiburg-101", "aces"), ("belgioioso", "aces"))
LOST = 0


def first_drive(bench, data, name):
    """The map of a recording, and its places in that."""
    saved, places = bench.folder / f"{name}.map", bench.folder / f"{name}.npy"
    if not saved.exists():
        _, final, _ = bench.replay(data / RECORDINGS[name], "--save-map", saved)
        np.save(places, read_tum(final)[1])
    return saved, np.load(places)


def row(bench, data, name, of):
    saved, places = first_drive(bench, data, of)
    _, final, _ = bench.replay(data / RECORDINGS[name], "--load-map", saved)
    last = json.loads(bench.poses.read_text(encoding="utf-8").splitlines()[-1])
    off = "-"
    if name == of:
        apart = abs(read_tum(final)[1] - places)
        off = f"{np.mean(apart):.3f}, {np.max(apart):.2f}"
    states = bench.states()
    return [name, of, f"{states.count(LOST)} of {len(states)}", str(last["maps"]), off]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("shared", type=pathlib.Path)
    parser.add_argument("--build", default="build")
    parser.add_argument("--only", action="append", default=[])
    options = parser.parse_args()
    data = options.shared / "data"
    if not data.is_dir():
        raise SystemExit(f"{data}: no shared data there (ALE_SHARED)")
    pairs = [(name, name) for name in RECORDINGS] + list(OF_OTHERS)
    chosen = [pair for pair in pairs if not options.only or pair[0] in options.only]
    if not chosen:
        raise SystemExit(f"saved_map_table.py: --only: one of {', '.join(RECORDINGS)}")
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(options.build, pathlib.Path(folder))
        titled_table("Drives that begin anywhere in a saved map:", ("drive", "map of", "scans lost", "pieces at the last scan", "off, m: mean, most"),
                     (row(bench, data, name, of) for name, of in chosen))


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""The published benchmark (Kümmerle et al. 2009) as Markdown tables on stdout: error over all relations, beside what others reached.

    published_table.py --build build [--shared FOLDER] [--only aces] [--log LOG --relations FILE] [--jitter 1,2,3] [--often 1,2,3]

The logs of ACES and Intel as everybody downloads them and the Killian Court lie in the project's shared data (ALE_SHARED). Any other
log with its relations is measured by --log and --relations: `.relations` lines are `t1 t2 x y z roll pitch yaw`, `.relidx` lines
`i j x y yaw`, where i and j count laser lines from 0.

With --jitter each recording is replayed once more with each of these seeds of noise on its ranges (faults/spoil.py): what of a result
is luck. With --often, with wheels that go wrong once a minute.

The error of a relation is true relation^-1 * estimated one; m (degrees for turns). Every relation counts, also where scans were lost.
"""
import argparse
import math
import os
import pathlib
import re
import sys
import tempfile

import numpy as np

from lines_table import progress
from slam_table import Bench, as_carmen, read_tum, spoilt, titled_table, wrapped

SLACK_S = 0.2  # of a relation beyond the first or last scan
# Of the field's table: log and relations in the shared data. Unseen ones are kept for judging.
GIVEN = {"ACES": ("radish/aces.clf.bz2", "radish/aces.relations"), "Intel": ("radish/intel.clf.bz2", "intel/intel.relations"),
         "Killian": ("killian/killian.g2o.gz", "killian/killian.relidx"), "FR079": (), "MIT CSAIL": ()}
OTHERS = ("scan matching", "gmapping", "graph mapping", "Cartographer", "graph FLIRT", "iris_lama, its graph *", "Karto *")
REACHED = {"ACES": ("0.173", "0.060", "0.044 (0.044)", "0.0375 (0.043)", "-", "0.047, 0.043", "0.054"),
           "Intel": ("0.220", "0.070", "0.031 (0.026)", "0.0229 (0.024)", "0.02", "0.0205 (0.017), 0.021", "0.363"),
           "Killian": ("1.651", "0.122", "0.050 (0.056)", "0.0395 (0.049)", "-", "-", "-"),
           "FR079": ("0.258", "0.061", "0.056 (0.042)", "0.0452 (0.035)", "0.06", "0.038, 0.036", "1.831"),
           "MIT CSAIL": ("0.106", "0.049", "0.004", "0.0319", "-", "-", "-")}


def read_relations(path):
    """Ends of each relation (stamps, or numbers of scans), and the pose of the second seen from the first."""
    rows = np.loadtxt(path, comments=("#", "%"), ndmin=2)
    by_scan = pathlib.Path(path).suffix == ".relidx"
    return rows[:, :2].astype(int) if by_scan else rows[:, :2], rows[:, [2, 3, 4 if by_scan else 7]]


def at_stamps(trajectory, stamps):
    """Places and headings, interpolated; of scans with the same stamp the first counts."""
    times, places, headings = trajectory
    order = np.argsort(times, kind="stable")
    order = order[np.r_[True, np.diff(times[order]) > 0]]
    known = times[order]
    return np.interp(stamps, known, places[order]), np.interp(stamps, known, np.unwrap(headings[order]))


def relation_errors(trajectory, ends, relations):
    """Lengths and angles, of the relations that the trajectory covers."""
    times, places, headings = trajectory
    if ends.dtype.kind == "i":
        covered = (ends < len(times)).all(axis=1)
        (first, heading), (second, other) = ((places[numbers], headings[numbers]) for numbers in ends[covered].T)
    else:
        covered = ((ends >= times.min() - SLACK_S) & (ends <= times.max() + SLACK_S)).all(axis=1)
        (first, heading), (second, other) = (at_stamps(trajectory, stamps) for stamps in ends[covered].T)
    seen = (second - first) * np.exp(-1j * heading)
    true = relations[covered]
    return np.abs(seen - true[:, 0] - 1j * true[:, 1]), np.abs(wrapped(other - heading - true[:, 2]))


def measured(bench, log, relations, *fault):
    """The cells of a recording, as it is or with a fault: kind and seed."""
    log = as_carmen(bench, log)
    if fault:
        log = spoilt(bench, log, *fault)
    _, final, time_ms = bench.replay(log, "--frame", "laser")
    ends, true = read_relations(relations)
    metres, turns = relation_errors(read_tum(final), ends, true)
    if not len(metres):
        sys.exit(f"published_table.py: {relations}: no relation between scans of {log}")
    states = bench.states()
    return [f"{metres.mean():.4f} ({metres.std():.3f})", f"{np.median(metres):.4f}", f"{metres.max():.2f}", f"{math.degrees(turns.mean()):.2f}",
            f"{len(metres)} of {len(true)}", f"{states.count(0)} of {len(states)}", time_ms]


def given(shared, only):
    """Name, log and relations of those that are at hand."""
    for name, files in GIVEN.items():
        log, relations = (pathlib.Path(shared or "/nonexistent", "data", file) for file in files) if files else (None, None)
        if log and log.exists() and only in ("", name.lower()):
            yield name, log, relations


def parsed():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build")
    parser.add_argument("--shared", default=os.environ.get("ALE_SHARED", ""))
    parser.add_argument("--only", default="", metavar="NAME", help="aces, intel or killian alone")
    parser.add_argument("--log", help="another recording, in any format that ale-replay reads ..")
    parser.add_argument("--relations", help=".. and its relations")
    parser.add_argument("--jitter", default="", metavar="SEEDS", help="also with noise of these seeds on the ranges")
    parser.add_argument("--often", default="", metavar="SEEDS", help="also with wheels that go wrong once a minute")
    options = parser.parse_args()
    if bool(options.log) != bool(options.relations):
        parser.error("--log and --relations go together")
    for seeds in filter(None, (options.jitter, options.often)):
        if not re.fullmatch(r"\d+(,\d+)*", seeds):
            parser.error(f"{seeds}: not numbers with commas between them")
    for path in filter(None, (options.log, options.relations)):
        if not pathlib.Path(path).exists():
            sys.exit(f"published_table.py: {path}: no such file")
    if not (pathlib.Path(options.build) / "bin/ale-replay").exists():
        sys.exit(f"published_table.py: no programs in {options.build}/bin (make builds them)")
    return options


def main():
    options = parsed()
    recordings = [] if options.log else list(given(options.shared, options.only))
    if options.log:
        recordings = [(pathlib.Path(options.log).name, options.log, options.relations)]
    if not recordings:
        print("No recordings here: ALE_SHARED names no folder with data/radish (or give LOG and RELATIONS).\n")
    ours = {}
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(options.build, folder)
        for name, log, relations in recordings:
            progress(f"{name} ...")
            ours[name] = measured(bench, log, relations)
            for kind, seeds in (("jitter", options.jitter), ("often", options.often)):
                for seed in filter(None, seeds.split(",")):
                    progress(f"{name}, {kind} {seed} ...")
                    ours[f"{name}, {kind} {seed}"] = measured(bench, log, relations, kind, seed)
    titled_table("Error over all relations, m:",
                 ["recording", "mean (deviation)", "median", "worst", "turn, degrees", "relations", "scans lost", "ms a scan: mean, longest"],
                 [[name, *cells] for name, cells in ours.items()])
    if not options.log:
        titled_table("Mean (deviation) beside others; * with the odometry of the laser lines:", ["recording", "this one", *OTHERS],
                     [[name, ours[name][0] if name in ours else "-" if GIVEN[name] else "not given", *reached] for name, reached in REACHED.items()])


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""The benchmark of line extraction as Markdown tables on stdout.

    lines_table.py --program build/bench/lines [--scans N] [--counted N] [--recording NAME=LOG ...]

Accuracy and time come from the program itself, instructions from valgrind (callgrind), which collects
inside the one function that an extractor consists of. Recordings: of a resting scanner; the one beside
the project's shared data is used when it is there.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys

from callgrind import instructions

NOISES = ("urg", "dirty", "3mm", "10mm", "20mm", "real")
BUNDLED_RECORDING = "data/urg04lx/obstacle_demo_front.scan.gz"


def json_lines(command):
    done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
    return [json.loads(line) for line in done.stdout.splitlines()]


def progress(text):
    if sys.stderr.isatty():
        print(f"\r\033[K{text}", end="" if text else "\r", file=sys.stderr, flush=True)


def instructions_a_scan(program, extractor, function, scans):
    """Mean over the urg suite, counted inside the function alone."""
    collected, printed = instructions(function, [program, "run", "--extractor", extractor, "--scans", str(scans)])
    return collected / json.loads(printed)["scans"]


def table(head, rows):
    print("| " + " | ".join(head) + " |")
    print("| " + " | ".join("---" if k == 0 else "---:" for k in range(len(head))) + " |")
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def accuracy_tables(program, scans, counted):
    rows = []
    for noise in NOISES:
        progress(f"noise {noise} ...")
        rows += json_lines([program, "accuracy", "--noise", noise, "--scans", str(scans)])
    by_noise = {noise: {row["extractor"]: row for row in rows if row["noise"] == noise} for noise in NOISES}
    urg = by_noise["urg"]
    print(f"Noise `urg`, {rows[0]['scans']} scans, {rows[0]['true_lines']} lines that count:\n")
    body = []
    for name, r in urg.items():
        progress(f"instructions of {name} ...")
        counted_instructions = instructions_a_scan(program, name, r["function"], counted)
        body.append([r["title"], f"{r['tp']:.1f}", f"{r['fp_straight']:.1f}", f"{r['fp']:.1f}",
                     f"{r['error_rms']:.2f} / {r['error_median']:.2f}", f"{r['end_mm']:.1f} ({r['end_90_mm']:.0f})",
                     f"{r['corner_precision']:.0f} / {r['corner_recall']:.0f} / {r['corner_mm']:.1f}",
                     f"{counted_instructions / 1e3:.0f}", f"{r['us_a_scan']:.0f}"])
    progress("")
    table(["extractor", "found %", "false % (no curves)", "false %", "R rms / median", "end mm (90 %)",
           "corners: precision / recall / mm", "1000 instructions", "us"], body)
    print("One setting under other noises, found % / false % (no curves):\n")
    table(["extractor", *NOISES],
          [[urg[name]["title"], *(f"{by_noise[n][name]['tp']:.1f} / {by_noise[n][name]['fp_straight']:.1f}"
                                  for n in NOISES)] for name in urg])
    kinds = list(urg["ale"]["kinds"])
    print("By kind of world (noise `urg`), found % / false %:\n")
    table(["extractor", *kinds],
          [[r["title"], *(f"{r['kinds'][k]['tp']:.0f} / {r['kinds'][k]['fp']:.0f}" for k in kinds)]
           for r in urg.values()])


def recording_tables(program, name, path):
    """One for each stretch in which the scanner rests."""
    progress(f"recording {name} ...")
    rows = json_lines([program, "rest", path])
    progress("")
    for first in sorted({row["first_scan"] for row in rows}):
        stretch = [row for row in rows if row["first_scan"] == first]
        print(f"A real scanner at rest, `{name}`, {stretch[0]['scans']} scans from scan {first} on:\n")
        table(["extractor", "walls", "seen %", "pieces a wall", "stray lines a scan", "ends, beams"],
              [[r["title"], str(r["walls"]), f"{r['seen']:.1f}", f"{r['pieces']:.2f}", f"{r['stray']:.2f}",
                "" if r["end_beams"] is None else f"{r['end_beams']:.2f}"] for r in stretch])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--scans", type=int, default=20, help="of each kind of world and noise")
    parser.add_argument("--counted", type=int, default=1, help="the same, where instructions are counted")
    parser.add_argument("--recording", action="append", default=[], metavar="NAME=LOG")
    options = parser.parse_args()
    recordings = [entry.split("=", 1) for entry in options.recording]
    bundled = pathlib.Path(os.environ.get("ALE_SHARED") or "/nonexistent") / BUNDLED_RECORDING
    if bundled.exists():
        recordings.append((bundled.name, str(bundled)))
    accuracy_tables(options.program, options.scans, options.counted)
    for name, path in recordings:
        recording_tables(options.program, name, path)


if __name__ == "__main__":
    main()

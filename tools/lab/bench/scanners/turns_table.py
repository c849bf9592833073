#!/usr/bin/env python3
"""Lines found by scanners of a whole turn, beside those that a URG finds, as a Markdown table on stdout.

    turns_table.py --program build/bench/lines [--scans N] [--beams 1024,512,450]

The same worlds, noises and score as the benchmark of lines. Each turn begins anywhere and runs either way.
"""
import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from lines_table import NOISES, json_lines, progress, table  # noqa: E402


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--scans", type=int, default=20, help="of each kind of world and noise")
    parser.add_argument("--beams", default="1024,512,450", help="of a turn; 1024: those of a URG go on all the way round")
    options = parser.parse_args()

    def row(title, *command):
        progress(f"{title} ...")
        found = {line["noise"]: line for line in json_lines([options.program, *command, "--scans", str(options.scans)])}
        return [title, *(f"{found[noise]['tp']:.1f} / {found[noise]['fp_straight']:.1f}" for noise in NOISES),
                f"{found['urg']['true_lines'] / found['urg']['scans']:.1f}"]

    rows = [row("URG-04LX, 682 beams of 240 degrees", "accuracy", "--extractor", "ale")]
    rows += [row(f"a whole turn of {beams} beams", "turn", "--turn", beams, "--extractor", "ale") for beams in options.beams.split(",")]
    progress("")
    print(f"Lines found % / false % (no curves), by noise, {options.scans} scans of each kind of world; lines that count a scan:\n")
    table(["scanner", *NOISES, "lines"], rows)


if __name__ == "__main__":
    main()

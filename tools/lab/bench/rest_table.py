#!/usr/bin/env python3
"""What libale finds where real scanners rest, as a Markdown table on stdout.

    rest_table.py --program build/bench/lines LOG ...

Every stretch of a log in which the robot stands, as it was recorded and with every second beam; a mirror
image that does not show the same lines is told beside the table.
"""
import argparse
import json
import pathlib
import subprocess
import sys

MIRRORED = "mirrored"
SAME = 0.02  # by so much two scans may be told apart that tie


def stretches(program, log):
    done = subprocess.run([program, "rest", log, "--views", "--extractor", "ale"], check=False, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr.strip())
    return [json.loads(line) for line in done.stdout.splitlines()]


def cells(name, row):
    ends = "" if row["end_beams"] is None else f"{row['end_beams']:.2f}"
    direction = f"{row['direction_squared']:.1f} ({row['direction_worst']:.1f})" if row["surfaces"] else ""
    return [f"{name}, scan {row['first_scan']}", str(row["scans"]), row["view"], str(row["walls"]), f"{row['seen']:.1f}",
            f"{row['stray']:.2f}", ends, direction]


def mirror_differs(rows):
    plain, mirrored = (next(row for row in rows if row["view"] == view) for view in ("as recorded", MIRRORED))
    return plain["walls"] != mirrored["walls"] or abs(plain["stray"] - mirrored["stray"]) > SAME


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("logs", nargs="*", type=pathlib.Path)
    options = parser.parse_args()
    if not options.logs:
        parser.error("no recording: REST_LOGS='LOG ...' names some")
    head = ["recording", "scans", "view", "walls", "seen %", "stray lines a scan", "ends, beams",
            "squared error of directions (worst)"]
    print("| " + " | ".join(head) + " |")
    print("| --- | ---: | --- " + "| ---: " * (len(head) - 3) + "|")
    differ = []
    for log in options.logs:
        rows = stretches(options.program, log)
        for row in rows:
            if row["view"] != MIRRORED:
                print("| " + " | ".join(cells(log.name.split(".")[0], row)) + " |")
        for first in sorted({row["first_scan"] for row in rows}):
            if mirror_differs([row for row in rows if row["first_scan"] == first]):
                differ.append(f"{log.name}, scan {first}")
    print(f"\nMirrored the lines are {'others in ' + ', '.join(differ) if differ else 'the same'}.")


if __name__ == "__main__":
    main()

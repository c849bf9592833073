#!/usr/bin/env python3
"""How ale-fleet grows with its workers, as Markdown tables on stdout.

    fleet_table.py --build build [--drives 200] [--workers 1,2,4,8] [--rounds 1] [--only replay|merge]

Short drives through worlds of the tree go through ale-fleet replay with each number of workers; the start of the workers is counted in.
Rounds follow one another with all numbers of workers in each, and the fastest run of each number counts: others may use the machine.
Then two of four workers are killed on the way, and a scheduler and its workers run on two hosts. Every table must be the same.
merge: the five drives of `make bench-merge` become one map by ale-merge and by ale-fleet merge.
"""
import argparse
import os
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[4]
sys.path.insert(0, str(ROOT / "tools/lab/bench"))

import dying_workers  # noqa: E402
import map_score  # noqa: E402
import merge_table  # noqa: E402
import two_hosts  # noqa: E402
from lines_table import progress, table  # noqa: E402

WORLDS = ("home", "apartment", "arena", "office")
SCANS = 400
KILLED = 2


def made_drives(build, folder, count):
    """Logs of so many drives, and a folder of their truths."""
    (folder / "truths").mkdir()
    logs = []
    for k in range(count):
        progress(f"drive {k + 1} of {count}")
        log = folder / f"drive{k:03}.log"
        subprocess.run([build / "bin/ale-sim", "--world", ROOT / f"tools/lab/worlds/{WORLDS[k % len(WORLDS)]}.world", "--seed", str(k), "--write-log", log,
                        "--truth", folder / f"truths/{log.stem}.tum"], check=True, stdout=subprocess.DEVNULL)
        lines = log.read_text(encoding="ascii").splitlines(keepends=True)
        log.write_text("".join(lines[:SCANS]), encoding="ascii")
        logs.append(log)
    return logs


class Fleet:
    """Runs over the same logs, each with a table of its own."""

    def __init__(self, build, folder, logs):
        self.build, self.folder, self.logs = build, folder, logs
        self.tables = {}

    def started(self, name, *words, before=()):
        return subprocess.Popen([*before, sys.executable, self.build / "bin/ale-fleet", "replay", *self.logs, "--against", self.folder / "truths",
                                 "--out", self.folder / f"{name}.csv", *words], stderr=subprocess.PIPE)

    def ended(self, name, process):
        """With its table."""
        _, said = process.communicate()
        if process.returncode != 0:
            sys.exit(f"fleet_table.py: {name}: {said.decode(errors='replace')}")
        self.tables[name] = (self.folder / f"{name}.csv").read_bytes()

    def seconds(self, workers):
        begun = time.monotonic()
        self.ended(f"{workers} workers", self.started(f"{workers} workers", "--workers", str(workers)))
        return time.monotonic() - begun

    def with_killed_workers(self):
        name = f"{KILLED} of {2 * KILLED} workers killed on the way"
        process = self.started(name, "--workers", str(2 * KILLED))
        if not dying_workers.kill_workers(process, self.folder / f"{name}.csv.part", len(self.logs) // 4, KILLED):
            sys.exit("fleet_table.py: all was done before a worker could be killed")
        self.ended(name, process)

    def on_two_hosts(self):
        name = "scheduler and workers on two hosts"
        with two_hosts.scheduler(self.folder) as (address, here, _):
            self.ended(name, self.started(name, "--scheduler", address, before=here))

    def sameness(self):
        """Of each table with the first."""
        first = next(iter(self.tables.values()))
        return [[name, "the same" if content == first else "OTHER"] for name, content in self.tables.items()]


def wall_times(fleet, workers, rounds):
    """The fastest of each number of workers."""
    seconds = {count: [] for count in workers}
    for turn in range(rounds):
        for count in workers:
            progress(f"{count} workers, round {turn + 1} of {rounds}")
            seconds[count].append(fleet.seconds(count))
    return {count: min(times) for count, times in seconds.items()}


def replay_tables(options, folder):
    """True: every table is the same."""
    fleet = Fleet(options.build, folder, made_drives(options.build, folder, options.drives))
    seconds = wall_times(fleet, options.workers, options.rounds)
    progress("workers are killed ...")
    fleet.with_killed_workers()
    missing = two_hosts.why_not()
    if not missing:
        progress("two hosts ...")
        fleet.on_two_hosts()
    progress("")
    first, cores = next(iter(seconds.values())), os.cpu_count()
    print(f"{options.drives} drives of {SCANS} scans on {cores} cores:\n")
    table(["workers", "wall time, s", "speed-up", "of the cores there are"],
          [[str(count), f"{time_s:.1f}", f"{first / time_s:.2f}", f"{first / time_s / min(count, cores):.2f}"] for count, time_s in seconds.items()])
    print()
    table(["run", "its table"], [*fleet.sameness(), *([["two hosts", f"left out: {missing}"]] if missing else [])])
    print()
    return all(row[1] == "the same" for row in fleet.sameness())


def right_and_found(drawing, drives):
    """Of the map, in the frame of the first drive, against the world of the last."""
    drawn = map_score.in_plan(map_score.read_walls(drawing), map_score.read_poses(drives[0].truth)[0])
    return map_score.against_plan(drawn, map_score.read_numbers(drives[-1].world, 4), map_score.read_poses(drives[-1].truth))


def merge_row(name, command, folder, drives):
    progress(f"{name} ...")
    begun = time.monotonic()
    done = subprocess.run([*command, "--out", folder / "one.map", "--map", folder / "one.dxf"], stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode not in (0, 1):
        sys.exit(f"fleet_table.py: {name}: {done.stderr}")
    seconds = time.monotonic() - begun
    return [name, f"{seconds:.0f}", done.stderr.splitlines()[-1].partition(": ")[2],
            ", ".join(f"{100 * part:.1f}" for part in right_and_found(folder / "one.dxf", drives))]


def merge_tables(options, folder):
    drives = merge_table.office_drives(options.build, folder, 1)
    logs = [drive.log for drive in drives]
    ways = [("ale-merge", [options.build / "bin/ale-merge", *logs])]
    ways += [(f"ale-fleet merge, {count} workers", [sys.executable, options.build / "bin/ale-fleet", "merge", *logs, "--workers", str(count)])
             for count in options.workers if count <= len(logs)]
    rows = [merge_row(name, command, folder, drives) for name, command in ways]
    progress("")
    print(f"{len(logs)} drives through one office on {os.cpu_count()} cores:\n")
    table(["by", "wall time, s", "", "right, found, %"], rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build", type=pathlib.Path)
    parser.add_argument("--drives", default=200, type=int)
    parser.add_argument("--workers", default="1,2,4,8", type=lambda words: [int(word) for word in words.split(",")])
    parser.add_argument("--rounds", default=1, type=int)
    parser.add_argument("--only", default="", choices=("", "replay", "merge"))
    options = parser.parse_args()
    options.build = options.build.resolve()
    is_same = True
    with tempfile.TemporaryDirectory() as folder:
        if options.only in ("", "replay"):
            is_same = replay_tables(options, pathlib.Path(folder))
    with tempfile.TemporaryDirectory() as folder:
        if options.only in ("", "merge"):
            merge_tables(options, pathlib.Path(folder))
    return 0 if is_same else 1


if __name__ == "__main__":
    sys.exit(main())

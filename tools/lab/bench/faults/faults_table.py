#!/usr/bin/env python3
"""What becomes of a drive on which something goes wrong, as Markdown tables on stdout: a row for each kind of spoil.py.

    faults_table.py --build build [--shared FOLDER] [--seeds 1,2,3] [--only NAME,..] [--kinds KIND,..] [--odometry on|off]
                    [--carried N] [--jobs 2] [--each]

Drives: through the worlds of the tree, one of each seed; with the project's shared data at hand (ALE_SHARED) also its development
runs, and two recordings, whose truth is what their drive without a fault gives in the end. Beside the kinds of spoil.py:

alike      carried into one of two rooms furnished alike (world `alike`), both seen before
elsewhere  carried to a random place of the map after the whole drive, N times a world (--carried)
unknown    carried after half of the way to a random place at least 2 m from where the robot has been, N times a world (--carried)

Columns: ATE of the final trajectory, m. Within: 3 times the error of the drive without a fault and 30 mm; 0.15 m in recordings; where the
wheels lie all the time, the error of the drive without odometry counts; 0.30 m where the drive is told otherwise. Wrong, good: scans in
which the live pose, seen from the first scan, is more than 0.3 m or 10 degrees off while the state is good and the pose was not
predicted. Silent: those of them more than 5 sigmas off by the covariance told. Lost: scans. Ends: drives that end lost or more than 0.3 m off.

Where scans are away, wheels lie or the robot is carried, a second table: good scans more than 0.15 m off; drives that were good and
right again within 5 s of seeing a place that they knew (of those that saw one), and the longest time until then; where the poses name
their map (map_id), scans that stand in another than the first, and drives that end in another. --each prints the runs that were not
within or silently wrong, too: `spoil.py` makes their logs.
"""
import argparse
import concurrent.futures
import dataclasses
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import spoil  # noqa: E402
from drives import CARRIED_THERE, KINDS, Course  # noqa: E402
from judge import judged, replayed  # noqa: E402
from lines_table import progress, table  # noqa: E402
from slam_table import Bench, read_tum  # noqa: E402

# What a table adds up beside all of its kinds.
FAMILIES = {"faults that pass": spoil.PASSING + spoil.SCANS + ("carried",), "wheels that lie": spoil.LYING, "outages": spoil.OUTAGES,
            "told otherwise": spoil.TOLD_OTHERWISE, "carried there": CARRIED_THERE}
CLEAN_TIMES, CLEAN_MORE_M = 3, 0.03
WITHIN_RECORDED_M, WITHIN_TOLD_OTHERWISE_M = 0.15, 0.30
JOINED_S = 5


def told_with(build, drive, kind, seed, odometry, folder, *words):
    """What ale-replay says of a drive with a fault, and the first scan after that; nothing where the kind does not fit."""
    spoilt = drive.spoilt(build, kind, seed, folder)
    if not spoilt:
        return None
    log, after, places, headings = spoilt
    path = pathlib.Path(folder) / "spoilt.log"
    log.write(path)
    return replayed(build, path, places, headings, odometry, *words), after


def run(task):
    """One fault in one drive: its figures."""
    build, drive, kind, seed, odometry = task
    row = {"group": drive.group, "drive": drive.name, "kind": kind, "seed": seed}
    with tempfile.TemporaryDirectory() as folder:
        try:
            done = told_with(build, drive, kind, seed, odometry, folder)
        except (subprocess.CalledProcessError, ValueError) as error:
            return {**row, "failed": str(getattr(error, "stdout", "") or error).splitlines()[-1]}
    if not done:
        return {}
    row.update(judged(*done))
    row["within"] = row["ate"] <= limit_m(drive, kind)
    return row


def limit_m(drive, kind):
    """Up to which error of the final trajectory a drive is within."""
    if kind in spoil.TOLD_OTHERWISE:
        return WITHIN_TOLD_OTHERWISE_M
    return drive.limits_m[kind in spoil.LYING]


def run_clean(task):
    """A drive without a fault: the limits that follow from its errors with odometry and without, and its figures; a recording has got its
    truth then."""
    build, drive, odometry = task
    if drive.recorded:
        live, final, _ = Bench(build, drive.truth.parent).replay(drive.log, "--odometry", odometry)
        live.unlink()
        final.rename(drive.truth)
    _, places, headings = read_tum(drive.truth)
    told, without = (replayed(build, drive.log, places, headings, wheels) for wheels in (odometry, "off"))
    limits_m = tuple(error + WITHIN_RECORDED_M if drive.recorded else CLEAN_TIMES * error + CLEAN_MORE_M for error in (told.ate_m(), without.ate_m()))
    return limits_m, {"group": drive.group, "drive": drive.name, "kind": "clean", "seed": drive.seeds[0], **judged(told, 0), "within": True}


def with_limits(drive, clean):
    return dataclasses.replace(drive, limits_m=clean[drive.log][0])


def tasks_of(build, drive, odometry):
    """What is told otherwise does not depend on when: once a drive."""
    return [(build, drive, kind, seed, odometry) for kind in drive.kinds for seed in drive.seeds
            if not (kind in spoil.TOLD_OTHERWISE and seed != drive.seeds[0])]


def all_runs(build, drives, odometry, jobs):
    """The figures of every run, in the order of the drives."""
    with concurrent.futures.ProcessPoolExecutor(jobs) as pool:
        without_fault = {drive.log: (build, drive, odometry) for drive in drives}
        clean = dict(zip(without_fault, pool.map(run_clean, without_fault.values())))
        yield from (row for _, row in clean.values())
        tasks = [task for drive in drives for task in tasks_of(build, with_limits(drive, clean), odometry)]
        for number, row in enumerate(pool.map(run, tasks)):
            progress(f"{number + 1} of {len(tasks)} runs ...")
            if row:
                yield row
    progress("")


def faults_row(name, rows):
    whole = [row for row in rows if "failed" not in row]
    ates = [row["ate"] for row in whole] or [np.nan]
    def count(key):
        return str(sum(row[key] for row in whole))
    return [name, str(len(rows)), f"{np.median(ates):.3f}", f"{max(ates):.3f}", count("within"), count("wrong"), count("silent"), count("lost"),
            str(sum(row["end"] for row in whole) + len(rows) - len(whole))]


def after_row(name, rows):
    """What came after the fault."""
    whole = [row for row in rows if "failed" not in row]
    known = [row["joined_s"] for row in whole if row["joined_s"] is not None]
    latest = f"{max(known):.1f}" if known and np.isfinite(max(known)) else "never" if known else "-"
    return [name, str(len(rows)), str(sum(row["good_off"] for row in whole)), f"{sum(time <= JOINED_S for time in known)} of {len(known)}", latest,
            str(sum(row["other_map"] for row in whole)), str(sum(row["ends_in_other"] for row in whole))]


def of_kinds(rows, families):
    """Of each family of kinds by its name the rows, where there are any."""
    found = {name: [row for row in rows if row["kind"] in kinds] for name, kinds in families.items()}
    return {name: chosen for name, chosen in found.items() if chosen}


def by_kind(rows, kinds):
    return of_kinds(rows, {kind: (kind,) for kind in kinds})


def print_group(group, rows):
    sums = of_kinds(rows, FAMILIES)
    sums = {**(sums if len(sums) > 1 else {}), **of_kinds(rows, {"all": KINDS})}
    print(f"{group}:\n")
    table(["kind", "runs", "ATE median, m", "worst", "within", "wrong, good", "silent wrong", "lost scans", "ends lost"],
          [faults_row(name, chosen) for name, chosen in {**by_kind(rows, ("clean",) + KINDS), **sums}.items()])
    away = by_kind(rows, spoil.OUTAGES + spoil.LYING + ("gap", "dark", "carried") + CARRIED_THERE)
    if away:
        print(f"{group}, after the fault:\n")
        table(["kind", "runs", "good, 0.15 m off", "joined within 5 s", "latest, s", "scans in another map", "end in another map"],
              [after_row(kind, of_kind) for kind, of_kind in away.items()])
    sys.stdout.flush()


def print_each(rows):
    """The runs that went wrong, one by one."""
    bad = [row for row in rows if "failed" not in row and (not row["within"] or row["silent"])]
    if bad:
        table(["drive", "kind", "seed", "ATE, m", "silent wrong", "lost scans"],
              [[row["drive"], row["kind"], str(row["seed"]), f"{row['ate']:.3f}", str(row["silent"]), str(row["lost"])] for row in bad])


def names(text):
    return tuple(text.split(",")) if text else ()


def parsed():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build")
    parser.add_argument("--shared", default=os.environ.get("ALE_SHARED", ""))
    parser.add_argument("--seeds", default="1,2,3", help="of the drives through the worlds of the tree, and of the faults")
    parser.add_argument("--only", default="", metavar="NAME,..", help="these worlds, runs and recordings alone")
    parser.add_argument("--kinds", default="", metavar="KIND,..", help="these alone")
    parser.add_argument("--odometry", choices=("on", "off"), default="on", help="off: without the faults of wheels")
    parser.add_argument("--carried", type=int, default=0, metavar="N", help="how many drives of each world are carried elsewhere, and to an unknown place")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--each", action="store_true", help="name the runs that went wrong")
    options = parser.parse_args()
    if not re.fullmatch(r"\d+(,\d+)*", options.seeds):
        parser.error(f"--seeds {options.seeds}: not numbers with commas between them")
    unknown = [kind for kind in names(options.kinds) if kind not in KINDS]
    if unknown:
        parser.error(f"--kinds {unknown[0]}: not one of {' '.join(KINDS)}")
    if options.jobs < 1 or options.carried < 0:
        parser.error("--jobs wants at least 1, --carried at least 0")
    if not (pathlib.Path(options.build) / "bin/ale-replay").exists():
        sys.exit(f"faults_table.py: no programs in {options.build}/bin (make builds them)")
    return options


def with_programs(build, folder):
    """The programs as they are now: they may be built anew while the table is made."""
    copied = pathlib.Path(folder) / "build"
    (copied / "bin").mkdir(parents=True)
    for program in ("ale-replay", "ale-sim"):
        shutil.copy(pathlib.Path(build) / "bin" / program, copied / "bin")
    return copied


def main():
    options = parsed()
    seeds = tuple(map(int, options.seeds.split(",")))
    kinds = tuple(kind for kind in names(options.kinds) or KINDS if options.odometry == "on" or kind not in spoil.WHEELS)
    only = names(options.only)
    with tempfile.TemporaryDirectory() as folder:
        build = with_programs(options.build, folder)
        course = Course(build, folder, seeds, kinds)
        drives = list(course.drives(options.shared, lambda name: not only or name in only, options.carried))
        if not drives:
            sys.exit(f"faults_table.py: no drive here for {options.only or 'these kinds'} (runs and recordings: ALE_SHARED)")
        rows = []
        for group in dict.fromkeys(drive.group for drive in drives):
            of_group = list(all_runs(build, [drive for drive in drives if drive.group == group], options.odometry, options.jobs))
            print_group(group, of_group)
            rows += of_group
    if options.each:
        print_each(rows)
    failed = [row for row in rows if "failed" in row]
    for row in failed:
        print(f"faults_table.py: {row['drive']}, {row['kind']}, seed {row['seed']}: {row['failed']}", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

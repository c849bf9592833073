#!/usr/bin/env python3
"""Drives with each scanner's model (noise, rate, seam, drop-outs), read with that scanner's preset, as Markdown tables on stdout.

    scanners_table.py --build build [--shared FOLDER] [--seeds 1] [--only ld06,urg-04lx] [--worlds home] [--jobs 2]

ale-sim --sensor writes the drive, ale-replay --model reads it. Of a scanner that speaks SCIP the log is one of scans, of one of a whole
turn a recording of its line, from which the driver makes the scans. Beside each figure stands how many times the URG's it is. A scan
is wrong when the state is good and the pose told is off by 10 cm or 0.1 rad, seen from where the drive began.
"""
import argparse
import concurrent.futures
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from lines_table import progress, table  # noqa: E402
from slam_table import ROOT, at_times, read_tum, trajectory_error, wrapped  # noqa: E402

WORLDS = ("home", "apartment", "office", "arena", "maze")
REFERENCE = "urg-04lx"
SCANNERS = (REFERENCE, "utm-30lx", "ust-10lx", "ld06", "stl-19p", "rplidar-a1", "rplidar-c1", "rplidar-s2")
LOST, GOOD = 0, 2
OFF_M, OFF_RAD = 0.10, 0.10
VIA_M = 0.4  # from point to point of a way that is a trajectory


def maze_of(shared, folder):
    """The maze of the shared data as a world: its plan, and its drive as the way. None: it is not there."""
    maze = pathlib.Path(shared or "/nonexistent") / "bench/slam/maze"
    if not maze.is_dir():
        return None
    _, places, headings = read_tum(maze / "truth.tum")
    via = [places[0]]
    for place in places:
        if abs(place - via[-1]) >= VIA_M:
            via.append(place)
    world = folder / "maze.world"
    lines = [f"# start {places[0].real:.3f} {places[0].imag:.3f} {headings[0]:.4f}"]
    lines += [f"# via {place.real:.3f} {place.imag:.3f}" for place in (*via[1:], places[-1])]
    world.write_text("\n".join(lines) + "\n" + (maze / "plan.txt").read_text(encoding="utf-8"), encoding="utf-8")
    return world


def scans_lost_and_wrong(poses, truth):
    rows = [json.loads(line) for line in poses.read_text(encoding="utf-8").splitlines()]
    true_places, true_headings = at_times(np.array([row["t"] for row in rows]), read_tum(truth))
    states = np.array([row["state"] for row in rows])
    places = np.array([row["map_x"] + 1j * row["map_y"] for row in rows])
    headings = np.array([row["map_theta"] for row in rows])
    turn = headings[0] - true_headings[0]
    off_m = np.abs(places - places[0] - (true_places - true_places[0]) * np.exp(1j * turn))
    off_rad = np.abs(wrapped(headings - true_headings - turn))
    wrong = (states == GOOD) & ((off_m > OFF_M) | (off_rad > OFF_RAD))
    return int(np.sum(states == LOST)), int(np.sum(wrong))


def drive(build, world, scanner, seed):
    """Of odometry on and off: ATE final, live (mm), scans lost, scans wrong while good."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        log, truth, poses, live, final = (folder / file for file in ("drive.log", "truth.tum", "poses.jsonl", "live.tum", "final.tum"))
        subprocess.run([build / "bin/ale-sim", "--world", world, "--sensor", scanner, "--seed", str(seed), "--write-log", log,
                        "--truth", truth], check=True, stdout=subprocess.DEVNULL)
        results = []
        for odometry in ("on", "off"):
            subprocess.run([build / "bin/ale-replay", log, "--model", scanner, "--odometry", odometry, "--poses", poses,
                            "--trajectory-live", live, "--trajectory", final], check=True, stderr=subprocess.DEVNULL)
            results.append((trajectory_error(final, truth)[0], trajectory_error(live, truth)[0], *scans_lost_and_wrong(poses, truth)))
    return np.array(results)


def cell(result, reference):
    final, live = result[0], result[1]
    worst = max(final / reference[0], live / reference[1])
    return f"{final:.1f} / {live:.1f} ({worst:.1f})"


def world_table(world, results, seeds):
    """results: by scanner, the mean over the seeds, but the sum of scans."""
    reference = results[REFERENCE]
    rows = [[scanner, *(cell(result[k], reference[k]) for k in (0, 1)), f"{result[:, 2].sum():.0f}", f"{result[:, 3].sum():.0f}"]
            for scanner, result in results.items()]
    print(f"{world}; ATE in mm, final / live (the larger of both as so many of the URG's), seeds {seeds}:\n")
    table(["scanner", "with odometry", "without", "scans lost", "wrong while good"], rows)


def mean_of(drives):
    stacked = np.stack(drives)
    return np.concatenate([stacked[:, :, :2].mean(axis=0), stacked[:, :, 2:].sum(axis=0)], axis=1)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build"))
    parser.add_argument("--shared", default=os.environ.get("ALE_SHARED", ""))
    parser.add_argument("--seeds", default="1")
    parser.add_argument("--only", default=",".join(SCANNERS), help="scanners, by the names of ale-sim --sensor")
    parser.add_argument("--worlds", default=",".join(WORLDS))
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    if not re.fullmatch(r"\d+(,\d+)*", options.seeds):
        parser.error(f"--seeds {options.seeds}: not numbers with commas between them")
    if not (options.build / "bin/ale-replay").exists():
        sys.exit(f"scanners_table.py: no programs in {options.build}/bin (make builds them)")
    scanners = list(dict.fromkeys([REFERENCE, *options.only.split(",")]))
    worst = 0.0
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for name in options.worlds.split(","):
            world = maze_of(options.shared, pathlib.Path(folder)) if name == "maze" else ROOT / f"tools/lab/worlds/{name}.world"
            if world is None:
                print("No maze here: ALE_SHARED names no folder with bench/slam/maze.\n")
                continue
            progress(f"{name} ...")
            drives = {scanner: [pool.submit(drive, options.build.resolve(), world, scanner, seed) for seed in options.seeds.split(",")]
                      for scanner in scanners}
            results = {scanner: mean_of([one.result() for one in futures]) for scanner, futures in drives.items()}
            progress("")
            world_table(name, results, options.seeds)
            ratios = [result[:, :2] / results[REFERENCE][:, :2] for result in results.values()]
            worst = max(worst, float(np.max(ratios)))
    print(f"At worst {math.ceil(10 * worst) / 10:.1f} times the URG's.")


if __name__ == "__main__":
    main()

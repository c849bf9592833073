#!/usr/bin/env python3
"""How well drives become one map, as Markdown tables on stdout.

    merge_table.py --build build [--shared FOLDER] [--seeds 1,2] [--only office|intel|hall] [--maps FOLDER]

Buildings: five drives through the office of the tree, each from another place, one way round or the other, with its own wheels and
noise, and before each but the first four pieces of furniture moved. ATE: of all poses of all drives after one rigid alignment.
Intel: the recording cut into six drives, named backwards. Hall: exp1 and exp3, two drives of a rover. With --maps their pictures are
kept there.
"""
import argparse
import gzip
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile

import numpy as np

import map_score
from lines_table import progress
from published_table import read_relations, relation_errors
from slam_table import ROOT, aligned_errors, at_times, read_tum, score, titled_table

DRIVES, MOVED_BOXES, MOVED_M = 5, 4, 0.9
DAY_S, FIRST_DAY_S = 86400, 1700000000
BOXES = "# pillars and cabinets along the walls"
CORRIDORS_Y = (-1.0, 1.0, 15.5, 17.5)  # walls along x that furniture stands at
PIECES = 6


class Office:
    """The office as it stands on one day, and a way through it."""

    def __init__(self):
        lines = (ROOT / "tools/lab/worlds/office.world").read_text(encoding="utf-8").splitlines()
        at = lines.index(BOXES)
        self.walls = [line for line in lines[:at] if not line.startswith("#")]
        numbers = np.array([[float(word) for word in line.split()] for line in lines[at + 1:]])
        self.boxes = list(numbers.reshape(-1, 4, 4))
        self.way = [tuple(map(float, line.split()[2:])) for line in lines if line.startswith("# via")][:-2]

    def move_furniture(self, dice):
        for k in dice.sample(range(len(self.boxes)), MOVED_BOXES):
            across = self.boxes[k][:, 1]
            along_x = any(abs(across - y).min() < 0.01 for y in CORRIDORS_Y)
            step = dice.choice((-MOVED_M, MOVED_M))
            self.boxes[k] = self.boxes[k] + np.array([step, 0, step, 0] if along_x else [0, step, 0, step])

    def written(self, path, dice):
        """A file of the world, with a way that begins anywhere and ends a little beyond its beginning."""
        first = dice.randrange(len(self.way))
        way = self.way[first:] + self.way[:first]
        way = way if dice.random() < 0.5 else [way[0], *way[:0:-1]]
        (x, y), (next_x, next_y) = way[:2]
        way += [way[0], ((x + next_x) / 2, (y + next_y) / 2)]
        lines = [f"# start {x:.3f} {y:.3f} {math.atan2(next_y - y, next_x - x):.4f}"]
        lines += [f"# via {x:.3f} {y:.3f}" for x, y in way[1:]] + self.walls
        lines += [" ".join(f"{number:.3f}" for number in wall) for box in self.boxes for wall in box]
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
        return path


def made_drives(build, folder, seed):
    """Logs and truths of the drives through one building, a day between them; the world as it stands at the last."""
    office, dice, logs = Office(), random.Random(seed), []
    for day in range(DRIVES):
        if day > 0:
            office.move_furniture(dice)
        world = office.written(folder / f"day{day}.world", dice)
        log, truth = folder / f"day{day}.log", folder / f"day{day}.truth"
        subprocess.run([build / "bin/ale-sim", "--world", world, "--seed", str(100 * seed + day), "--write-log", log, "--truth", truth],
                       check=True, stdout=subprocess.DEVNULL)
        os.utime(log, (FIRST_DAY_S + DAY_S * day,) * 2)
        logs.append((log, truth))
    return logs, world


def merged(build, folder, logs, *words):
    """The folder of trajectories, and what was said."""
    poses = folder / "poses"
    done = subprocess.run([build / "bin/ale-merge", *logs, "--trajectories", poses, *words], stderr=subprocess.PIPE, text=True)
    if done.returncode not in (0, 1):
        sys.exit(f"merge_table.py: {done.stderr}")
    return poses, done.stderr.splitlines()[-1].removeprefix("ale-merge: ")


def office_table(build, seeds, maps):
    rows = []
    for seed in map(int, seeds.split(",")):
        progress(f"office, seed {seed} ...")
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            logs, world = made_drives(build, folder, seed)
            drawing = folder / "map.dxf"
            poses, said = merged(build, folder, [log for log, _ in logs], "--map", drawing, "--points", "--map", maps / f"office-{seed}.png")
            places, true_places = [], []
            for log, truth in logs:
                if (poses / f"{log.stem}.tum").stat().st_size:
                    times, found, _ = read_tum(poses / f"{log.stem}.tum")
                    places.append(found)
                    true_places.append(at_times(times, read_tum(truth))[0])
            errors = aligned_errors(np.concatenate(places), np.concatenate(true_places))
            pairs, along = map_score.standing_twice(map_score.read_walls(drawing))
            rows.append([str(seed), said, f"{1e3 * np.sqrt(np.mean(errors ** 2)):.1f}", f"{1e3 * errors.max():.0f}", f"{pairs}, {along:.1f} m",
                         ", ".join(f"{100 * part:.1f}" for part in map_score.against_plan(map_score.read_walls(drawing), world, logs[0][1]))])
    titled_table(f"{DRIVES} drives of one office, {MOVED_BOXES} pieces of furniture moved before each but the first; the map against the world as "
                 "it stands at the last:",
                 ["seed", "", "ATE, mm", "longest, mm", "walls twice", "right, found, %"], rows)


def cut(log, folder):
    """Six drives of one, by its laser lines."""
    with gzip.open(log, "rt", encoding="ascii") as lines:
        scans = [line for line in lines if line.startswith("FLASER")]
    pieces = []
    for k in range(PIECES):
        piece = folder / f"piece{k}.clf"
        piece.write_text("".join(scans[len(scans) * k // PIECES:len(scans) * (k + 1) // PIECES]), encoding="ascii")
        pieces.append(piece)
    return pieces


def joined(paths):
    """Trajectories of pieces as one; a scan that is in no map stands at no place."""
    return tuple(np.concatenate(parts) for parts in zip(*(read_tum(path) for path in paths if path.stat().st_size)))


def intel_table(build, data, maps):
    log, relations = data / "intel/intel_every5th.clf.gz", data / "intel/intel_every5th.relidx"
    if not log.exists():
        return
    progress("intel ...")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        pieces = cut(log, folder)
        poses, said = merged(build, folder, pieces[::-1], "--frame", "laser", "--points", "--map", maps / "intel.png")
        rows = np.loadtxt(relations, comments="#")
        stamps, (_, true) = rows[:, 5:7], read_relations(relations)
        times, places, headings = joined([poses / f"{piece.stem}.tum" for piece in pieces])
        ends = np.array([[np.abs(times - stamp).argmin() for stamp in pair] for pair in stamps])
        known = (np.abs(times[ends] - stamps) < 0.01).all(axis=1)
        metres, _ = relation_errors((times, places, headings), ends[known], true[known])
    titled_table(f"The Intel building, cut into {PIECES} drives:", ["", "mean error of known relations, m", "relations"],
                 [[said, f"{metres.mean():.4f}", f"{len(metres)} of {len(true)}"]])


def hall_table(build, shared, maps):
    scorers, recordings = shared / "bench/slam", shared / "data/urg04lx"
    if not (recordings / "exp1.dat").exists():
        return
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        logs = [recordings / f"{drive}.dat" for drive in ("exp1", "exp3")]
        carmen = [folder / f"{log.stem}.clf" for log in logs]
        for log, path in zip(logs, carmen):
            subprocess.run([sys.executable, scorers / "exp2carmen.py", log, path, "0.155"], check=True, stdout=subprocess.DEVNULL)
        for names in ([0], [1], [0, 1]):
            progress(f"hall, {len(names)} drives ...")
            picture = maps / ("hall-" + "-".join(logs[k].stem for k in names) + ".png")
            poses, said = merged(build, folder, [logs[k] for k in names], "--frame", "laser", "--points", "--map", picture)
            both, way = folder / "both.clf", folder / "both.tum"
            both.write_text("".join(carmen[k].read_text(encoding="ascii") for k in names), encoding="ascii")
            way.write_text("".join((poses / f"{logs[k].stem}.tum").read_text(encoding="ascii") for k in names), encoding="ascii")
            entropy, angle = (score(scorers / f"{script}.py", both, way).get(measure, math.nan)
                              for script, measure in (("crisp", "mme"), ("rightangle", "rms_deg")))
            rows.append([" and ".join(logs[k].stem for k in names), said, f"{entropy:.3f}", f"{angle:.2f}"])
    titled_table("Two drives of a rover in one hall, no truth: entropy of the map, wall angle in degrees (root mean square):",
                 ["recording", "", "entropy", "wall angle"], rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build", type=pathlib.Path)
    parser.add_argument("--shared", default=os.environ.get("ALE_SHARED") or "/nonexistent", type=pathlib.Path)
    parser.add_argument("--seeds", default="1", help="of the buildings")
    parser.add_argument("--only", default="", choices=("", "office", "intel", "hall"))
    parser.add_argument("--maps", type=pathlib.Path, help="folder for the pictures")
    options = parser.parse_args()
    if not (options.build / "bin/ale-merge").exists():
        sys.exit(f"merge_table.py: no programs in {options.build}/bin (make builds them)")
    with tempfile.TemporaryDirectory() as folder:
        maps = options.maps or pathlib.Path(folder)
        maps.mkdir(parents=True, exist_ok=True)
        if options.only in ("", "office"):
            office_table(options.build, options.seeds, maps)
        if options.only in ("", "intel"):
            intel_table(options.build, options.shared / "data", maps)
        if options.only in ("", "hall"):
            hall_table(options.build, options.shared, maps)


if __name__ == "__main__":
    main()

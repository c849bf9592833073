#!/usr/bin/env python3
"""How well drives become one map, as Markdown tables on stdout.

    merge_table.py --build build [--shared FOLDER] [--seeds 1,2] [--pieces 6,4] [--only office|alike|intel|hall] [--maps FOLDER]

Buildings: five drives through the office of the tree, each from another place, one way round or the other, with its own wheels and
noise, and before each but the first four pieces of furniture moved. ATE: of all poses of all drives in the map after one rigid
alignment, and by it the map lies on the plan. Gone: metres that are drawn where only an earlier day had a wall.
Alike: two homes that differ in one room, two drives in each, in turn. Their places have the same coordinates: where homes are joined
the ATE is of all.
Intel: the recording cut into drives, named backwards. Hall: exp1 and exp3, two drives of a rover. With --maps their pictures are
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
from slam_table import ROOT, aligned_errors, at_times, best_alignment, read_tum, score, titled_table

DRIVES, MOVED_BOXES, MOVED_M = 5, 4, 0.9
DAY_S, FIRST_DAY_S = 86400, 1700000000
BOXES = "# pillars and cabinets along the walls"
CORRIDORS_Y = (-1.0, 1.0, 15.5, 17.5)  # walls along x that furniture stands at
KITCHEN, HALL = "# kitchen: counter, dresser, table, fridge", "# hall: cabinet, chest"
OTHER_KITCHEN = ["8.2 0 8.2 3.95", "5.05 0.9 8.2 0.9"]  # narrower, and without furniture


def read_world(name):
    """Lines of a world of the tree, and its way."""
    lines = (ROOT / f"tools/lab/worlds/{name}.world").read_text(encoding="utf-8").splitlines()
    return lines, [tuple(map(float, line.split()[2:4])) for line in lines if line.startswith(("# start", "# via"))]


def write_world(path, walls, way, dice):
    """A file of the world, with a way that begins anywhere and ends a little beyond its beginning."""
    first = dice.randrange(len(way))
    way = way[first:] + way[:first]
    way = way if dice.random() < 0.5 else [way[0], *way[:0:-1]]
    (x, y), (next_x, next_y) = way[:2]
    way += [way[0], ((x + next_x) / 2, (y + next_y) / 2)]
    lines = [f"# start {x:.3f} {y:.3f} {math.atan2(next_y - y, next_x - x):.4f}"]
    lines += [f"# via {x:.3f} {y:.3f}" for x, y in way[1:]] + walls
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


class Office:
    """The office as it stands on one day."""

    def __init__(self):
        lines, way = read_world("office")
        at = lines.index(BOXES)
        self.walls = [line for line in lines[:at] if not line.startswith("#")]
        numbers = np.array([[float(word) for word in line.split()] for line in lines[at + 1:]])
        self.boxes = list(numbers.reshape(-1, 4, 4))
        self.way = way[1:-2]  # the file's own ends beyond its beginning

    def move_furniture(self, dice):
        for k in dice.sample(range(len(self.boxes)), MOVED_BOXES):
            across = self.boxes[k][:, 1]
            along_x = any(abs(across - y).min() < 0.01 for y in CORRIDORS_Y)
            step = dice.choice((-MOVED_M, MOVED_M))
            self.boxes[k] = self.boxes[k] + np.array([step, 0, step, 0] if along_x else [0, step, 0, step])

    def written(self, path, dice):
        boxes = [" ".join(f"{number:.3f}" for number in wall) for box in self.boxes for wall in box]
        write_world(path, self.walls + boxes, self.way, dice)


def home_and_its_like():
    """Walls of both, and the way through either."""
    lines, way = read_world("home")
    kitchen, hall = lines.index(KITCHEN), lines.index(HALL)
    homes = ([line for line in chosen if not line.startswith("#")] for chosen in (lines, lines[:kitchen] + OTHER_KITCHEN + lines[hall:]))
    return *homes, way[:-1]


class Drive:
    """A simulated drive of one day, in files beside that of its world, FOLDER/dayN.world."""

    def __init__(self, build, folder, day, seed):
        self.world, self.log, self.truth = (folder / f"day{day}.{kind}" for kind in ("world", "log", "truth"))
        subprocess.run([build / "bin/ale-sim", "--world", self.world, "--seed", str(100 * seed + day), "--write-log", self.log, "--truth", self.truth],
                       check=True, stdout=subprocess.DEVNULL)
        os.utime(self.log, (FIRST_DAY_S + DAY_S * day,) * 2)


def office_drives(build, folder, seed):
    office, dice, drives = Office(), random.Random(seed), []
    for day in range(DRIVES):
        if day > 0:
            office.move_furniture(dice)
        office.written(folder / f"day{day}.world", dice)
        drives.append(Drive(build, folder, day, seed))
    return drives


def alike_drives(build, folder, seed):
    home, its_like, way = home_and_its_like()
    dice, drives = random.Random(seed), []
    for day, walls in enumerate((home, its_like) * 2):
        write_world(folder / f"day{day}.world", walls, way, dice)
        drives.append(Drive(build, folder, day, seed))
    return drives


def merged(build, folder, logs, *words):
    """The folder of trajectories, and what was said."""
    poses = folder / "poses"
    done = subprocess.run([build / "bin/ale-merge", *logs, "--trajectories", poses, *words], stderr=subprocess.PIPE, text=True)
    if done.returncode not in (0, 1):
        sys.exit(f"merge_table.py: {done.stderr}")
    return poses, done.stderr.splitlines()[-1].removeprefix("ale-merge: ")


def places_of(poses, drives):
    """Where the drives were by the map, and in truth."""
    places, true_places = [], []
    for drive in drives:
        way = poses / f"{drive.log.stem}.tum"
        if way.stat().st_size:
            times, found, _ = read_tum(way)
            places.append(found)
            true_places.append(at_times(times, read_tum(drive.truth))[0])
    return np.concatenate(places), np.concatenate(true_places)


def told_errors(places, true_places):
    errors = aligned_errors(places, true_places)
    return [f"{1e3 * np.sqrt(np.mean(errors ** 2)):.1f}", f"{1e3 * errors.max():.0f}"]


def gone_m(drawn, plans):
    """Drawn where no wall of the last plan is, but one of an earlier."""
    right = [map_score.are_right(drawn, plan) for plan in plans]
    return map_score.STEP_M * (np.any(right, axis=0) & ~right[-1]).sum()


def told_map(drawing, drives, origin, turn):
    """The map against the plans; where its origin lies in them, and its turn."""
    drawn = map_score.in_plan(map_score.read_walls(drawing), (origin.real, origin.imag, turn))
    plans = [map_score.read_numbers(drive.world, 4) for drive in drives]
    pairs, along = map_score.standing_twice(drawn, plans[-1])
    right, found = map_score.against_plan(drawn, plans[-1], map_score.read_poses(drives[-1].truth))
    return [f"{pairs}, {along:.1f} m", f"{gone_m(drawn, plans):.1f}", f"{100 * right:.1f}, {100 * found:.1f}"]


def rows_of(name, seeds, row_of):
    """One for each seed, of the drives and the map in a folder."""
    rows = []
    for seed in map(int, seeds.split(",")):
        progress(f"{name}, seed {seed} ...")
        with tempfile.TemporaryDirectory() as folder:
            rows.append([str(seed), *row_of(pathlib.Path(folder), seed)])
    return rows


def office_table(build, seeds, maps):
    def row_of(folder, seed):
        drives, drawing = office_drives(build, folder, seed), folder / "map.dxf"
        poses, said = merged(build, folder, [drive.log for drive in drives], "--map", drawing, "--points", "--map", maps / f"office-{seed}.png")
        ways = places_of(poses, drives)
        return [said, *told_errors(*ways), *told_map(drawing, drives, *best_alignment(*ways))]

    titled_table(f"{DRIVES} drives of one office, {MOVED_BOXES} pieces of furniture moved before each but the first; the map against the world as "
                 "it stands at the last:",
                 ["seed", "", "ATE, mm", "longest, mm", "walls twice", "gone, m", "right, found, %"], rows_of("office", seeds, row_of))


def alike_table(build, seeds, maps):
    def row_of(folder, seed):
        drives = alike_drives(build, folder, seed)
        poses, said = merged(build, folder, [drive.log for drive in drives], "--points", "--map", maps / f"alike-{seed}.png")
        return [said, *told_errors(*places_of(poses, drives))]

    titled_table("Two homes that are alike but for the kitchen, two drives in each:", ["seed", "", "ATE, mm", "longest, mm"],
                 rows_of("alike", seeds, row_of))


def cut(log, folder, count):
    """So many drives of one, by its laser lines."""
    with gzip.open(log, "rt", encoding="ascii") as lines:
        scans = [line for line in lines if line.startswith("FLASER")]
    pieces = []
    for k in range(count):
        piece = folder / f"piece{k}.clf"
        piece.write_text("".join(scans[len(scans) * k // count:len(scans) * (k + 1) // count]), encoding="ascii")
        pieces.append(piece)
    return pieces


def joined(paths):
    """Trajectories of pieces as one; a scan that is in no map stands at no place."""
    return tuple(np.concatenate(parts) for parts in zip(*(read_tum(path) for path in paths if path.stat().st_size)))


def intel_row(build, log, relations, count, picture):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        pieces = cut(log, folder, count)
        poses, said = merged(build, folder, pieces[::-1], "--frame", "laser", "--points", "--map", picture)
        times, places, headings = joined([poses / f"{piece.stem}.tum" for piece in pieces])
    rows = np.loadtxt(relations, comments="#")
    stamps, (_, true) = rows[:, 5:7], read_relations(relations)
    ends = np.array([[np.abs(times - stamp).argmin() for stamp in pair] for pair in stamps])
    known = (np.abs(times[ends] - stamps) < 0.01).all(axis=1)
    metres, _ = relation_errors((times, places, headings), ends[known], true[known])
    return [said, f"{metres.mean():.4f}", f"{len(metres)} of {len(true)}"]


def intel_table(build, data, counts, maps):
    log, relations = data / "intel/intel_every5th.clf.gz", data / "intel/intel_every5th.relidx"
    if not log.exists():
        return
    rows = []
    for count in map(int, counts.split(",")):
        progress(f"intel, {count} drives ...")
        rows.append(intel_row(build, log, relations, count, maps / f"intel-{count}.png"))
    titled_table("The Intel building, cut into drives:", ["", "mean error of known relations, m", "relations"], rows)


def sharpness(scorers, log, way):
    return [f"{score(scorers / f'{script}.py', log, way).get(measure, math.nan):{form}}"
            for script, measure, form in (("crisp", "mme", ".3f"), ("rightangle", "rms_deg", ".2f"))]


def every_second(paths, to):
    """Of two drives as many scans as of one: entropy grows with their number."""
    to.write_text("".join(line for path in paths for line in path.read_text(encoding="ascii").splitlines(keepends=True)[::2]), encoding="ascii")
    return to


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
            ways = [poses / f"{logs[k].stem}.tum" for k in names]
            rows += [[logs[k].stem, said, *sharpness(scorers, carmen[k], way)] for k, way in zip(names, ways)]
            some, way = every_second([carmen[k] for k in names], folder / "some.clf"), folder / "some.tum"
            way.write_text("".join(path.read_text(encoding="ascii") for path in ways), encoding="ascii")
            rows.append([f"every second scan of {' and '.join(logs[k].stem for k in names)}", said, sharpness(scorers, some, way)[0], ""])
    titled_table("Two drives of a rover in one hall, no truth: entropy of what their scans show, wall angle in degrees (root mean square):",
                 ["scans of", "poses of", "entropy", "wall angle"], rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build", type=pathlib.Path)
    parser.add_argument("--shared", default=os.environ.get("ALE_SHARED") or "/nonexistent", type=pathlib.Path)
    parser.add_argument("--seeds", default="1", help="of the buildings")
    parser.add_argument("--pieces", default="6", help="drives that the Intel recording is cut into")
    parser.add_argument("--only", default="", choices=("", "office", "alike", "intel", "hall"))
    parser.add_argument("--maps", type=pathlib.Path, help="folder for the pictures")
    options = parser.parse_args()
    if not (options.build / "bin/ale-merge").exists():
        sys.exit(f"merge_table.py: no programs in {options.build}/bin (make builds them)")
    with tempfile.TemporaryDirectory() as folder:
        maps = options.maps or pathlib.Path(folder)
        maps.mkdir(parents=True, exist_ok=True)
        if options.only in ("", "office"):
            office_table(options.build, options.seeds, maps)
        if options.only in ("", "alike"):
            alike_table(options.build, options.seeds, maps)
        if options.only in ("", "intel"):
            intel_table(options.build, options.shared / "data", options.pieces, maps)
        if options.only in ("", "hall"):
            hall_table(options.build, options.shared, maps)


if __name__ == "__main__":
    main()

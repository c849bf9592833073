#!/usr/bin/env python3
"""The benchmark of localisation and mapping as Markdown tables on stdout.

    slam_table.py --build build [--shared FOLDER] [--seeds 1,2,3] [--only NAME] [--jitter 1,2]

Drives through the worlds of the tree, with the simulator's truth, always; with the project's shared data at hand (ALE_SHARED) also
its development runs, and the recordings, scored by its own scripts. Beside each figure stands the best that another system reached
on the same kind of run, as its README tells: other seeds of the same worlds, defaults or launch-file settings.

With --jitter each building is replayed once more with each of these seeds of noise on its ranges (faults/spoil.py): what of a result is
luck.
"""
import argparse
import gzip
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

from lines_table import progress, table

ROOT = pathlib.Path(__file__).resolve().parents[3]
WORLDS = ("home", "apartment", "arena", "office")
# ATE of the best other system, mm: with odometry and without.
PEERS_MM = {"apartment": ("16, hector 2.5 cm", "14"), "maze": ("32, hector 5 cm", "38"), "apartment-fast": ("33, Karto", "-"),
            "maze-bent": ("-", "-"), "maze-real": ("34, hector 5 cm", "-"), "apartment-rover": ("40, Karto", "77, iris_lama")}
RECORDINGS = ("exp1", "exp3")
PEERS_CRISP = {"exp1": "-3.35 (PLICP), 1.9 (gmapping), 0.055 (gmapping)", "exp3": "-"}
RELATIONS = {"intel/intel_every5th.clf.gz": ("intel/intel_every5th.relidx", "0.019, iris_lama"),
             "killian/killian.g2o.gz": ("killian/killian.relidx", "0.038, the file's own poses")}
# Against poses that gmapping found, which err by themselves.
POSES = ("corrected/aces", "corrected/acapulco", "corrected/belgioioso", "corrected/freiburg-101", "killian/infinite-corridor")


# Odometry that a log lacks errs by so much of each step (along, across), and turns by so much a metre: normal, one sigma.
MADE_SHARE = (0.03, 0.01)
MADE_RAD_A_METRE = 0.03


def read_tum(path):
    """Times, places as complex numbers, headings."""
    rows = np.loadtxt(path, ndmin=2)
    return rows[:, 0], rows[:, 1] + 1j * rows[:, 2], 2 * np.arctan2(rows[:, 6], rows[:, 7])


def wrapped(angles):
    return (angles + math.pi) % (2 * math.pi) - math.pi


def at_times(times, truth):
    """The true places and headings then, interpolated."""
    known, places, headings = truth
    return np.interp(times, known, places.real) + 1j * np.interp(times, known, places.imag), \
        np.interp(times, known, np.unwrap(headings))


def best_alignment(places, true_places):
    """The rigid motion that lays places (complex) best onto the true ones: where the origin comes to lie, and the turn."""
    middle, true_middle = places.mean(), true_places.mean()
    turn = np.angle(np.sum((true_places - true_middle) * (places - middle).conj()))
    return true_middle - middle * np.exp(1j * turn), turn


def aligned_errors(places, true_places):
    """How far each place (complex) is off after the best rigid alignment."""
    origin, turn = best_alignment(places, true_places)
    return np.abs(origin + places * np.exp(1j * turn) - true_places)


def trajectory_error(path, truth_path):
    """ATE after the best rigid alignment, mm, and relative error over one second, mm and degrees: root mean squares."""
    times, places, headings = read_tum(path)
    true_places, true_headings = at_times(times, read_tum(truth_path))
    ate = np.sqrt(np.mean(aligned_errors(places, true_places) ** 2))
    after = np.searchsorted(times, times + 1 - 1e-6)
    first = np.flatnonzero(after < len(times))
    last = after[first]
    way = (places[last] - places[first]) * np.exp(-1j * headings[first])
    true_way = (true_places[last] - true_places[first]) * np.exp(-1j * true_headings[first])
    turned = wrapped(headings[last] - headings[first] - true_headings[last] + true_headings[first])
    return 1e3 * ate, 1e3 * np.sqrt(np.mean(np.abs(way - true_way) ** 2)), np.degrees(np.sqrt(np.mean(turned ** 2)))


def normalised_error(path, truth_path):
    """Mean normalised squared error of the map poses as they were told live, by the covariance told with each: 3 is honest. The
    first pose has no error: there the map begins."""
    rows = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
    times = np.array([row["t"] for row in rows])
    poses = np.array([[row["map_x"], row["map_y"], row["map_theta"]] for row in rows])
    covariances = np.array([row["cov"] for row in rows]).reshape(-1, 3, 3)
    true_places, true_headings = at_times(times, read_tum(truth_path))
    places = poses[:, 0] + 1j * poses[:, 1]
    turn = poses[0, 2] - true_headings[0]
    off = places - places[0] - (true_places - true_places[0]) * np.exp(1j * turn)
    errors = np.stack([off.real, off.imag, wrapped(poses[:, 2] - true_headings - turn)], axis=1)[1:]
    return np.mean(np.einsum("ni,nij,nj->n", errors, np.linalg.inv(covariances[1:]), errors))


class Bench:
    """The programs under test and a folder for what they write."""

    def __init__(self, build, folder):
        self.build = pathlib.Path(build)
        self.folder = pathlib.Path(folder)
        self.poses = self.folder / "poses.jsonl"
        self.correction_ms = 0.0  # the longest of all

    def replay(self, log, *words):
        """Live and final trajectory, and the processor time of a scan: mean, longest, ms. What is told with the poses is in self.poses."""
        live, final = self.folder / "live.tum", self.folder / "final.tum"
        done = subprocess.run([self.build / "bin/ale-replay", log, "--trajectory-live", live, "--trajectory", final,
                               "--poses", self.poses, *words], check=True, stderr=subprocess.STDOUT, stdout=subprocess.PIPE, text=True)
        mean, longest = re.search(r"([0-9.]+) ms a scan \(worst ([0-9.]+)\)", done.stdout).groups()
        correction = re.search(r"longest correction ([0-9.]+) ms", done.stdout)
        self.correction_ms = max(self.correction_ms, float(correction.group(1)) if correction else 0.0)
        return live, final, f"{float(mean):.2f}, {float(longest):.2f}"

    def states(self):
        """Of every scan of the last replay; 0: lost."""
        return [json.loads(line)["state"] for line in self.poses.read_text(encoding="utf-8").splitlines()]

    def drive(self, world, seed):
        """A simulated drive through a world of the tree, or a file, as a log, and its truth."""
        plan = ROOT / f"tools/lab/worlds/{world}.world" if world in WORLDS else world
        log, truth = self.folder / "drive.log", self.folder / "truth.tum"
        subprocess.run([self.build / "bin/ale-sim", "--world", plan, "--seed", seed,
                        "--write-log", log, "--truth", truth], check=True, stdout=subprocess.DEVNULL)
        return log, truth


def titled_table(title, head, rows):
    progress("")
    if rows:
        print(f"{title}\n")
        table(head, rows)


def worlds_table(bench, seeds, chosen):
    rows = []
    for world in filter(chosen, WORLDS):
        cells = []
        honest = []
        for odometry in ("on", "off"):
            errors = []
            normalised = []
            for seed in seeds.split(","):
                progress(f"{world}, seed {seed}, odometry {odometry} ...")
                log, truth = bench.drive(world, seed)
                live, final, _ = bench.replay(log, "--odometry", odometry)
                errors.append([trajectory_error(path, truth)[0] for path in (final, live)])
                normalised.append(normalised_error(bench.poses, truth))
            mean = np.mean(errors, axis=0)
            cells.append(f"{mean[0]:.1f} / {mean[1]:.1f} ({max(final for final, _ in errors):.1f})")
            honest.append(f"{np.mean(normalised):.1f}")
        rows.append([world, *cells, ", ".join(honest)])
    titled_table(f"Worlds of the tree, with the sensor's own noise and bent scans; ATE in mm, final / live, mean of seeds {seeds} (worst final); "
                 "mean normalised squared error of the live poses with odometry, without:",
                 ["world", "with odometry", "without", "normalised"], rows)


def runs_table(bench, runs, chosen):
    rows = []
    for name, peers in PEERS_MM.items():
        if not chosen(name) or not (runs / name).is_dir():
            continue
        row = [name]
        honest = []
        for odometry, peer in zip(("on", "off"), peers):
            progress(f"{name}, odometry {odometry} ...")
            live, final, time_ms = bench.replay(runs / name / "scans.log.gz", "--odometry", odometry)
            ate, way, turn = trajectory_error(final, runs / name / "truth.tum")
            row += [f"{ate:.1f} / {trajectory_error(live, runs / name / 'truth.tum')[0]:.1f}", peer]
            honest.append(f"{normalised_error(bench.poses, runs / name / 'truth.tum'):.1f}")
            if odometry == "on":
                relative, time_on = f"{way:.1f} mm, {turn:.2f}°", time_ms
        rows.append([*row, relative, ", ".join(honest), time_on])
    titled_table("Development runs; ATE in mm, final / live, beside the best other system; relative error over 1 s, final, with odometry; "
                 "mean normalised squared error of the live poses with odometry, without:",
                 ["run", "with odometry", "best other", "without", "best other", "over 1 s", "normalised", "ms a scan: mean, longest"], rows)


def score(script, *words):
    """What one of the scorers prints: a number by name."""
    done = subprocess.run([sys.executable, script, *map(str, words)], check=True, stdout=subprocess.PIPE, text=True)
    if done.stdout.lstrip().startswith("{"):
        return json.loads(done.stdout)
    return {name: float(number) for name, number in re.findall(r"(\w+)\s+(-?[0-9.]+(?:e-?\d+)?|nan)", done.stdout)}


def robot_lasers(path):
    """Of each ROBOTLASER1 line: ranges as words, corrected pose as x, y, heading, stamp."""
    with gzip.open(path, "rt", encoding="ascii") as lines:
        for words in (line.split() for line in lines if line.startswith("ROBOTLASER1 ")):
            beams = int(words[8])
            after = 10 + beams + int(words[9 + beams])
            yield words[9:9 + beams], np.array(words[after:after + 3], float), words[after + 11]


def with_made_odometry(path, carmen):
    """A file of scans whose poses are corrected ones, as a CARMEN log: its odometry are the motions between them, and errors."""
    random = np.random.default_rng(1)
    place, heading, before = 0j, 0.0, None
    with open(carmen, "w", encoding="ascii") as log:
        for ranges, (x, y, theta), stamp in robot_lasers(path):
            if before is not None:
                step = (complex(x, y) - before[0]) * np.exp(-1j * before[1])
                along, across, turned = random.standard_normal(3)
                step *= 1 + MADE_SHARE[0] * along + 1j * MADE_SHARE[1] * across
                place += step * np.exp(1j * heading)
                heading += wrapped(theta - before[1]) + MADE_RAD_A_METRE * abs(step) * turned
            before = complex(x, y), theta
            pose = f"{place.real:.6f} {place.imag:.6f} {heading:.6f}"
            log.write(f"FLASER {len(ranges)} {' '.join(ranges)} {pose} {pose} {stamp} - {stamp}\n")


def as_carmen(bench, log):
    """A log that ale-replay reads: of corrected poses alone one is made."""
    if not pathlib.Path(log).name.endswith(".g2o.gz"):
        return log
    carmen = bench.folder / "made.clf"
    with_made_odometry(log, carmen)
    return carmen


def recordings_table(bench, scorers, recordings, chosen):
    rows = []
    for name in filter(chosen, RECORDINGS):
        log = recordings / f"{name}.dat"
        if not log.exists():
            continue
        carmen = bench.folder / f"{name}.clf"
        subprocess.run([sys.executable, scorers / "exp2carmen.py", log, carmen, "0.155"], check=True, stdout=subprocess.DEVNULL)
        for odometry in ("on", "off"):
            progress(f"{name}, odometry {odometry} ...")
            _, final, _ = bench.replay(log, "--odometry", odometry, "--frame", "laser")
            entropy, angle, loop = (score(scorers / f"{script}.py", carmen, final).get(measure, math.nan)
                                    for script, measure in (("crisp", "mme"), ("rightangle", "rms_deg"), ("revisit", "m_median")))
            seen_again = "-" if math.isnan(loop) else f"{loop:.3f}"
            rows.append([f"{name}, odometry {odometry}", f"{entropy:.3f}", f"{angle:.2f}", seen_again, PEERS_CRISP[name]])
    titled_table("Rover recordings, no truth: entropy of the map, wall angle in degrees (root mean square), loop in m (median):",
                 ["recording", "entropy", "wall angle", "loop", "best others, each in one"], rows)


def spoilt(bench, log, kind, seed):
    """The log with a fault of this kind (faults/spoil.py)."""
    changed = bench.folder / "spoilt.clf"
    subprocess.run([sys.executable, pathlib.Path(__file__).with_name("faults") / "spoil.py", log, kind, seed, changed], check=True)
    return changed


def with_more_noise(bench, log, seeds):
    """The log as it is, and with the noise of each seed on its ranges; each with what to add to its name."""
    yield "", log
    for seed in seeds:
        progress(f"  jitter {seed} ...")
        yield f", jitter {seed}", spoilt(bench, log, "jitter", seed)


def buildings_table(bench, scorers, data, chosen, seeds):
    rows = []

    def replay(log, name, measure, peer):
        progress(f"{name} ...")
        for noise, replayed in with_more_noise(bench, log, seeds):
            _, final, time_ms = bench.replay(replayed, "--frame", "laser")
            rows.append([f"{name}{noise}", measure(final), peer, str(bench.states().count(0)), time_ms])

    for log, (relations, peer) in RELATIONS.items():
        if chosen(pathlib.Path(log).name.split(".")[0]) and (data / log).exists():
            replay(as_carmen(bench, data / log), pathlib.Path(log).name,
                   lambda final, true=data / relations: f"{score(scorers / 'score.py', final, true)['trans_mean']:.4f} (relations)", peer)
    for name in POSES:
        if chosen(pathlib.Path(name).name) and (data / f"{name}.clf.gz").exists():
            replay(data / f"{name}.clf.gz", f"{pathlib.Path(name).name}.clf.gz",
                   lambda final, true=data / f"{name}.ref": f"{score(scorers / 'score.py', final, true)['ate_rmse']:.3f} (gmapping's poses)", "-")
    titled_table("Buildings: mean translation error of known relations, or ATE against gmapping's poses, m:",
                 ["recording", "error", "best other", "scans lost", "ms a scan: mean, longest"], rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build")
    parser.add_argument("--shared", default=os.environ.get("ALE_SHARED", ""))
    parser.add_argument("--seeds", default="1,2,3", help="of the drives through the worlds of the tree")
    parser.add_argument("--only", default="", metavar="NAME", help="the rows of this world, run or recording alone")
    parser.add_argument("--jitter", default="", metavar="SEEDS", help="buildings also with noise of these seeds on the ranges")
    options = parser.parse_args()
    for seeds in filter(None, (options.seeds, options.jitter)):
        if not re.fullmatch(r"\d+(,\d+)*", seeds):
            parser.error(f"{seeds}: not numbers with commas between them")
    if not (pathlib.Path(options.build) / "bin/ale-replay").exists():
        sys.exit(f"slam_table.py: no programs in {options.build}/bin (make builds them)")
    jitter = list(filter(None, options.jitter.split(",")))

    def chosen(name):
        return options.only in ("", name)

    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(options.build, folder)
        worlds_table(bench, options.seeds, chosen)
        scorers = pathlib.Path(options.shared or "/nonexistent") / "bench" / "slam"
        if scorers.is_dir():
            data = pathlib.Path(options.shared) / "data"
            runs_table(bench, scorers, chosen)
            recordings_table(bench, scorers, data / "urg04lx", chosen)
            buildings_table(bench, scorers, data, chosen, jitter)
        else:
            print("No development runs and recordings here: ALE_SHARED names no folder with bench/slam.\n")
        print(f"Longest correction of the mapper: {bench.correction_ms:.0f} ms.")


if __name__ == "__main__":
    main()

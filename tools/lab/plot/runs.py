"""One run as arrays: where its trajectory, poses and stage times come from."""
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np

from .counters import read as read_counters

STAGES = ("deskew", "smooth", "extract", "match", "map")
FILES_OF_FOLDER = ("trajectory.tum", "poses.jsonl", "timing.csv")
LOST, WEAK = 0, 1


class Trouble(Exception):
    """What to tell the user, in one line."""


class Run:
    """trajectory: rows t, x, y, theta. poses: columns by name, or None. timing: milliseconds by stage and "total", or None.
    counted: counters.Counted, of logs of LCM, or None."""

    def __init__(self, name):
        self.name = name
        self.trajectory = None
        self.poses = None
        self.timing = None
        self.counted = None

    @property
    def live(self):
        """The trajectory as it was known at each moment, to which the stated covariance belongs; None: not known."""
        return None if self.poses is None else np.column_stack([self.poses[key] for key in ("t", "map_x", "map_y", "map_theta")])

    @property
    def start(self):
        if self.trajectory is not None:
            return self.trajectory[0, 0]
        return self.poses["t"][0] if self.poses else self.counted.t[0] if self.counted else 0.0


def load(words):
    """NAME=FILES or FILES: a folder, files with commas between them (.tum, .jsonl, .csv), or a log."""
    name, given, files = words.partition("=")
    if not given or os.sep in name:
        name, files = "", words
    paths = [pathlib.Path(file) for file in files.split(",")]
    run = Run(name or paths[0].stem or str(paths[0]))
    for path in paths:
        if not path.exists():
            raise Trouble(f"{path}: No such file or directory")
        if path.is_dir():
            _load_folder(run, path)
        else:
            _load_file(run, path)
    if run.trajectory is None:
        run.trajectory = run.live
    return run


def _load_folder(run, folder):
    found = [folder / name for name in FILES_OF_FOLDER if (folder / name).exists()]
    if not found:
        raise Trouble(f"{folder}: holds none of {', '.join(FILES_OF_FOLDER)}")
    for path in found:
        _load_file(run, path)


def _load_file(run, path):
    readers = {".tum": _read_trajectory, ".jsonl": _read_poses, ".csv": _read_timing}
    reader = readers.get(path.suffix)
    if reader is None:
        _replay(run, path)
        return
    try:
        reader(run, path)
    except (ValueError, KeyError, IndexError, TypeError, UnicodeDecodeError) as error:
        raise Trouble(f"{path}: not what its ending says: {error}") from error


def read_tum(path):
    """Rows t, x, y, theta."""
    rows = np.loadtxt(path, ndmin=2)
    if rows.shape[0] == 0 or rows.shape[1] != 8:
        raise ValueError("rows of eight numbers are needed (t x y z qx qy qz qw)")
    return np.column_stack([rows[:, :3], 2 * np.arctan2(rows[:, 6], rows[:, 7])])


def _read_trajectory(run, path):
    run.trajectory = read_tum(path)


def _read_poses(run, path):
    with path.open(encoding="utf-8") as lines:
        rows = [json.loads(line) for line in lines]
    if not rows:
        raise ValueError("no line")
    keys = ("t", "map_x", "map_y", "map_theta", "cov", "state", "predicted", "lag_us", "maps", "wheel_fault")
    run.poses = {key: np.array([row[key] for row in rows]) for key in keys}


def _read_timing(run, path):
    with path.open(encoding="utf-8", newline="") as lines:
        rows = list(csv.DictReader(lines))
    if not rows:
        raise ValueError("no line")
    run.timing = {stage: np.array([float(row[f"{stage}_ns"]) for row in rows]) * 1e-6 for stage in (*STAGES, "total")}


def _replay(run, log):
    """A log goes through ale-replay, beside this program or in the PATH. One without scans may have counters all the same."""
    run.counted = read_counters(log)
    beside = pathlib.Path(sys.argv[0]).resolve().parent / "ale-replay"
    replay = str(beside) if beside.exists() else shutil.which("ale-replay")
    if replay is None:
        raise Trouble(f"{log}: a log needs ale-replay, which is neither beside this program nor in the PATH")
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder)
        done = subprocess.run([replay, str(log), "--trajectory", str(place / FILES_OF_FOLDER[0]), "--poses",
                               str(place / FILES_OF_FOLDER[1]), "--timing", str(place / FILES_OF_FOLDER[2])],
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
        if done.returncode != 0 and run.counted:
            print(f"ale-plot: {log}: counters only: {done.stderr.strip()}", file=sys.stderr)
            return
        if done.returncode != 0:
            raise Trouble(done.stderr.strip().splitlines()[-1] if done.stderr.strip() else f"{log}: ale-replay failed")
        _load_folder(run, place)

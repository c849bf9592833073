"""What ale-replay said of a drive, scan by scan, and what of it was wrong.

    figures = judged(replayed("build", "spoilt.log", places, headings, "on"), after)
"""
import dataclasses
import json
import pathlib
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from slam_table import Bench, aligned_errors, read_tum, wrapped  # noqa: E402

GOOD = 2
FAR_M, FAR_RAD = 0.3, np.radians(10)
SIGMAS = 5
GOOD_WITHIN_M = 0.15
KNOWN_M, KNOWN_RAD = 1.0, np.radians(90)  # so near to a pose of before a place is known
LAST_SCANS = 5  # of a drive that ends far off none is nearer


@dataclasses.dataclass
class Told:
    """What ale-replay said of a drive, beside its truth: places are complex."""
    final: np.ndarray
    live: np.ndarray
    headings: np.ndarray
    rows: list
    true_places: np.ndarray
    true_headings: np.ndarray
    times: np.ndarray

    def __post_init__(self):
        turned = self.headings - self.headings[0] - (self.true_headings - self.true_headings[0])
        self.turn = np.abs(wrapped(turned))
        seen = (self.live - self.live[0]) * np.exp(-1j * self.headings[0])
        true = (self.true_places - self.true_places[0]) * np.exp(-1j * self.true_headings[0])
        self.off_m = np.abs(seen - true)
        self.state = np.array([row["state"] for row in self.rows])
        self.good = (self.state == GOOD) & ~np.array([row["predicted"] for row in self.rows])
        self.map_id = np.array([row.get("map_id", 0) for row in self.rows])

    def ate_m(self, live=False):
        """Of the final trajectory, or of the live one."""
        return float(np.sqrt(np.mean(np.square(aligned_errors(self.live if live else self.final, self.true_places)))))

    def denied(self):
        """Whether the covariance told denies the error."""
        covariance = np.array([row["cov"] for row in self.rows])
        place = np.sqrt(np.maximum(covariance[:, 0] + covariance[:, 4], 1e-8))
        heading = np.sqrt(np.maximum(covariance[:, 8], 1e-8))
        return (self.off_m >= SIGMAS * place) | (self.turn >= SIGMAS * heading)

    def joined_s(self, after):
        """From the first sight of a place known before scan `after` until a good and right pose: none where no such place is seen, endless
        where no such pose comes."""
        known = next((k for k in range(after, len(self.times)) if self.is_known(k, after)), None)
        right = np.flatnonzero(self.good[after:] & (self.off_m[after:] < GOOD_WITHIN_M) & (self.turn[after:] < FAR_RAD))
        if known is None:
            return None
        return max(0.0, self.times[after + right[0]] - self.times[known]) if len(right) else np.inf

    def is_known(self, k, before):
        near = np.abs(self.true_places[:before] - self.true_places[k]) < KNOWN_M
        return bool(np.any(near & (np.abs(wrapped(self.true_headings[:before] - self.true_headings[k])) < KNOWN_RAD)))


def judged(told, after):
    """The figures of one run."""
    far = (told.off_m > FAR_M) | (told.turn > FAR_RAD)
    wrong = far & told.good
    return {"ate": told.ate_m(), "wrong": int(wrong.sum()), "silent": int((wrong & told.denied()).sum()), "lost": int((told.state == 0).sum()),
            "end": bool(told.off_m[-LAST_SCANS:].min() > FAR_M or told.state[-1] == 0),
            "good_off": int((told.good & (told.off_m > GOOD_WITHIN_M)).sum()), "joined_s": told.joined_s(after),
            "other_map": int((told.map_id != told.map_id[0]).sum()), "ends_in_other": bool(told.map_id[-1] != told.map_id[0])}


def replayed(build, log, places, headings, odometry, *words):
    """A log beside its truth, one pose a scan; words: what else ale-replay is told."""
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(build, folder)
        live, final, _ = bench.replay(log, "--odometry", odometry, *words)
        times, live_places, live_headings = read_tum(live)
        rows = [json.loads(row) for row in bench.poses.read_text(encoding="utf-8").splitlines()]
        if len(rows) != len(places):
            raise ValueError(f"{len(rows)} poses of {len(places)} scans")
        return Told(read_tum(final)[1], live_places, live_headings, rows, places, headings, times)

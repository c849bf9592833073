"""A CARMEN log whose odometry, ranges and scans can be changed: what is not touched goes out as it was read.

    log = CarmenLog("drive.log.gz"); log.go(log.steps() * (0.85, 1, 1.25)); log.write("spoilt.log")
"""
import bz2
import gzip
import math
import pathlib

import numpy as np

LASER_LINES = ("FLASER", "ROBOTLASER1")
NO_ECHO_FROM_M = 60  # scanners of FLASER lines say 81.91, 81.83 and such


def open_text(path):
    """A log, plain or packed, told by its name."""
    opened = {".gz": gzip.open, ".bz2": bz2.open}.get(pathlib.Path(path).suffix, open)
    return opened(path, "rt", encoding="ascii", errors="replace")


def wrapped(angles):
    """By arithmetic alone: numpy's sine of the same number differs in its last bit with where the number lies in memory."""
    return angles - 2 * math.pi * np.round(angles / (2 * math.pi))


def seen_from(base, poses):
    """Poses (x, y, heading) in the frame of another."""
    ahead, left = poses[:, 0] - base[0], poses[:, 1] - base[1]
    c, s = math.cos(base[2]), math.sin(base[2])
    return np.c_[c * ahead + s * left, c * left - s * ahead, wrapped(poses[:, 2] - base[2])]


class CarmenLog:
    """Scans in the order of their lines: words, stamps, odometry (x, y, heading)."""

    def __init__(self, path):
        self.comments, self.scans = [], []
        with open_text(path) as lines:
            for line in lines:
                if line.startswith(LASER_LINES):
                    self.scans.append(line.split())
                elif line.startswith("#"):
                    self.comments.append(line)
        if not self.scans:
            raise SystemExit(f"{path}: no laser line of a CARMEN log")
        words = self.scans[0]
        self.is_robot_laser = words[0] == "ROBOTLASER1"
        self.first = 9 if self.is_robot_laser else 2  # the word of the first range
        self.beams = int(words[self.first - 1])
        end = self.first + self.beams
        self.pose = end + 1 + int(words[end]) if self.is_robot_laser else end  # pose of the laser, then that of the robot
        self.nothing = "0" if self.is_robot_laser else "81.91"
        stamp = self.pose + (11 if self.is_robot_laser else 6)
        self.stamps = np.array([float(scan[stamp]) for scan in self.scans])
        self.stamp_word = stamp
        self.odometry = np.array([scan[self.pose + 3:self.pose + 6] for scan in self.scans], float)

    def bearings(self):
        """Of the beams, from right to left; without a stated field of view it is half a turn."""
        if not self.is_robot_laser:
            return np.linspace(-math.pi / 2, math.pi / 2, self.beams)
        start, resolution = float(self.scans[0][2]), float(self.scans[0][4])
        return start + resolution * np.arange(self.beams)

    def ranges(self, k):
        """Of scan k, m; what is no echo is not a number."""
        values = np.array(self.scans[k][self.first:self.first + self.beams], float)
        return np.where((values > 0.02) & (values < NO_ECHO_FROM_M), values, np.nan)

    def set_ranges(self, k, ranges):
        """Words are made of those alone that are others now."""
        words = list(self.scans[k])
        for beam in np.flatnonzero((ranges != self.ranges(k)) & ~(np.isnan(ranges) & np.isnan(self.ranges(k)))):
            words[self.first + beam] = self.nothing if math.isnan(ranges[beam]) else f"{ranges[beam]:.3f}"
        self.scans[k] = words

    def steps(self):
        """Motions between scans as the wheels tell them, seen from the earlier: ahead, aside, turn."""
        x, y, heading = self.odometry.T
        c, s = (np.array([function(angle) for angle in heading[:-1]]) for function in (math.cos, math.sin))
        return np.c_[c * np.diff(x) + s * np.diff(y), c * np.diff(y) - s * np.diff(x), wrapped(np.diff(heading))]

    def go(self, steps):
        """The odometry becomes the chain of these motions."""
        poses = [tuple(self.odometry[0])]
        for ahead, aside, turn in steps:
            x, y, heading = poses[-1]
            c, s = math.cos(heading), math.sin(heading)
            poses.append((x + ahead * c - aside * s, y + ahead * s + aside * c, heading + turn))
        self.odometry = np.array(poses)
        self.odometry[:, 2] = wrapped(self.odometry[:, 2])

    def keep(self, index):
        """These scans alone, in this order."""
        self.scans = [self.scans[k] for k in index]
        self.stamps, self.odometry = self.stamps[index], self.odometry[index]

    def then(self, other, pause_s):
        """Another drive of the same scanner follows."""
        self.stamps = np.r_[self.stamps, other.stamps - other.stamps[0] + self.stamps[-1] + pause_s]
        self.scans += other.scans
        self.odometry = np.r_[self.odometry, other.odometry]

    def write(self, path):
        stamp = self.stamp_word
        with open(path, "w", encoding="ascii") as file:
            file.writelines(self.comments)
            for scan, (x, y, heading), time in zip(self.scans, self.odometry, self.stamps):
                words = list(scan)
                pose = [f"{x:.6f}", f"{y:.6f}", f"{heading:.6f}"]
                words[self.pose:self.pose + 6] = pose + pose
                if float(words[stamp]) != time:
                    words[stamp] = words[stamp + 2] = f"{time:.6f}"
                file.write(" ".join(words) + "\n")

#!/usr/bin/env python3
"""Puts a fault into a recorded or simulated drive: something goes wrong with wheels, scans or place, or the drive is told otherwise.

    spoil.py LOG KIND SEED OUT.log [--truth T.tum --truth-out U.tum]

LOG is a CARMEN log. What lasts a time does so when the seed says, while the robot moves, and as long. Kinds:

wheels     stall        no counts for 1 to 2 s, then all of them at once
           swallow      no counts for 1 to 2 s, what was driven meanwhile is never told
           jump         one step that is wrong by 0.3 to 1.5 m and 20 to 120 degrees
           reset        poses begin at 0 again
           sign         for 3 s ahead is told as back
           slip         for 2 s one wheel counts three times its way
           late         all poses are 0.4 s old
           track        all turns are told 25 % too large, all ways 15 % too short
           noise        every step is off by 30 % and 0.03 rad
           often        stall, swallow, jump, sign and slip in turn, one every minute, while the robot moves
wheels lie frozen       x, y and theta are 0 for the whole drive
           mirrored     y and theta have the wrong sign
           degrees      theta is told in degrees
           millimetres  x and y are told in millimetres
           stale        all poses are 100 s old (drives of 2 minutes and more)
scans      blind        1 to 2 s without an echo
           gap          1 to 2 s without scans
           dark         gap, and the wheels count nothing meanwhile
           half         for 4 s something hangs before the left half of the scanner, 0.3 m away
outages    gap-S        S = 4, 6, 8, 10, 12 s without scans, wheels go on
           dark-S       the same, and the wheels count nothing meanwhile
robot      carried      10 to 40 s are cut out, wheels know nothing of it
told       mirror       left and right exchanged         backward   from its end
otherwise  every-other  every other beam without an echo  near      no echo beyond 8 m
           jitter       4 mm of noise more on every range: as if driven on another day
           crop         120 degrees ahead                rough      10 mm and 1 % of noise on every range
           sparse       every third scan                 tail       begins after a third of the drive
           by-way       a scan after every metre or half a radian that the wheels tell, as in logs of key scans
           queued       scans are stamped when a queue lets them go, up to 1 s late and partly in the wrong order
"""
import argparse
import dataclasses
import itertools
import math
import random

import numpy as np

from carmen import CarmenLog, seen_from, wrapped

PASSING = ("stall", "swallow", "jump", "reset", "sign", "slip", "late", "track", "noise", "often")
LYING = ("frozen", "mirrored", "degrees", "millimetres", "stale")
SCANS = ("blind", "gap", "dark", "half")
OUTAGES = tuple(f"{kind}-{seconds}" for kind in ("gap", "dark") for seconds in (4, 6, 8, 10, 12))
TOLD_OTHERWISE = ("mirror", "backward", "every-other", "near", "crop", "rough", "jitter", "sparse", "by-way", "tail", "queued")
WHEELS = PASSING + LYING
KINDS = PASSING + SCANS + ("carried",) + LYING + OUTAGES + TOLD_OTHERWISE

LASTS_S = {"sign": (3, 3), "slip": (2, 2), "half": (4, 4), "carried": (10, 40)}  # else 1 to 2 s
MOVES = 0.08  # m and rad a second, at least, while it happens
TRACK_M = 0.33  # between the wheels, where one slips
SLIPS = 2  # times its way that a slipping wheel counts too much
LATE_S, STALE_S = 0.4, 100
STALE_NEEDS_S = 120  # a shorter drive is as if frozen
HANGS_M, HANGS_SIGMA_M = 0.3, 0.004
OFTEN = ("stall", "swallow", "jump", "sign", "slip")
OFTEN_S = (30, 90)  # from one to the next
NEAR_M = 8
BY_WAY_M, BY_WAY_RAD = 1, 0.5
CROP_RAD = math.radians(60)
HELD_UP_S, OUT_OF_ORDER, LATER_S = 1, 0.1, 0.5  # the longest time in a queue; the share of scans that come later still, and how much
NOISE = {"rough": (0.01, 0.01), "jitter": (0.004, 0)}  # m, and share of the range


@dataclasses.dataclass
class Spoilt:
    """What is left of a drive: the numbers of its scans as they were, and the first of those left that comes after the fault."""
    index: np.ndarray
    after: int = 0
    mirrored: bool = False

    def told(self, places, headings):
        """True places (complex) and headings of all scans, as this drive has them."""
        places, headings = places[self.index], headings[self.index]
        return (places.conj(), -headings) if self.mirrored else (places, headings)


def scans_in(times, begin_s, long_s):
    """First scan of a time, and the first one after it, two later at least."""
    first, last = np.searchsorted(times, [begin_s, begin_s + long_s])
    return int(first), max(int(last), int(first) + 2)


def window(log, chance, least_s, most_s):
    """Scans of a time in which the robot moves, not in the first 5 s nor near the end."""
    times = log.stamps - log.stamps[0]
    moved = np.abs(log.steps()).sum(axis=1)
    for _ in range(200):
        long_s = chance.uniform(least_s, most_s)
        begin_s = chance.uniform(5, max(6, times[-1] - long_s - 5))
        first, last = scans_in(times, begin_s, long_s)
        if last < len(times) and moved[first:last].sum() > MOVES * long_s:
            break
    return first, last


def older(log, seconds):
    """The odometry of so long ago; before the drive the robot stood."""
    x, y, heading = log.odometry.T
    x, y, heading = (np.interp(log.stamps - seconds, log.stamps, row) for row in (x, y, np.unwrap(heading)))
    return np.c_[x, y, wrapped(heading)]


def stalled(log, first, last):
    poses = log.odometry.copy()
    poses[first:last] = poses[first - 1]
    return poses


def one_step(steps, first, chance):
    way_m, bearing = chance.uniform(0.3, 1.5), chance.uniform(-3.1, 3.1)
    turn = chance.choice((-1, 1)) * chance.uniform(0.35, 2.1)
    steps[first] += (way_m * math.cos(bearing), way_m * math.sin(bearing), turn)


def one_wheel_slips(steps, first, last, chance):
    side = chance.choice((-1, 1))
    way = steps[first:last, 0] + side * steps[first:last, 2] * TRACK_M / 2
    steps[first:last, 0] += way * SLIPS / 2
    steps[first:last, 2] += side * way * SLIPS / TRACK_M


def noisy(steps, chance):
    steps[:, 0] *= 1 + np.array([chance.gauss(0, 0.3) for _ in steps])
    steps[:, 2] += [chance.gauss(0, 0.03) for _ in steps]


def spoil_steps(log, kind, chance, first, last):
    """Wheels that count wrongly: their motions, chained anew."""
    steps = log.steps()
    if kind in ("swallow", "dark"):
        steps[first:last] = 0
    elif kind == "carried":
        steps[first - 1:last] = 0
    elif kind == "jump":
        one_step(steps, first, chance)
    elif kind == "sign":
        steps[first:last, 0] *= -1
    elif kind == "slip":
        one_wheel_slips(steps, first, last, chance)
    elif kind == "track":
        steps *= (0.85, 1, 1.25)
    elif kind == "noise":
        noisy(steps, chance)
    log.go(steps)


def spoil_poses(log, kind, first, last):
    """Wheels that say their poses wrongly."""
    if kind == "stall":
        log.odometry = stalled(log, first, last)
    elif kind == "reset":
        log.odometry[first:] = seen_from(log.odometry[first], log.odometry[first:])
    elif kind in ("late", "stale"):
        log.odometry = older(log, LATE_S if kind == "late" else STALE_S)
    elif kind in LYING:
        log.odometry = log.odometry * {"frozen": (0, 0, 0), "mirrored": (1, -1, -1), "degrees": (1, 1, math.degrees(1)),
                                       "millimetres": (1e3, 1e3, 1)}[kind]


def often(log, chance):
    """One fault of the wheels after another: the first scan after the last of them."""
    times = log.stamps - log.stamps[0]
    moved = np.abs(log.steps()).sum(axis=1)
    kinds, begin_s, after = itertools.cycle(OFTEN), 5 + chance.uniform(0, OFTEN_S[0]), 0
    kind = next(kinds)
    while begin_s < times[-1] - 5:
        long_s = chance.uniform(*LASTS_S.get(kind, (1, 2)))
        first, last = scans_in(times, begin_s, long_s)
        if last < len(times) and moved[first:last].sum() > MOVES * long_s:
            spoil_wheels(log, kind, chance, first, last)
            kind, begin_s, after = next(kinds), begin_s + chance.uniform(*OFTEN_S), last
        else:
            begin_s += 1
    return after


def spoil_wheels(log, kind, chance, first, last):
    """What they tell of their way, or of where they are."""
    if kind in ("stall", "reset", "late") + LYING:
        spoil_poses(log, kind, first, last)
    else:
        spoil_steps(log, kind, chance, first, last)


def cover(log, kind, chance, first, last):
    """Blind: no echo at all. Half: something hangs before the left half."""
    for k in range(first, last):
        ranges = log.ranges(k)
        if kind == "blind":
            ranges[:] = np.nan
        else:
            ranges[log.beams // 2:] = [HANGS_M + chance.gauss(0, HANGS_SIGMA_M) for _ in range(log.beams // 2, log.beams)]
        log.set_ranges(k, ranges)


def tell_ranges(log, kind, chance):
    """Every scan with fewer or rougher ranges."""
    beams = np.arange(log.beams)
    bearings = log.bearings()
    for k in range(len(log.scans)):
        ranges = log.ranges(k)
        if kind == "every-other":
            ranges[beams % 2 == 1] = np.nan
        elif kind == "near":
            ranges[ranges > NEAR_M] = np.nan
        elif kind == "crop":
            ranges[np.abs(bearings) > CROP_RAD] = np.nan
        else:
            at_zero_m, share = NOISE[kind]
            ranges = np.abs(ranges + chance.normal(size=log.beams) * (at_zero_m + share * ranges))
        log.set_ranges(k, ranges)


def swept_back(log, kind):
    """A swept scan told so was swept the other way round: its beams' times, and the beam of the stamp."""
    def turned(line):
        words = line.split()
        for k, word in enumerate(words[:-1]):
            if word == "beam_time_us":
                words[k + 1] = f"{-float(words[k + 1])}"
            elif word == "stamp_beam" and kind == "mirror":
                words[k + 1] = f"{log.beams - 1 - int(words[k + 1])}"
        return " ".join(words) + "\n"
    log.comments = [turned(line) if "beam_time_us" in line else line for line in log.comments]


def mirror(log):
    for k in range(len(log.scans)):
        scan = log.scans[k]
        first, end = log.first, log.first + log.beams
        log.scans[k] = scan[:first] + scan[first:end][::-1] + scan[end:]
    log.odometry = log.odometry * (1, -1, -1)


def queued(times, chance):
    """When a queue lets scans go that were taken at these times: many at once."""
    stamps, lets_go = [], times[0]
    for taken in times:
        if taken > lets_go:
            lets_go = taken + chance.uniform(0, HELD_UP_S)
        later = chance.uniform(0, LATER_S) if chance.uniform() < OUT_OF_ORDER else 0
        stamps.append(lets_go + later)
    return np.array(stamps)


def by_way(odometry):
    """Numbers of the scans that a log of key scans would hold."""
    kept = [0]
    for k in range(1, len(odometry)):
        ahead, left, turn = seen_from(odometry[kept[-1]], odometry[k:k + 1])[0]
        if math.hypot(ahead, left) >= BY_WAY_M or abs(turn) >= BY_WAY_RAD:
            kept.append(k)
    return np.array(kept)


def tell_otherwise(log, kind, seed):
    """The same drive, told in another way."""
    index = np.arange(len(log.scans))
    if kind in ("mirror", "backward"):
        swept_back(log, kind)
    if kind == "mirror":
        mirror(log)
    elif kind == "backward":
        index = index[::-1]
        times = log.stamps[-1] - log.stamps[::-1] + log.stamps[0]
        log.keep(index)
        log.stamps = times
    elif kind == "queued":
        log.stamps = queued(log.stamps, np.random.default_rng(seed))
    elif kind == "by-way":
        index = by_way(log.odometry)
        log.keep(index)
    elif kind in ("sparse", "tail"):
        index = index[::3] if kind == "sparse" else index[len(index) // 3:]
        log.keep(index)
    else:
        tell_ranges(log, kind, np.random.default_rng(seed + 4))
    return Spoilt(index, mirrored=kind == "mirror")


def carry(log, first, last):
    """The robot is taken from before scan first to where scan last was taken; the wheels know nothing of it."""
    spoil_steps(log, "carried", None, first, last)
    index = np.r_[0:first, last:len(log.scans)]
    log.keep(index)
    return Spoilt(index, after=first)


def spoil(log, kind, seed):
    """Puts a fault of this kind into the log, and returns what is left of it."""
    if kind in TOLD_OTHERWISE:
        return tell_otherwise(log, kind, seed)
    chance = random.Random(f"{kind} {seed}")
    kind, _, seconds = kind.partition("-")
    lasts_s = (float(seconds), float(seconds)) if seconds else LASTS_S.get(kind, (1, 2))
    first, last = window(log, chance, *lasts_s)
    if kind == "carried":
        return carry(log, first, last)
    if kind == "often":
        return Spoilt(np.arange(len(log.scans)), after=often(log, chance))
    if kind in ("blind", "half"):
        cover(log, kind, chance, first, last)
    elif kind != "gap":
        spoil_wheels(log, kind, chance, first, last)
    if kind not in ("gap", "dark"):
        return Spoilt(np.arange(len(log.scans)), after=last)
    index = np.r_[0:first, last:len(log.scans)]
    log.keep(index)
    return Spoilt(index, after=first)


def fits(log, kind):
    """Whether a kind can be made of a log."""
    return kind != "stale" or log.stamps[-1] - log.stamps[0] > STALE_NEEDS_S


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("log")
    parser.add_argument("kind", choices=KINDS, metavar="KIND")
    parser.add_argument("seed", type=int)
    parser.add_argument("out")
    parser.add_argument("--truth", help="of the scans of LOG, TUM")
    parser.add_argument("--truth-out", help="of those of OUT")
    options = parser.parse_args()
    if bool(options.truth) != bool(options.truth_out):
        parser.error("--truth and --truth-out go together")
    log = CarmenLog(options.log)
    if not fits(log, options.kind):
        raise SystemExit(f"spoil.py: {options.log}: cannot be told as {options.kind}")
    spoilt = spoil(log, options.kind, options.seed)
    log.write(options.out)
    if options.truth:
        truth = np.loadtxt(options.truth, ndmin=2)
        places, headings = spoilt.told(truth[:, 1] + 1j * truth[:, 2], 2 * np.arctan2(truth[:, 6], truth[:, 7]))
        zero = np.zeros(len(places))
        np.savetxt(options.truth_out, np.c_[log.stamps, places.real, places.imag, zero, zero, zero, np.sin(headings / 2), np.cos(headings / 2)], "%.9f")


if __name__ == "__main__":
    main()

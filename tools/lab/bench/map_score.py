#!/usr/bin/env python3
"""How good is a map: walls that stand twice and, where the truth is known, what is false and what is missing.

    map_score.py MAP.dxf [PLAN TRUTH.tum]

MAP.dxf: of ale-replay --map. PLAN: walls as `x1 y1 x2 y2` a line, metres, such as a world file; TRUTH.tum: the robot's
poses in the plan, whose first is the origin of the map. Two lines are one wall twice when they face the same way within 15
degrees, less than 0.35 m apart, side by side for 0.3 m or more. Right: drawn length within 3 cm and 8 degrees of a wall.
Found: of what five beams or more could see within 4 m, that which lies within 6 cm of a line.
"""
import argparse
import math
import sys

import numpy as np

TWICE_M, TWICE_ALONG_M, TWICE_COS = 0.35, 0.30, math.cos(math.radians(15))
RIGHT_M, RIGHT_COS, FOUND_M = 0.03, math.cos(math.radians(8)), 0.06
APART_COLOUR = "6"  # tools/common/export/map_dxf.cpp
STEP_M, SIGHT_M, BEAMS_LEAST, POSE_EVERY = 0.05, 4.0, 5, 5


def read_pieces(path):
    """Lines of the layer WALLS, one a row: x1 y1 x2 y2; and which of them are in maps that are not joined with the first."""
    with open(path, encoding="ascii", errors="replace") as file:
        words = [word.strip() for word in file]
    walls, apart, entity = [], [], {}
    for code, value in zip(words[::2], words[1::2]):
        if code == "0":
            if entity.get("0") == "LINE" and entity["8"] == "WALLS":
                walls.append([float(entity[key]) for key in ("10", "20", "11", "21")])
                apart.append(entity.get("62") == APART_COLOUR)
            entity = {}
        entity[code] = value
    if not walls:
        raise ValueError(f"{path}: no walls in it: is it a map of ale-replay --map F.dxf?")
    return np.array(walls).reshape(-1, 4), np.array(apart)


def read_walls(path):
    return read_pieces(path)[0]


def read_numbers(path, columns):
    try:
        return np.loadtxt(path, ndmin=2, usecols=range(columns), encoding="utf-8")
    except ValueError as error:
        raise ValueError(f"{path}: not {columns} numbers in every line") from error


def directions(walls):
    way = walls[:, 2:] - walls[:, :2]
    length = np.hypot(*way.T)
    return way / length[:, None], length


def side_by_side(walls):
    """Pairs of walls that may be one, the longer first, and where along it the shorter begins and ends beside it."""
    tangent, length = directions(walls)
    for i in np.argsort(-length, kind="stable"):
        shorter = (length < length[i]) | ((length == length[i]) & (np.arange(len(walls)) > i))
        ends = [((walls[:, k:k + 2] - walls[i, :2]) @ tangent[i]) for k in (0, 2)]
        middle = (walls[:, :2] + walls[:, 2:]) / 2 - walls[i, :2]
        apart = abs(middle @ np.array([-tangent[i, 1], tangent[i, 0]]))
        first, last = np.maximum(0, np.minimum(*ends)), np.minimum(length[i], np.maximum(*ends))
        beside = shorter & (tangent @ tangent[i] > TWICE_COS) & (apart < TWICE_M) & (last - first > TWICE_ALONG_M)
        yield from ((i, j, first[j], last[j]) for j in np.flatnonzero(beside))


def are_two(walls, i, j, middle_m, plan):
    """Whether the plan has a wall for each of them there: a cabinet's front, and the wall behind it."""
    tangent, _ = directions(walls)
    on_longer = walls[i, :2] + middle_m * tangent[i]
    on_shorter = walls[j, :2] + (on_longer - walls[j, :2]) @ tangent[j] * tangent[j]
    along, across = distances(np.stack([on_longer, on_shorter]), plan)
    plan_tangent, plan_length = directions(plan)
    off = np.where((along > -RIGHT_M) & (along < plan_length + RIGHT_M) & (abs(plan_tangent @ tangent[i]) > RIGHT_COS), across, np.inf)
    return (off.min(1) < RIGHT_M).all() and off[0].argmin() != off[1].argmin()


def standing_twice(walls, plan=None):
    """Pairs, and how long they run side by side in all; without those that are two walls in the plan."""
    common = [last - first for i, j, first, last in side_by_side(walls)
              if plan is None or not are_two(walls, i, j, (first + last) / 2, plan)]
    return len(common), sum(common)


def samples(walls):
    """Points every STEP_M, and the wall of each."""
    _, length = directions(walls)
    owner = np.repeat(np.arange(len(walls)), np.maximum(1, (length / STEP_M).astype(int)))
    first = np.searchsorted(owner, owner)
    part = (np.arange(len(owner)) - first + 0.5) / np.bincount(owner)[owner]
    return walls[owner, :2] + part[:, None] * (walls[owner, 2:] - walls[owner, :2]), owner


def distances(points, walls):
    """Of every point to every wall: along the wall from its start, and across."""
    tangent, _ = directions(walls)
    off = points[:, None] - walls[None, :, :2]
    return (off * tangent).sum(2), abs(off[..., 0] * tangent[:, 1] - off[..., 1] * tangent[:, 0])


def are_right(drawn, plan):
    points, owner = samples(drawn)
    along, across = distances(points, plan)
    tangent, length = directions(plan)
    alike = abs(directions(drawn)[0][owner] @ tangent.T) > RIGHT_COS
    beside = (along > -RIGHT_M) & (along < length + RIGHT_M)
    return (alike & beside & (across < RIGHT_M)).any(1)


def seen_points(plan, poses):
    points, owner = samples(plan)
    first, count = np.searchsorted(owner, np.arange(len(plan))), np.bincount(owner)
    hits, way = np.zeros(len(points), int), plan[:, 2:] - plan[:, :2]
    for x, y, theta in poses[::POSE_EVERY]:
        bearing = theta + np.radians(np.arange(-120, 120))
        ray = np.stack([np.cos(bearing), np.sin(bearing)], 1)
        off = plan[:, :2] - [x, y]
        with np.errstate(all="ignore"):
            det = ray[:, :1] * way[:, 1] - ray[:, 1:] * way[:, 0]
            far = (off[:, 0] * way[:, 1] - off[:, 1] * way[:, 0]) / det
            part = (off[:, 0] * ray[:, 1:] - off[:, 1] * ray[:, :1]) / det
            far = np.where((part >= 0) & (part <= 1) & (far > 0), far, np.inf)
        wall = far.argmin(1)
        near = far[np.arange(len(ray)), wall] < SIGHT_M
        cell = (part[np.arange(len(ray)), wall][near] * count[wall[near]]).astype(int)
        np.add.at(hits, first[wall[near]] + np.minimum(cell, count[wall[near]] - 1), 1)
    return points[hits >= BEAMS_LEAST]


def are_found(points, drawn):
    nearest = np.full(len(points), np.inf)
    for point in samples(drawn)[0]:
        nearest = np.minimum(nearest, np.hypot(*(points - point).T))
    return nearest < FOUND_M


def in_plan(walls, start):
    x, y, theta = start
    turn = np.array([[math.cos(theta), math.sin(theta)], [-math.sin(theta), math.cos(theta)]])
    return np.concatenate([walls[:, :2] @ turn + [x, y], walls[:, 2:] @ turn + [x, y]], 1)


def read_poses(path):
    truth = read_numbers(path, 8)
    return np.stack([truth[:, 1], truth[:, 2], 2 * np.arctan2(truth[:, 6], truth[:, 7])], 1)


def against_plan(drawn, plan, poses):
    """Which part of what is drawn is right, and which of what could be seen from these poses is found."""
    return are_right(drawn, plan).mean(), are_found(seen_points(plan, poses), drawn).mean()


def told(options):
    walls = read_walls(options.map)
    pairs, along = standing_twice(walls)
    words = f"{len(walls)} walls, {directions(walls)[1].sum():.1f} m; standing twice: {pairs} pairs, {along:.1f} m"
    if options.plan:
        plan, poses = read_numbers(options.plan, 4), read_poses(options.truth)
        right, found = against_plan(in_plan(walls, poses[0]), plan, poses)
        words += f"; right {100 * right:.1f} %, found {100 * found:.1f} %"
    return words


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("map")
    parser.add_argument("plan", nargs="?")
    parser.add_argument("truth", nargs="?")
    options = parser.parse_args()
    if options.plan and not options.truth:
        parser.error("PLAN needs TRUTH.tum")
    try:
        print(told(options))
    except OSError as error:
        sys.exit(f"map_score.py: {error.filename}: {error.strerror}")
    except ValueError as error:
        sys.exit(f"map_score.py: {error}")


if __name__ == "__main__":
    main()
